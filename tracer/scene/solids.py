"""The transparent solids of a scene: which surfaces bound each, and which objects are made of it.

A shape bounds one solid. A mesh file bounds one solid for each of its shells, whatever the names and materials of its
faces (`tracer.shapes.shells`); an object may have faces of several, and a solid faces of several objects.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracer.scene.crossings import Surface, cross, overlap
from tracer.scene.scene import Object, SceneError, place
from tracer.shapes.mesh import Body, Mesh
from tracer.shapes.shape import Shape
from tracer.shapes.shells import (
    OPEN,
    bounds_of,
    find_shells,
    grouped,
    has_holes,
    signed_volumes,
    winding_numbers,
)

MOST_SHELLS = 500  # of a solid whose cavities are checked


@dataclass(frozen=True, eq=False)
class Solid:
    """A transparent solid, or a medium behind an open surface."""

    objects: tuple[int, ...]  # those with faces on it that transmit light
    closed: bool
    shape: Shape | None = None  # of a solid that is one shape
    corners: np.ndarray | None = None  # (m, 3, 3) of the faces of a closed shell of a mesh
    misaligned: bool = False  # a mesh without holes that is open only because of the winding of its faces

    def bounds(self) -> np.ndarray | None:
        """Its box (2, 3); None where it is infinite."""
        if self.corners is not None:
            return np.stack([self.corners.min(axis=(0, 1)), self.corners.max(axis=(0, 1))])
        boxes = self.shape.bounds() if self.shape else None
        return None if boxes is None else np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    def contains_each(self, points: np.ndarray) -> np.ndarray:
        """Whether each of the points (n, 3) lies inside."""
        box = self.bounds() if self.closed else None
        near = np.ones(len(points), bool)
        if box is not None:
            near = (points >= box[0]).all(axis=1) & (points <= box[1]).all(axis=1)
        inside = np.zeros(len(points), bool)
        if self.corners is not None:
            inside[near] = winding_numbers(self.corners, points[near]) > 0.5
        elif self.closed and self.shape is not None:
            inside[near] = self.shape.contains_each(points[near])
        return inside

    def contains(self, p: np.ndarray) -> bool:
        """Whether the point lies inside."""
        if self.corners is None:
            return self.closed and self.shape is not None and self.shape.contains(p)
        return bool(self.contains_each(p[None])[0])


@dataclass(frozen=True)
class Solids:
    """The solids of a scene, by rank: by falling priority, and in the file's order among equals."""

    objects: tuple[Object, ...]  # the scene's, with shells that were wound inside out turned
    ranked: tuple[Solid, ...]
    of_faces: dict[int, np.ndarray | int]  # by object: the rank of its solid, or of each face's; only transparent ones
    turned: tuple[int, ...]  # objects with faces that were turned


def find_solids(objects: Sequence[Object]) -> Solids:
    """The solids of a scene's objects. Raises SceneError if the faces of one have different indices of refraction."""
    found: list[Solid] = []
    faces: dict[int, np.ndarray | int] = {}
    changed = list(objects)
    turned: list[int] = []
    bodies: dict[Body | int, list[int]] = {}
    for k, item in enumerate(objects):
        if isinstance(item.shape, Mesh):
            bodies.setdefault(item.shape.body or k, []).append(k)
        elif is_medium(item):
            faces[k] = len(found)
            found.append(Solid((k,), item.shape.is_closed(), item.shape))
    for members in bodies.values():
        if any(is_medium(objects[k]) for k in members):
            turned += _add_body(members, changed, found, faces)
    order = sorted(range(len(found)), key=lambda j: (-objects[found[j].objects[0]].priority, found[j].objects[0]))
    rank = np.zeros(len(found), np.int64)
    rank[order] = np.arange(len(found))
    return Solids(tuple(changed), tuple(found[j] for j in order), {k: rank[j] for k, j in faces.items()}, tuple(turned))


def is_medium(item: Object) -> bool:
    """Whether light enters the object."""
    return item.material.transmit > 0.0 and not item.thin


def _add_body(
    members: list[int], objects: list[Object], found: list[Solid], faces: dict[int, np.ndarray | int]
) -> list[int]:
    """Add the solids of one mesh file in one place. Returns the objects of which faces were turned."""
    for k in members:
        shape = objects[k].shape
        assert isinstance(shape, Mesh)
        if is_medium(objects[k]) and (single := shape.geometry.one_sided()):
            objects[k] = replace(objects[k], shape=replace(shape, geometry=single))
    shapes = [objects[k].shape for k in members]
    assert all(isinstance(shape, Mesh) for shape in shapes)
    corners = [shape.all_faces() for shape in shapes if isinstance(shape, Mesh)]
    sizes = [len(own) for own in corners]
    indices = [objects[k].material.ior if objects[k].material.transmit > 0.0 else math.nan for k in members]
    parts = np.repeat(np.arange(len(members)), sizes)
    shells = find_shells(np.concatenate(corners), parts, np.repeat(indices, sizes))
    turned = []
    media = {k for k in members if is_medium(objects[k])}
    starts = dict(zip(members, np.cumsum([0, *(len(own) for own in corners)]), strict=False))
    for k in members:
        shape = objects[k].shape
        assert isinstance(shape, Mesh)
        count = len(shape.geometry.faces)
        own = shells.turned[starts[k] : starts[k] + count]
        if own.any() and k in media:
            turned.append(k)
        if own.any():
            objects[k] = replace(objects[k], shape=replace(shape, geometry=shape.geometry.turned(own)))
    counts = {k: len(shape.geometry.faces) for k in members if isinstance(shape := objects[k].shape, Mesh)}
    placed = np.concatenate([shape.placed() for k in members if isinstance(shape := objects[k].shape, Mesh)])
    owner = np.repeat(members, [counts[k] for k in members])
    with_area = np.concatenate([np.arange(starts[k], starts[k] + counts[k]) for k in members])
    solid_of, shell_of = shells.solid[with_area], shells.shell[with_area]
    numbers = np.full(shells.count + 1, OPEN)
    # Faces of open shells (-1) come first.
    for solid, which in enumerate(grouped(solid_of + 1, shells.count + 1)[1:]):
        with_faces = np.unique(owner[which]).tolist()
        outer = tuple(k for k in with_faces if k in media)
        if outer:
            _check_one_medium(outer, [k for k in with_faces if objects[k].material.transmit > 0.0], objects)
            _check_cavities(placed[which], shell_of[which], owner[which], objects)
            numbers[solid] = len(found)
            found.append(Solid(outer, True, None, placed[which]))
    opened = shells.solid == OPEN
    misaligned = bool(opened.any()) and not has_holes(np.concatenate(corners)[opened])
    for k in sorted(media):
        of_face = solid_of[owner == k]
        own = np.where(of_face == OPEN, OPEN, numbers[of_face])
        if (own == OPEN).any():
            own = np.where(own == OPEN, len(found), own)
            found.append(Solid((k,), False, objects[k].shape, None, misaligned))
        faces[k] = own
    return turned


def _check_one_medium(media: tuple[int, ...], members: list[int], objects: list[Object]) -> None:
    """All faces of a solid that transmit light have one index of refraction, and none is thin."""
    first = media[0]
    for k in members:
        names = _named(objects, first, k)
        a, b = objects[first].material, objects[k].material
        if k not in media:
            raise SceneError([f"{names} bound one solid, so they must be thin both, or neither"])
        if a.ior != b.ior:
            raise SceneError([f"{names} bound one solid, so they must have one ior, got {a.ior:g} and {b.ior:g}"])


def _check_cavities(corners: np.ndarray, shell: np.ndarray, owner: np.ndarray, objects: list[Object]) -> None:
    """The cavities of a solid lie inside it, and apart from each other.

    `corners` (m, 3, 3) are its faces, `shell` (m,) their shells and `owner` (m,) their objects.
    """
    _, shell = np.unique(shell, return_inverse=True)
    shells = grouped(shell.ravel(), int(shell.max()) + 1)
    if len(shells) == 1 or len(shells) > MOST_SHELLS:
        return
    hull = int(np.abs(signed_volumes(corners, shell.ravel(), len(shells))).argmax())
    low, high = bounds_of(corners, shell.ravel(), len(shells))
    surfaces = [Surface.of(corners[faces]) for faces in shells]
    for k, cavity in enumerate(surfaces):
        if k == hull:
            continue
        if cross(cavity, surfaces[hull]):
            names = _named(objects, int(owner[shells[k][0]]), int(owner[shells[hull][0]]))
            raise SceneError([f"{names}: a cavity must lie inside its solid"])
        for j in np.flatnonzero(((low[:k] < high[k]) & (low[k] < high[:k])).all(axis=1)):
            if j != hull and overlap(surfaces[j], cavity):
                names = _named(objects, int(owner[shells[j][0]]), int(owner[shells[k][0]]))
                raise SceneError([f"{names}: the cavities of a solid must not overlap"])


def _named(objects: list[Object], a: int, b: int) -> str:
    """Two objects of a mesh file, in a message."""
    shape = objects[a].shape
    file = f"{shape.file}: " if isinstance(shape, Mesh) else ""
    return file + " and ".join(place("object", k, objects[k].name) for k in dict.fromkeys((a, b)))

"""A prepared scene: its arrays for kernels, without all that this scene does not need."""

from dataclasses import dataclass, field, replace

import numpy as np

from tracer.accel.bvh import MAX_UNBOXED, build
from tracer.accel.rows import NodeRow
from tracer.compile.bundle import bundle
from tracer.compile.rows import as_rows
from tracer.formulas.camera import View
from tracer.formulas.exact import exact
from tracer.formulas.media import WORD
from tracer.formulas.vector import Vector, as_floats
from tracer.kernel.arrays import Arrays
from tracer.kernel.capabilities import Capability, Need, needs
from tracer.kernel.formulas import STABLE, Formulas
from tracer.kernel.packing import pack_lights, pack_materials, pack_objects, pack_surfaces
from tracer.kernel.workspace import Eye, Eyes
from tracer.printable import printable, shown_path
from tracer.scene import Material, Scene, SceneError
from tracer.scene.cameras import scene_view
from tracer.scene.garbage import no_garbage_collection
from tracer.scene.notes import hidden_notes, open_notes, turned_notes
from tracer.scene.scene import middle_and_radius
from tracer.scene.solids import Solid, find_solids
from tracer.shapes.outline import PLANE_ERROR
from tracer.shapes.surface_row import BlockRow

NO_SURFACES = np.zeros(0, np.int64)
MAX_EYES = 64  # points whose surroundings are cached


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class World:
    """A scene ready to be traced. `tracer.prepare` makes it."""

    scene: Scene
    arrays: Arrays  # as a Bundle
    boxes: np.ndarray  # (n, 2, 3): boxes about all surfaces, infinite ones included
    bounds: np.ndarray  # (n, 2, 3): boxes about the bounded surfaces
    extent: tuple[Vector, float]  # centre and radius of these, for a scene without a camera position or target
    needs: tuple[Need, ...]
    solids: tuple[Solid, ...]  # by rank
    turned: tuple[int, ...]  # objects whose faces were wound inside out
    _eyes: dict[Vector, Eye] = field(default_factory=dict)  # cache: the eye seldom moves

    @property
    def left_out(self) -> list[str]:
        """The capabilities that this scene does not need."""
        return [need.name for need in self.needs if not need.needed]

    @property
    def has_glass(self) -> bool:
        """Whether an object lets light through. `Scene.has_glass` asks all objects; this is quick."""
        return any(need.name == Capability.REFRACTION and need.needed for need in self.needs)

    @property
    def notes(self) -> list[str]:
        """Warnings, one line each: valid input that is probably not intended."""
        names = [item.name or item.shape.name for item in self.scene.objects]
        found = [*self.scene.notes, *turned_notes([names[k] for k in self.turned])]
        found += open_notes(self.solids, names) + hidden_notes(self.solids, names)
        return [printable(note) for note in found]

    def __repr__(self) -> str:
        scene = self.scene
        name = shown_path(scene.title or scene.path or "a scene")
        return f"<World of {name}: {len(scene.objects)} objects, {len(scene.lights)} lights>"

    def view(self, size: tuple[int, int] | None = None) -> View:
        """The view of the scene's camera, for an image of this size (width, height), by default the scene's own."""
        return scene_view(self.scene, self.extent, size)

    def eye(self, point: Vector) -> Eye:
        """The solids around a point, and the surfaces that it lies exactly on."""
        if point not in self._eyes:
            if len(self._eyes) >= MAX_EYES:
                self._eyes.clear()
            self._eyes[point] = self._eye(point)
        return self._eyes[point]

    def eyes(self, points: np.ndarray) -> Eyes:
        """The same for many points (n, 3). Equal ones are looked at once."""
        different, point = np.unique(points, axis=0, return_inverse=True)
        solids = np.zeros((len(different), self._words), np.int64)
        for rank, solid in enumerate(self.solids):
            solids[solid.contains_each(different), rank // WORD] |= 1 << (rank % WORD)
        at, surfaces = self._contacts(different)
        starts = np.searchsorted(at, np.arange(len(different) + 1))
        return Eyes(point.ravel(), solids, surfaces, starts)

    def _eye(self, point: Vector) -> Eye:
        mask = np.zeros(self._words, np.int64)
        p = np.array(point)
        for rank, solid in enumerate(self.solids):
            if solid.contains(p):
                mask[rank // WORD] |= 1 << (rank % WORD)
        return Eye(mask, self._contacts(p[None])[1])

    @property
    def _words(self) -> int:
        """Words of a set of solids."""
        return -(-len(self.solids) // WORD)

    def _contacts(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(numbers of points, ids of surfaces) where one of the points (n, 3) lies exactly on a surface, by point."""
        low, high = self.boxes[:, 0], self.boxes[:, 1]
        if len(points) < len(low):
            at = [np.flatnonzero(((low <= p) & (p <= high)).all(axis=1)) for p in points]
            surfaces = np.unique(np.concatenate(at)) if at else NO_SURFACES
        else:
            surfaces = np.arange(len(low))
        owners, found = self.arrays.surfaces["object"], []
        for s in surfaces.tolist():
            shape, row = self.scene.objects[owners[s]].shape, s - int(np.searchsorted(owners, owners[s]))
            near = np.flatnonzero(((low[s] <= points) & (points <= high[s])).all(axis=1))
            near = near[shape.may_touch(points[near], row)].tolist()
            found += [(k, s) for k in near if shape.touches(exact(points[k].tolist()), row)]
        pairs = np.array(sorted(found), np.int64).reshape(-1, 2)
        return pairs[:, 0].copy(), pairs[:, 1].copy()


@no_garbage_collection()
def prepare(scene: Scene, hierarchy: bool | None = None, formulas: Formulas = STABLE) -> World:
    """Prepare a scene for tracing.

    The hierarchy is built for more than MAX_UNBOXED bounded surfaces, or as `hierarchy` says; images have the same
    bits either way. `formulas` are the functions that kernels compute with. SceneError lists all values that are not
    allowed.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"prepare needs a Scene, as tracer.load returns it, got {type(scene).__name__}")
    faults = scene.faults()
    if faults:
        raise SceneError(faults)
    materials: dict[Material, int] = {}
    for item in scene.objects:
        materials.setdefault(item.material, len(materials))
    solids = find_solids(scene.objects)
    scene = replace(scene, objects=solids.objects)
    surfaces = pack_surfaces(scene.objects, solids.of_faces)
    finite = np.asarray(np.isfinite(surfaces.bounds).all(axis=(1, 2)))
    boxed = finite & (np.count_nonzero(finite) > MAX_UNBOXED if hierarchy is None else hierarchy)
    boxes = _padded(surfaces.bounds)
    nodes, blocks, unit = build(boxes, surfaces.triangles(), boxed)
    arrays = Arrays(
        surfaces=surfaces.rows,
        corners=surfaces.corners,
        smooth=surfaces.smooth,
        objects=pack_objects(scene.objects, materials),
        materials=pack_materials(materials),
        lights=pack_lights(scene),
        indices=np.array([scene.objects[solid.objects[0]].material.ior for solid in solids.ranked], np.float64),
        closed=np.array([solid.closed for solid in solids.ranked], np.bool_),
        background=np.array(scene.background.color, np.float64),
        ambient=np.array(scene.tracing.ambient, np.float64),
        unboxed=np.flatnonzero(~boxed).astype(np.int32),
        nodes=as_rows(nodes, NodeRow),
        blocks=as_rows(blocks, BlockRow),
        inverse_unit=np.array([1.0 / unit]),
        formulas=formulas,
    )
    bounds = surfaces.bounds[finite]
    found = needs(scene, len(surfaces.rows), len(nodes), len(blocks))
    return World(scene, bundle(arrays), boxes, bounds, _extent(scene, bounds), found, solids.ranked, solids.turned)


def _extent(scene: Scene, bounds: np.ndarray) -> tuple[Vector, float]:
    """Centre and radius of the boxes, if the camera depends on them."""
    if len(bounds) == 0 or (scene.camera.position and scene.camera.look_at):
        return ((0.0, 0.0, 0.0), 1.0)
    middle, radius = middle_and_radius(bounds)
    return (as_floats(middle), radius)


def _padded(boxes: np.ndarray) -> np.ndarray:
    """Boxes enlarged by the rounding error of a hit point, so that a ray that starts on a surface starts inside its
    box.
    """
    pad = 4.0 * PLANE_ERROR * np.abs(boxes).sum(axis=2).max(axis=1, initial=0.0)
    return np.stack([boxes[:, 0] - pad[:, None], boxes[:, 1] + pad[:, None]], axis=1)

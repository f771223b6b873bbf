"""Mesh: triangles from a file. For kernels each face is a row of shape `triangle`.

The author names the file and its placement: the mesh is scaled, then rotated about x, y and z, then translated.
"""

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.formulas.exact import Exact, exact, is_in_outline
from tracer.formulas.rotation import placed, rotation_matrix
from tracer.formulas.vector import Vector, as_floats
from tracer.shapes.planar import may_lie_in_plane, unit_normal
from tracer.shapes.shape import Shape
from tracer.shapes.shells import OPEN, find_shells, welded, winding_number, winding_numbers
from tracer.shapes.tessellation import flat, normals_of
from tracer.shapes.triangle import Triangle, pack_triangles

MAX_FACETS = 400  # largest number of triangles of a mesh whose edges figures draw; a finer mesh is drawn as curved
NO_FILE = "mesh"  # stands for the file's name, where a mesh came from no file


@dataclass(frozen=True, slots=True, eq=False)
class Geometry:
    """Triangles as in a file."""

    vertices: np.ndarray  # (n, 3)
    faces: np.ndarray  # (m, 3) indices of vertices, counter-clockwise seen from outside
    normals: np.ndarray | None = None  # (k, 3) unit normals, or 0 for a corner without one; None if the file has none
    normal_faces: np.ndarray | None = None  # (m, 3) indices of normals; None: those of the vertices
    degenerate: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.int64))  # faces without area

    def turned(self, which: np.ndarray) -> "Geometry":
        """The same with some faces, a mask (m,), wound the other way."""
        faces = np.where(which[:, None], self.faces[:, ::-1], self.faces)
        if self.normals is None:
            return replace(self, faces=faces)
        normals = np.concatenate([self.normals, -self.normals])
        old = self.faces if self.normal_faces is None else self.normal_faces
        new = np.where(which[:, None], old[:, ::-1] + len(self.normals), old)
        return replace(self, faces=faces, normals=normals, normal_faces=new)

    def one_sided(self) -> "Geometry | None":
        """The same without the second of each pair of faces that differ only in their winding; None unless all faces
        come in such pairs, as in files that have every face once for each side.
        """
        points = welded(self.vertices)[self.faces]
        first = points.argmin(axis=1)
        turned = np.take_along_axis(points, (first[:, None] + np.arange(3)) % 3, axis=1)
        kept = turned[:, 1] < turned[:, 2]  # one winding of each pair
        there, back = turned[kept], turned[~kept][:, [0, 2, 1]]
        if len(there) != len(back) or (there[np.lexsort(there.T)] != back[np.lexsort(back.T)]).any():
            return None
        _, where = np.unique(np.sort(points, axis=1), axis=0, return_index=True)
        if 2 * len(where) != len(points):
            return None
        which = np.sort(where)  # of each pair the one that comes first
        indices = self.faces if self.normal_faces is None else self.normal_faces
        return replace(self, faces=self.faces[which], normal_faces=None if self.normals is None else indices[which])


class Body:
    """Stands for one mesh file in one place. The meshes of its parts share it, so that they bound solids together."""


@dataclass(frozen=True, slots=True, eq=False)
class Mesh(Shape):
    name: ClassVar[str] = "mesh"
    curved: ClassVar[bool] = False
    packed_as: ClassVar[str] = "triangle"

    geometry: Geometry
    file: str = field(default=NO_FILE, metadata=fields.text())
    scale: float = field(default=1.0, metadata=fields.number(above=0))
    rotate: Vector = field(default=(0.0, 0.0, 0.0), metadata=fields.point())  # degrees about x, then y, then z
    translate: Vector = field(default=(0.0, 0.0, 0.0), metadata=fields.point())
    body: Body | None = None  # None: the mesh is alone
    _vertices: list[np.ndarray] = field(init=False, default_factory=list, repr=False)  # cache of `vertices`

    @classmethod
    def example(cls) -> "Mesh":
        """A tetrahedron."""
        vertices = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])
        return cls(Geometry(vertices, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])))

    def placed(self) -> np.ndarray:
        """The corners (m, 3, 3) of the faces, after placement."""
        return self.vertices()[self.geometry.faces]

    def vertices(self) -> np.ndarray:
        """The vertices (n, 3), after placement."""
        if not self.is_placed():
            return self.geometry.vertices
        if not self._vertices:
            self._vertices.append(self._moved(self.geometry.vertices))
        return self._vertices[0]

    def _moved(self, points: np.ndarray) -> np.ndarray:
        return placed(points, self.scale, self.rotate, self.translate)

    def is_placed(self) -> bool:
        """Whether its vertices are other than in the file, and so rounded."""
        return self.scale != 1.0 or any(self.rotate) or any(self.translate)

    def pack(self, rows: np.ndarray) -> None:
        pack_triangles(rows, self.placed())

    def smooth(self) -> np.ndarray | None:
        if self.geometry.normals is None:
            return None
        indices = self.geometry.faces if self.geometry.normal_faces is None else self.geometry.normal_faces
        return placed(self.geometry.normals, 1.0, self.rotate, (0.0, 0.0, 0.0))[indices]

    def all_faces(self) -> np.ndarray:
        """The corners (n, 3, 3) of all faces before placement: those with an area, then those without."""
        return self.geometry.vertices[np.concatenate([self.geometry.faces, self.geometry.degenerate])]

    def bounds(self) -> np.ndarray:
        corners = self.placed()
        return np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1)

    def is_closed(self) -> bool:
        """Whether all its shells are closed."""
        return bool((find_shells(self.all_faces()).solid != OPEN).all())

    def faults(self) -> list[str]:
        """Only of the placement: the vertices themselves are checked by readers."""
        with np.errstate(over="ignore", invalid="ignore"):
            vertices = self.vertices()
            beyond = ~(np.abs(vertices) <= fields.LARGEST).all(axis=1)
            if not beyond.any():
                return []
            k = int(beyond.argmax())
            roughly = self.scale * rotation_matrix(self.rotate) @ self.geometry.vertices[k] + self.translate
        place = " ".join(f"{x:g}" for x in roughly)
        return [f"{self.file}: vertex {k} must be placed within {fields.LARGEST:g}, got {place}"]

    def contains(self, p: np.ndarray) -> bool:
        corners = self.placed()
        outside = (p < corners.min(axis=(0, 1))).any() or (p > corners.max(axis=(0, 1))).any()
        return not outside and self.is_closed() and abs(winding_number(corners, p)) > 0.5

    def contains_each(self, points: np.ndarray) -> np.ndarray:
        return self.is_closed() & (np.abs(winding_numbers(self.placed(), points)) > 0.5)

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        corners = self._moved(self.geometry.vertices[self.geometry.faces[row]])
        return may_lie_in_plane(points, as_floats(corners[0]), as_floats(unit_normal(corners)))

    def touches(self, p: Exact, row: int) -> bool:
        return is_in_outline(p, [exact(corner) for corner in self.placed()[row].tolist()])

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        corners, normals = self.placed(), self.smooth()
        return flat(corners) if normals is None else (corners, normals)

    def faces(self) -> list[tuple[Shape, ...]]:
        """The facets: the triangles grouped by plane; the whole mesh if it is smooth or fine."""
        corners = self.placed()
        if len(corners) > MAX_FACETS or self.smooth() is not None:
            return [(self,)]
        n, size = normals_of(corners)
        n, corners = n[size > 0.0], corners[size > 0.0]
        extent = float(np.abs(corners - corners[0, 0]).max()) or 1.0
        planes = np.c_[n, ((corners[:, 0] - corners[0, 0]) * n).sum(axis=1) / extent]
        _, which = np.unique(np.round(planes, 5) + 0.0, axis=0, return_inverse=True)
        groups = [corners[which.ravel() == k] for k in range(int(which.max()) + 1)]
        return [tuple(Triangle(tuple(map(tuple, t))) for t in group.tolist()) for group in groups]

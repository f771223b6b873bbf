"""Mesh: triangles from a file. For kernels each face is a row of shape `triangle`.

The author names the file and its placement: the mesh is scaled, then rotated about x, y and z, then translated.
"""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.formulas.vector import Vector
from tracer.shapes.shape import Shape
from tracer.shapes.tessellation import flat, normals_of
from tracer.shapes.triangle import Triangle, pack_triangles

MAX_FACETS = 400  # largest number of triangles of a mesh whose edges figures draw; a finer mesh is drawn as curved
NO_FILE = "mesh"  # stands for the file's name, where a mesh came from no file


@dataclass(frozen=True, slots=True, eq=False)
class Geometry:
    """Triangles as in a file."""

    vertices: np.ndarray  # (n, 3)
    faces: np.ndarray  # (m, 3) indices of vertices, counter-clockwise seen from outside
    normals: np.ndarray | None = None  # (n, 3) vertex normals, if the file has them
    note: str = ""  # warning of the reader


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
        return self.scale * self.geometry.vertices @ rotation_matrix(self.rotate).T + self.translate

    def pack(self, rows: np.ndarray) -> None:
        pack_triangles(rows, self.placed())

    def smooth(self) -> np.ndarray | None:
        if self.geometry.normals is None:
            return None
        return (self.geometry.normals @ rotation_matrix(self.rotate).T)[self.geometry.faces]

    def bounds(self) -> np.ndarray:
        corners = self.placed()
        return np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1)

    def is_closed(self) -> bool:
        """Whether every edge is used once in each direction."""
        corners = self.geometry.vertices + 0.0  # -0 becomes 0
        order = np.lexsort(corners.T)
        differs = (corners[order[1:]] != corners[order[:-1]]).any(axis=1)
        place = np.zeros(len(order), np.int64)
        place[order[1:]] = np.cumsum(differs)
        faces = place[self.geometry.faces]
        start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
        forward = np.sort(start * len(order) + end)
        backward = np.sort(end * len(order) + start)
        return bool((forward[1:] != forward[:-1]).all()) and bool((forward == backward).all())

    def contains(self, p: np.ndarray) -> bool:
        """Whether the solid angles of the faces, seen from p, add up to 4 pi.

        Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983.
        """
        vertices = self.vertices()
        outside = (p < vertices.min(axis=0)).any() or (p > vertices.max(axis=0)).any()
        if outside or not self.is_closed():
            return False
        a, b, c = np.moveaxis(vertices[self.geometry.faces] - p, 1, 0)
        la, lb, lc = (np.sqrt((x * x).sum(axis=1)) for x in (a, b, c))
        volume = (a * np.cross(b, c)).sum(axis=1)
        spread = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
        return bool(abs(2.0 * np.arctan2(volume, spread).sum()) > 2.0 * math.pi)

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


def rotation_matrix(degrees: Vector) -> np.ndarray:
    """The matrix (3, 3) that rotates about x, then y, then z. Exact for multiples of 90 degrees."""
    turn = np.eye(3)
    for axis, angle in enumerate(degrees):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        if angle % 90.0 == 0.0:
            c, s = float(round(c)), float(round(s))
        i, j = (axis + 1) % 3, (axis + 2) % 3
        step = np.eye(3)
        step[i, i], step[i, j], step[j, i], step[j, j] = c, -s, s, c
        turn = step @ turn
    return turn

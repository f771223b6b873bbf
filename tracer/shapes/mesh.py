"""Mesh: triangles from a file. For kernels it is nothing of its own: each face is a row of shape `triangle`.

The author names the file and where it goes: first scaled, then turned about x, y and z in this order, then moved.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.formulas.vector import Vector
from tracer.shapes.triangle import pack_triangles

NAME = "mesh"


NO_FILE = "mesh"  # as the file of a mesh that came from none


@dataclass(frozen=True, slots=True, eq=False)
class Geometry:
    """Triangles as a file has them."""

    vertices: np.ndarray  # (n, 3)
    faces: np.ndarray  # (m, 3) rows of vertices, counter-clockwise seen from outside
    normals: np.ndarray | None = None  # (n, 3), one a vertex, where the file has them


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    geometry: Geometry
    file: str = field(default=NO_FILE, metadata=fields.text())
    scale: float = field(default=1.0, metadata=fields.number(above=0))
    rotate: Vector = field(default=(0.0, 0.0, 0.0), metadata=fields.point())  # degrees about x, then y, then z
    translate: Vector = field(default=(0.0, 0.0, 0.0), metadata=fields.point())

    def placed(self) -> np.ndarray:
        """The corners of every face, (m, 3, 3), where the author put them."""
        return self.vertices()[self.geometry.faces]

    def vertices(self) -> np.ndarray:
        """(n, 3), where the author put them."""
        return self.scale * self.geometry.vertices @ rotation_matrix(self.rotate).T + self.translate

    def pack(self, rows: Any) -> None:
        pack_triangles(rows, self.placed())

    def smooth(self) -> np.ndarray | None:
        """The unit normals at every face's corners, (m, 3, 3), or None where the file has none."""
        if self.geometry.normals is None:
            return None
        return (self.geometry.normals @ rotation_matrix(self.rotate).T)[self.geometry.faces]

    def bounds(self) -> np.ndarray:
        corners = self.placed()
        return np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1)

    def is_closed(self) -> bool:
        """Whether every edge is passed once in each direction: then the mesh has an inside."""
        corners = self.geometry.vertices + 0.0  # -0 is 0
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
        """Whether the faces, seen from p, cover the whole sphere of directions: their solid angles add up to 4 pi.

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


def rotation_matrix(degrees: Vector) -> np.ndarray:
    """The matrix that turns about x, then y, then z. Quarter turns are exact."""
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

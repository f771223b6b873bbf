"""Plane: all p with n.(p - a) = 0, infinite. As a solid, the half-space that its normal points away from.

Packed as in `planar`.
"""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.formulas.double_double import dd_vector
from tracer.formulas.exact import Exact, dot, exact, minus
from tracer.formulas.vector import Vector, rescale, unit
from tracer.rays import Ray
from tracer.shapes import planar
from tracer.shapes.planar import may_cross, pack_normal
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import flat

REACH = 12.0  # radii of the scene: half the side of the square that the 3D view shows


@dataclass(frozen=True, slots=True)
class Plane(Shape):
    name: ClassVar[str] = "plane"
    curved: ClassVar[bool] = False
    checker_in_plane: ClassVar[bool] = True
    has_edges: ClassVar[bool] = False

    point: Vector = field(metadata=fields.point())
    normal: Vector = field(metadata=fields.direction())

    @classmethod
    def example(cls) -> "Plane":
        return cls((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))

    def pack(self, rows: np.ndarray) -> None:
        rows["a"] = self.point
        pack_normal(rows, dd_vector(rescale(self.normal)))
        rows["r"] = np.abs(self.point).sum()

    def bounds(self) -> None:
        return

    def plane(self) -> tuple[Vector, Vector]:
        return self.point, unit(rescale(self.normal))

    def is_closed(self) -> bool:
        return True

    def contains(self, p: np.ndarray) -> bool:
        return self._height(exact(p)) < 0

    def contains_each(self, points: np.ndarray) -> np.ndarray:
        inside = planar.heights(points, self.point, self.normal) < 0.0
        for k in np.flatnonzero(self.may_touch(points, 0)).tolist():
            inside[k] = self.contains(points[k])
        return inside

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        return planar.may_lie_in_plane(points, self.point, self.normal)

    def touches(self, p: Exact, row: int) -> bool:
        return self._height(p) == 0

    def _height(self, p: Exact) -> Fraction:
        return dot(minus(p, exact(self.point)), exact(self.normal))

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """A square about the foot of the perpendicular from the scene's middle."""
        point, normal = self.plane()
        n = np.array(normal)
        foot = middle - ((middle - point) @ n) * n
        aside = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
        aside /= np.linalg.norm(aside)
        u, v = REACH * radius * aside, REACH * radius * np.cross(n, aside)
        a, b, c, d = foot - u - v, foot + u - v, foot + u + v, foot - u + v
        return flat(np.array([[a, b, c], [a, c, d]]))


@inlined
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The distance to the plane."""
    if not may_cross(surface, ray, t_max):
        return math.inf
    return world.formulas.plane_distance(world, surface, ray, t_min, t_max, exact)


next_hit = planar.no_next_hit
interaction = planar.interaction
normal_derivative = planar.constant_normal

"""Disc: a round flat face. Packed as in `planar`, with a = its centre and b[0] = its radius."""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled
from tracer.formulas.double_double import dd_vector
from tracer.formulas.vector import Vector, add, length, rescale, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes import planar
from tracer.shapes.exact import Exact, dot, exact, minus
from tracer.shapes.planar import may_cross, outline_slack, pack_normal
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import flat, unit_circle


@dataclass(frozen=True, slots=True)
class Disc(Shape):
    name: ClassVar[str] = "disc"
    curved: ClassVar[bool] = False
    checker_in_plane: ClassVar[bool] = True

    center: Vector = field(metadata=fields.point())
    normal: Vector = field(metadata=fields.direction())
    radius: float = field(metadata=fields.number(above=0))

    @classmethod
    def example(cls) -> "Disc":
        return cls((0.0, 0.0, 0.0), (1.0, 2.0, 2.0), 1.0)

    def pack(self, rows: np.ndarray) -> None:
        rows["a"] = self.center
        rows["b"] = (self.radius, 0.0, 0.0)
        pack_normal(rows, dd_vector(rescale(self.normal)))
        rows["r"] = np.abs(self.center).sum()

    def bounds(self) -> np.ndarray:
        """Along axis k it reaches radius * sqrt(1 - n_k^2) from its centre."""
        x, y, z = unit(rescale(self.normal))
        reach = self.radius * np.array([math.hypot(y, z), math.hypot(z, x), math.hypot(x, y)])
        return np.stack([self.center - reach, self.center + reach])[None]

    def touches(self, p: Exact, row: int) -> bool:
        arm = minus(p, exact(self.center))
        return dot(arm, exact(self.normal)) == 0 and dot(arm, arm) <= Fraction(self.radius) ** 2

    def plane(self) -> tuple[Vector, Vector]:
        return self.center, unit(rescale(self.normal))

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """A fan about its centre."""
        rim = np.array(self.center) + self.radius * unit_circle(self.normal)
        return flat(np.stack([np.broadcast_to(self.center, rim[1:].shape), rim[:-1], rim[1:]], axis=1))


@compiled
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The distance to the plane if the hit is within the radius of the centre, else inf."""
    noinline()
    if not may_cross(surface, ray, t_max):
        return math.inf
    t = world.formulas.plane_distance(world, surface, ray, t_min, t_max, True)
    if t == math.inf:
        return math.inf
    from_center = add(subtract(ray.origin, vector(surface.a)), scale(t, ray.direction))
    return t if length(from_center) <= surface.b[0] + outline_slack(surface, ray) else math.inf


next_hit = planar.no_next_hit
interaction = planar.interaction
normal_derivative = planar.constant_normal

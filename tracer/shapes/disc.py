"""Disc: a round flat face. Packed as in `planar`, with a = its centre and b[0] = its radius."""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled
from tracer.formulas.double_double import (
    dd_dot,
    dd_minus,
    dd_multiply,
    dd_scale,
    dd_subtract,
    dd_vector,
    exact_difference,
)
from tracer.formulas.exact import Exact, dot as exact_dot, exact, minus
from tracer.formulas.vector import Vector, add, dot, length, rescale, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes import planar
from tracer.shapes.outline import PLANE_ERROR
from tracer.shapes.planar import dd_normal, may_cross, outline_slack, pack_normal
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

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        return planar.may_lie_in_plane(points, self.center, self.normal)

    def touches(self, p: Exact, row: int) -> bool:
        arm = minus(p, exact(self.center))
        return exact_dot(arm, exact(self.normal)) == 0 and exact_dot(arm, arm) <= Fraction(self.radius) ** 2

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
    slack = outline_slack(world, surface, ray)
    beyond = length(add(subtract(ray.origin, vector(surface.a)), scale(t, ray.direction))) - surface.b[0]
    error = PLANE_ERROR * (surface.r + surface.b[0] + ray.magnitude + t)
    error /= abs(dot(vector(surface.normal), ray.direction))
    if slack > 0.0 or abs(beyond) > error:
        return t if beyond <= slack else math.inf
    return t if is_within_rim(surface, ray) else math.inf


@compiled
def is_within_rim(surface: SurfaceRow, ray: Ray) -> bool:
    """Whether the ray crosses the plane within the rim, decided in double-double: |q|^2 <= r^2 with q = o - a + t d."""
    noinline()
    normal = dd_normal(surface)
    arm, d = exact_difference(ray.origin, vector(surface.a)), dd_vector(ray.direction)
    height, speed = dd_dot(normal, arm), dd_dot(normal, d)
    # All times the speed, so that no division is needed.
    q = dd_minus(dd_scale(speed, arm), dd_scale(height, d))
    radius = dd_multiply((surface.b[0], 0.0), speed)
    return dd_subtract(dd_dot(q, q), dd_multiply(radius, radius))[0] <= 0.0


next_hit = planar.no_next_hit
interaction = planar.interaction
normal_derivative = planar.constant_normal

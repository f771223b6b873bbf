"""Disc: a round flat face. Packed as a plane, a = its centre, and b[0] = its radius."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled
from tracer.formulas.double_double import dd_vector
from tracer.formulas.vector import Vector, add, length, rescale, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes import planar
from tracer.shapes.planar import may_cross, outline_slack, pack_normal, plane_distance

NAME = "disc"


@dataclass(frozen=True, slots=True)
class Disc:
    center: Vector = field(metadata=fields.point())
    normal: Vector = field(metadata=fields.direction())
    radius: float = field(metadata=fields.number(above=0))

    def pack(self, rows: Any) -> None:
        rows["a"] = self.center
        rows["b"] = (self.radius, 0.0, 0.0)
        pack_normal(rows, dd_vector(rescale(self.normal)))
        rows["r"] = np.abs(self.center).sum()

    def bounds(self) -> np.ndarray:
        """Along an axis it reaches as far as its normal leaves that axis: radius times sqrt(1 - n_k^2)."""
        x, y, z = unit(rescale(self.normal))
        reach = self.radius * np.array([math.hypot(y, z), math.hypot(z, x), math.hypot(x, y)])
        return np.stack([self.center - reach, self.center + reach])[None]

    def contains(self, p: np.ndarray) -> bool:
        return False


@compiled
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    noinline()
    if not may_cross(surface, ray, ceiling):
        return math.inf
    t = plane_distance(world, surface, ray, floor, ceiling, True)
    if t == math.inf:
        return math.inf
    from_center = add(subtract(ray.origin, vector(surface.a)), scale(t, ray.direction))
    return t if length(from_center) <= surface.b[0] + outline_slack(surface, ray) else math.inf


next_hit = planar.no_next_hit
interaction = planar.interaction
normal_derivative = planar.constant_normal

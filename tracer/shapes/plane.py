"""Plane: all p with n.(p - a) = 0, without end. As a solid it is the half-space its normal points away from."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.formulas.double_double import dd_vector
from tracer.formulas.vector import Vector, rescale
from tracer.rays import Ray
from tracer.shapes import planar
from tracer.shapes.planar import may_cross, pack_normal, plane_distance

NAME = "plane"


@dataclass(frozen=True, slots=True)
class Plane:
    point: Vector = field(metadata=fields.point())
    normal: Vector = field(metadata=fields.direction())

    def pack(self, rows: Any) -> None:
        rows["a"] = self.point
        pack_normal(rows, dd_vector(rescale(self.normal)))
        rows["r"] = np.abs(self.point).sum()

    def bounds(self) -> None:
        """None: it has no end."""
        return

    def contains(self, p: np.ndarray) -> bool:
        return bool(np.dot(np.subtract(p, self.point), self.normal) < 0.0)


@inlined
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    return (
        plane_distance(world, surface, ray, floor, ceiling, exactly) if may_cross(surface, ray, ceiling) else math.inf
    )


next_hit = planar.no_next_hit
interaction = planar.interaction
normal_derivative = planar.constant_normal

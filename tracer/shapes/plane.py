"""Plane: all p with n.(p - a) = 0, without end. As a solid it is the half-space its normal points away from."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.jit import compiled
from tracer.rays import Ray
from tracer.shapes import planar
from tracer.shapes.planar import plane_distance
from tracer.vector import Vector, tame, unit

NAME = "plane"


@dataclass(frozen=True, slots=True)
class Plane:
    point: Vector = field(metadata=fields.point())
    normal: Vector = field(metadata=fields.direction())

    def pack(self, rows: Any) -> None:
        rows["a"] = self.point
        rows["normal"] = unit(tame(self.normal))
        rows["r"] = np.abs(self.point).sum()

    def bounds(self) -> None:
        """None: it has no end."""
        return

    def contains(self, p: np.ndarray) -> bool:
        return bool(np.dot(np.subtract(p, self.point), self.normal) < 0.0)


@compiled
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float) -> float:
    t, _ = plane_distance(world, surface, ray, ceiling)
    return t if t >= floor else np.inf


again = planar.never
locate = planar.locate

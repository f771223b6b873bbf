"""Sphere: |p - c|^2 = r^2. Packed as a = centre, r = radius.

The slides' quadratic, in the form of Haines, Günther & Akenine-Möller (Ray Tracing Gems, ch. 7): the discriminant from
the ray's distance to the centre, not from two large numbers, and the root that would cancel as the product of both
roots over the other one.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.jit import compiled
from tracer.rays import Ray
from tracer.vector import Vector, add, dot, length, scale, subtract, vector

NAME = "sphere"


@dataclass(frozen=True, slots=True)
class Sphere:
    center: Vector = field(metadata=fields.point())
    radius: float = field(metadata=fields.number(above=0))

    def pack(self, rows: Any) -> None:
        rows["a"] = self.center
        rows["r"] = self.radius

    def bounds(self) -> np.ndarray:
        """(1, 2, 3): lowest and highest corner."""
        center = np.array(self.center)
        return np.stack([center - self.radius, center + self.radius])[None]

    def contains(self, p: np.ndarray) -> bool:
        return math.dist(p, self.center) < self.radius


@compiled
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float) -> float:
    f = subtract(ray.origin, vector(surface.a))
    b = -dot(f, ray.direction)
    beside = add(f, scale(b, ray.direction))  # from the centre to the ray's closest point
    r2 = surface.r * surface.r
    discriminant = r2 - dot(beside, beside)
    if discriminant < 0.0:
        return math.inf
    q = b + math.copysign(math.sqrt(discriminant), b)
    product = (dot(f, f) - r2) / q if q != 0.0 else 0.0
    near, far = min(q, product), max(q, product)
    if near > 0.0 and near >= floor:
        return near
    if far > 0.0 and far >= floor:
        return far
    return math.inf


@compiled
def again(world: Any, surface: Any, ray: Ray) -> float:
    """The other end of the chord, for a ray that starts on this sphere: t = -2 f.d, no quadratic left to solve."""
    chord = -2.0 * dot(subtract(ray.origin, vector(surface.a)), ray.direction)
    return chord if ray.side < 0.0 and chord > 0.0 else math.inf


@compiled
def locate(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    center = vector(surface.a)
    f = subtract(add(ray.origin, scale(t, ray.direction)), center)
    n = scale(1.0 / length(f), f)
    return (add(center, scale(surface.r, n)), n, n)

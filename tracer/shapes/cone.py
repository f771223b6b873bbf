"""Cone: the side of a cone, of a frustum or, with equal radii, of a cylinder: open at both ends, as in E. Haines' NFF.

Packed as a = the narrow end, b = unit axis from there to the wide end, r = radius at a, c = (cosine and sine of the
angle between axis and side, height). From the narrow end, because there every digit of a short distance counts.

|across|^2 = radius(height)^2 is a quadratic A t^2 + 2 B t + C. Multiplied by the cosine squared nothing in it grows
without limit however flat the cone is, and a cylinder is no special case. With f, d the ray's start and direction
across the axis, rho and rise the radius there and its growth along the ray, all four times the cosine,
    A = d.d - rise^2    B = f.d - rise rho    C = f.f - rho^2    B^2 - A C = |rho d - rise f|^2 - |f x d|^2
(Lagrange's identity): each difference of squares is written as a product, the last one instead of the difference of
large numbers that it equals. The root that would cancel is the product of both over the other (as in `sphere`).
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.vector import Vector, add, cross, dot, length, negate, rescale, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes.disc import Disc

NAME = "cone"


@dataclass(frozen=True, slots=True)
class Cone:
    base: Vector = field(metadata=fields.point())
    base_radius: float = field(metadata=fields.number(least=0))
    apex: Vector = field(metadata=fields.point())
    apex_radius: float = field(metadata=fields.number(least=0))

    def ends(self) -> tuple[Vector, Vector]:
        """The centres of the narrow and of the wide end; of a cylinder, base and apex."""
        return (self.base, self.apex) if self.base_radius <= self.apex_radius else (self.apex, self.base)

    def axis(self) -> Vector:
        """From the narrow end to the wide one, as long as the cone is high."""
        narrow, wide = self.ends()
        return subtract(wide, narrow)

    def pack(self, rows: Any) -> None:
        height = math.hypot(*self.axis())
        growth = abs(self.base_radius - self.apex_radius)
        side = math.hypot(height, growth)
        rows["a"] = self.ends()[0]
        rows["b"] = unit(rescale(self.axis()))
        rows["r"] = min(self.base_radius, self.apex_radius)
        rows["c"] = (height / side, growth / side, height)

    def bounds(self) -> np.ndarray:
        """Those of its two ends: between them it is straight."""
        axis = self.axis()
        rims = [Disc(self.base, axis, self.base_radius).bounds(), Disc(self.apex, axis, self.apex_radius).bounds()]
        both = np.concatenate(rims)
        return np.stack([both[:, 0].min(axis=0), both[:, 1].max(axis=0)])[None]

    def contains(self, p: np.ndarray) -> bool:
        return False

    def faults(self) -> list[str]:
        found = []
        if self.base == self.apex:
            found.append(f"apex must differ from base, got {fields.shown(self.base)} for both")
        if self.base_radius == 0.0 and self.apex_radius == 0.0:
            found.append("base_radius or apex_radius must be > 0, got 0 for both")
        return found


@inlined
def split_along(axis: Vector, v: Vector) -> tuple[float, Vector]:
    """How far v goes along a unit axis, and its part across."""
    along = dot(axis, v)
    return (along, subtract(v, scale(along, axis)))


@inlined
def quadratic_terms(surface: Any, ray: Ray) -> tuple[float, float, Vector, Vector, float, float]:
    """(height of the ray's start, its climb, f, d, rho, rise)."""
    axis = vector(surface.b)
    cosine, sine = surface.c[0], surface.c[1]
    height, f = split_along(axis, subtract(ray.origin, vector(surface.a)))
    climb, d = split_along(axis, ray.direction)
    rho = cosine * surface.r + sine * height
    return (height, climb, scale(cosine, f), scale(cosine, d), rho, sine * climb)


@inlined
def difference_of_squares(a: float, b: float) -> float:
    """a^2 - b^2."""
    return (a - b) * (a + b)


@inlined
def is_within_height(surface: Any, height: float) -> bool:
    """Whether this height is the cone's; then it is on the right one of the double cone's halves too."""
    return 0.0 <= height <= surface.c[2]


@compiled
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    noinline()
    height, climb, f, d, rho, rise = quadratic_terms(surface, ray)
    bend = length(subtract(scale(rho, d), scale(rise, f)))
    beside = dot(vector(surface.b), cross(f, d))  # f and d have no part along the axis, their product has no other
    discriminant = difference_of_squares(bend, beside)
    if discriminant < 0.0:
        return math.inf
    b = dot(f, d) - rise * rho
    q = -(b + math.copysign(math.sqrt(discriminant), b))
    if q == 0.0:  # it runs along the side, or starts where it touches it
        return math.inf
    a = difference_of_squares(length(d), rise)
    one = difference_of_squares(length(f), rho) / q
    other = q / a if a != 0.0 else math.inf  # none: it is parallel to the side somewhere
    near, far = min(one, other), max(one, other)
    if near > 0.0 and near >= floor and is_within_height(surface, height + near * climb):
        return near
    if 0.0 < far < math.inf and far >= floor and is_within_height(surface, height + far * climb):
        return far
    return math.inf


@inlined
def next_hit(world: Any, surface: Any, ray: Ray) -> float:
    """Where a ray that leaves inwards meets the side once more: C is 0, and t = -2 B / A.

    Inwards B < 0. Where A <= 0 the ray is steeper than the side and meets the double cone only behind it.
    """
    height, climb, f, d, rho, rise = quadratic_terms(surface, ray)
    a, b = difference_of_squares(length(d), rise), dot(f, d) - rise * rho
    if ray.side > 0.0 or a <= 0.0 or b >= 0.0:
        return math.inf
    t = -2.0 * b / a
    return t if t < math.inf and is_within_height(surface, height + t * climb) else math.inf


@inlined
def interaction(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit moved along the normal onto the side. At the very tip the normal is the axis, outwards.

    The height's rounding leaves a part along the axis in f: taken out again. Where that was most of f, f was nothing
    but rounding, and the hit is on the axis.
    """
    axis = vector(surface.b)
    cosine, sine = surface.c[0], surface.c[1]
    p = add(ray.origin, scale(t, ray.direction))
    height, f = split_along(axis, subtract(p, vector(surface.a)))
    _, across = split_along(axis, f)
    size = length(across)
    if size <= 0.5 * length(f):
        return (p, negate(axis), negate(axis))
    n = subtract(scale(cosine / size, across), scale(sine, axis))
    off = cosine * (size - surface.r) - sine * height
    return (subtract(p, scale(off, n)), n, n)


@inlined
def normal_derivative(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
    """About the axis only: along the side the normal stays."""
    axis = vector(surface.b)
    _, across = split_along(axis, subtract(p, vector(surface.a)))
    size = length(across)
    if size == 0.0:
        return (math.inf, math.inf, math.inf)  # at the tip it may be anything
    around = scale(1.0 / size, cross(axis, across))
    return scale(surface.c[0] / size * dot(around, v), around)

"""Cone: the side of a cone, of a frustum or, with equal radii, of a cylinder. Open at both ends, as in E. Haines' NFF.

Packed as a = centre of the narrow end, b = unit axis from there to the wide end, r = radius at a, c = (cosine and
sine of the angle between axis and side, height). Heights count from the narrow end, where short distances need their
digits.

|across|^2 = radius(height)^2 is a quadratic A t^2 + 2 B t + C in t. Times cosine^2, no coefficient grows without
bound however flat the cone is, and a cylinder is no special case. Let f and d be the parts of the ray's origin and
direction across the axis, rho the radius at the origin's height and rise its change along the ray, all times the
cosine:

    A = d.d - rise^2    B = f.d - rise rho    C = f.f - rho^2    B^2 - A C = |rho d - rise f|^2 - |f x d|^2

(the last by Lagrange's identity). Differences of squares are computed as products. The root that would cancel is C/q
(as in `sphere`).
"""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.vector import Vector, add, cross, dot, length, negate, rescale, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes.disc import Disc
from tracer.shapes.exact import Exact, dot as exact_dot, exact, minus
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import unit_circle


@dataclass(frozen=True, slots=True)
class Cone(Shape):
    name: ClassVar[str] = "cone"

    base: Vector = field(metadata=fields.point())
    base_radius: float = field(metadata=fields.number(least=0))
    apex: Vector = field(metadata=fields.point())
    apex_radius: float = field(metadata=fields.number(least=0))

    @classmethod
    def example(cls) -> "Cone":
        return cls((0.0, -1.0, 0.0), 1.0, (0.0, 1.0, 0.0), 0.5)

    def ends(self) -> tuple[Vector, Vector]:
        """The centres of the narrow and of the wide end; of a cylinder, base and apex."""
        return (self.base, self.apex) if self.base_radius <= self.apex_radius else (self.apex, self.base)

    def axis(self) -> Vector:
        """The vector from the narrow end to the wide end, as long as the cone is high."""
        narrow, wide = self.ends()
        return subtract(wide, narrow)

    def pack(self, rows: np.ndarray) -> None:
        height = math.hypot(*self.axis())
        growth = abs(self.base_radius - self.apex_radius)
        side = math.hypot(height, growth)
        rows["a"] = self.ends()[0]
        rows["b"] = unit(rescale(self.axis()))
        rows["r"] = min(self.base_radius, self.apex_radius)
        rows["c"] = (height / side, growth / side, height)

    def bounds(self) -> np.ndarray:
        """The box about its two end discs: the side between them is straight."""
        axis = self.axis()
        rims = [Disc(self.base, axis, self.base_radius).bounds(), Disc(self.apex, axis, self.apex_radius).bounds()]
        both = np.concatenate(rims)
        return np.stack([both[:, 0].min(axis=0), both[:, 1].max(axis=0)])[None]

    def touches(self, p: Exact, row: int) -> bool:
        """All in terms of the base: |arm|^2 - along^2 / L^2 = (r + (r1 - r) along / L^2)^2 with along = arm.axis."""
        arm, axis = minus(p, exact(self.base)), minus(exact(self.apex), exact(self.base))
        along, square = exact_dot(arm, axis), exact_dot(axis, axis)
        base, apex = Fraction(self.base_radius), Fraction(self.apex_radius)
        radius = base + (apex - base) * along / square
        return 0 <= along <= square and exact_dot(arm, arm) - along**2 / square == radius**2

    def faults(self) -> list[str]:
        found = []
        if self.base == self.apex:
            found.append(f"apex must differ from base, got {fields.shown(self.base)} for both")
        if self.base_radius == 0.0 and self.apex_radius == 0.0:
            found.append("base_radius or apex_radius must be > 0, got 0 for both")
        return found

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """A strip between its two circles, with the cone's normals. A tip needs one triangle of each pair."""
        narrow, wide = self.ends()
        axis = self.axis()
        height, growth = math.hypot(*axis), abs(self.base_radius - self.apex_radius)
        circle = unit_circle(axis)
        r = min(self.base_radius, self.apex_radius)
        low, high = np.array(narrow) + r * circle, np.array(wide) + (r + growth) * circle
        n = (height * circle - growth * np.array(unit(rescale(axis)))) / math.hypot(height, growth)
        corners = np.stack([low[:-1], high[1:], high[:-1]], axis=1)
        normals = np.stack([n[:-1], n[1:], n[:-1]], axis=1)
        if r > 0.0:
            corners = np.concatenate([corners, np.stack([low[:-1], low[1:], high[1:]], axis=1)])
            normals = np.concatenate([normals, np.stack([n[:-1], n[1:], n[1:]], axis=1)])
        return corners, normals


@inlined
def split_along(axis: Vector, v: Vector) -> tuple[float, Vector]:
    """(component of v along a unit axis, part of v across it)."""
    along = dot(axis, v)
    return (along, subtract(v, scale(along, axis)))


@inlined
def quadratic_terms(surface: SurfaceRow, ray: Ray) -> tuple[float, float, Vector, Vector, float, float]:
    """(height of the ray's origin, its change along the ray, f, d, rho, rise)."""
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
def is_within_height(surface: SurfaceRow, height: float) -> bool:
    """Whether the height is between the two ends, and so on the right half of the double cone."""
    return 0.0 <= height <= surface.c[2]


@compiled
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The first root of the quadratic that is between the two ends."""
    noinline()
    height, climb, f, d, rho, rise = quadratic_terms(surface, ray)
    bend = length(subtract(scale(rho, d), scale(rise, f)))
    beside = dot(vector(surface.b), cross(f, d))  # f and d are across the axis, so f x d is along it
    discriminant = difference_of_squares(bend, beside)
    if discriminant < 0.0:
        return math.inf
    b = dot(f, d) - rise * rho
    q = -(b + math.copysign(math.sqrt(discriminant), b))
    if q == 0.0:  # the ray runs along the side, or starts where it touches it
        return math.inf
    a = difference_of_squares(length(d), rise)
    one = difference_of_squares(length(f), rho) / q
    other = q / a if a != 0.0 else math.inf  # one root only: the ray is parallel to a line of the side
    near, far = min(one, other), max(one, other)
    if near > 0.0 and near >= t_min and is_within_height(surface, height + near * climb):
        return near
    if 0.0 < far < math.inf and far >= t_min and is_within_height(surface, height + far * climb):
        return far
    return math.inf


@inlined
def next_hit(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """The distance at which a ray that starts on the side and goes inwards meets it again: C is 0, so t = -2 B / A.

    Inwards, B < 0. Where A <= 0, the ray is steeper than the side and meets the double cone only behind its origin.
    """
    height, climb, f, d, rho, rise = quadratic_terms(surface, ray)
    a, b = difference_of_squares(length(d), rise), dot(f, d) - rise * rho
    if ray.side > 0.0 or a <= 0.0 or b >= 0.0:
        return math.inf
    t = -2.0 * b / a
    return t if t < math.inf and is_within_height(surface, height + t * climb) else math.inf


@inlined
def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit point, moved along the normal onto the side, and the normal twice. At the tip it is the axis, outwards.

    Rounding of the height leaves a part along the axis in f, which is removed. If that was most of f, then f is only
    rounding error, and the hit is on the axis.
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
def normal_derivative(world: ShapeArrays, surface: SurfaceRow, p: Vector, v: Vector) -> Vector:
    """The normal turns only about the axis; along a line of the side it is constant."""
    axis = vector(surface.b)
    _, across = split_along(axis, subtract(p, vector(surface.a)))
    size = length(across)
    if size == 0.0:
        return (math.inf, math.inf, math.inf)  # at the tip the normal is undefined
    around = scale(1.0 / size, cross(axis, across))
    return scale(surface.c[0] / size * dot(around, v), around)

"""Sphere: |p - c|^2 = r^2. Packed as a = centre, r = radius.

The slides' quadratic. Whether the ray hits, and about where, is asked of the form by Haines, Günther & Akenine-Möller
(Ray Tracing Gems, ch. 7): the discriminant from the ray's distance to the centre, not from two large numbers. Spheres
much larger or much smaller than their distance leave it too few digits. So a root that is kept takes one Newton step
from a residual that does not cancel; and where the form cannot decide, the quadratic is solved in pairs.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import (
    DD,
    SMALLEST,
    DDVector,
    U,
    dd_add,
    dd_cross,
    dd_divide,
    dd_dot,
    dd_multiply,
    dd_sqrt,
    dd_subtract,
    dd_vector,
    exact_difference,
    quick_two_sum,
    two_product,
    two_sum,
)
from tracer.formulas.vector import Vector, add, dot, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes.planar import SPHERE_COUNT

NAME = "sphere"

# The quick form gets the ray's closest point to the centre wrong by 8 u |f| at most, f from the centre to the ray's
# start; so the discriminant by less than SHARE of (CLOSE (r^2 + beside^2) + ROUGH |f|^2), since 2xy <= x^2 + y^2.
SHARE = 2.0**-10
CLOSE = 2.0**-20
ROUGH = (8 * U) ** 2 / (SHARE * SHARE * CLOSE)
POWER = 32 * U  # |f|^2 - r^2 has the right sign where it is more than this of |f|^2 + r^2

# Times the way to the hit: a sphere so large has a centre too far, one so small a surface too fine, to start from.
LARGE = 4.0
SMALL = 2.0**20


@dataclass(frozen=True, slots=True)
class Sphere:
    center: Vector = field(metadata=fields.point())
    radius: float = field(metadata=fields.number(above=0))

    def pack(self, rows: Any) -> None:
        rows["a"] = self.center
        rows["r"] = self.radius
        rows["count"] = SPHERE_COUNT

    def bounds(self) -> np.ndarray:
        """(1, 2, 3): lowest and highest corner."""
        center = np.array(self.center)
        return np.stack([center - self.radius, center + self.radius])[None]

    def contains(self, p: np.ndarray) -> bool:
        return math.dist(p, self.center) < self.radius


@inlined
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    f = subtract(ray.origin, vector(surface.a))
    b = -dot(f, ray.direction)
    beside = add(f, scale(b, ray.direction))  # from the centre to the ray's closest point
    r2, beside2 = surface.r * surface.r, dot(beside, beside)
    discriminant = r2 - beside2
    doubt = CLOSE * (r2 + beside2) + ROUGH * (b * b)
    if discriminant < -doubt:
        return math.inf
    power = dot(f, f) - r2  # the product of both roots: above 0 outside
    if not (discriminant > doubt and abs(power) > POWER * (power + 2.0 * r2)):
        return first_root(surface, ray, floor, ceiling)
    if power > 0.0 and b < 0.0:
        return math.inf
    half_chord = math.sqrt(discriminant)
    first = b - math.copysign(half_chord, power)
    doubt = SHARE * half_chord + POWER * abs(b)
    if first - doubt > ceiling:
        return math.inf
    if not exactly and first - doubt > floor and first + doubt < ceiling:
        return first
    t = refined_root(surface, ray, first)
    if t < floor and power > 0.0:
        t = refined_root(surface, ray, b + half_chord)
    return t if floor <= t <= ceiling else math.inf


@inlined
def refined_root(surface: Any, ray: Ray, t: float) -> float:
    """The root near t, to the last digit, by a Newton step: g(t) = |f + t d|^2 - r^2, g'(t) = 2 (f + t d).d."""
    p, g = residual(surface, ray, t)
    slope = dot((p[0][0], p[1][0], p[2][0]), ray.direction)
    step = g / (2.0 * slope)
    # What a second step would still move it by, and what the slope's own rounding does.
    if abs(step) * (abs(step) + 8 * U * surface.r) <= 0.125 * U * abs(t * slope):
        return t - step
    near, far = roots(surface, ray)
    return near if slope < 0.0 else far


@inlined
def residual(surface: Any, ray: Ray, t: float) -> tuple[DDVector, float]:
    """From the centre to the point at t, and that vector's |p|^2 - r^2."""
    x = dd_coordinate(ray.origin[0], surface.a[0], t, ray.direction[0])
    y = dd_coordinate(ray.origin[1], surface.a[1], t, ray.direction[1])
    z = dd_coordinate(ray.origin[2], surface.a[2], t, ray.direction[2])
    xx, yy, zz = two_product(x[0], x[0]), two_product(y[0], y[0]), two_product(z[0], z[0])
    rr = two_product(surface.r, surface.r)
    two = two_sum(xx[0], yy[0])
    three = two_sum(two[0], zz[0])
    four = two_sum(three[0], -rr[0])
    low = (two[1] + three[1] + four[1]) + (xx[1] + yy[1] + zz[1] - rr[1])
    return ((x, y, z), four[0] + (low + 2.0 * (x[0] * x[1] + y[0] * y[1] + z[0] * z[1])))


@inlined
def dd_coordinate(o: float, c: float, t: float, d: float) -> DD:
    """o - c + t d."""
    start, way = two_sum(o, -c), two_product(t, d)
    total = two_sum(start[0], way[0])
    return quick_two_sum(total[0], total[1] + (start[1] + way[1]))


@compiled
def first_root(surface: Any, ray: Ray, floor: float, ceiling: float) -> float:
    """`intersect` where the quick form cannot tell."""
    noinline()
    near, far = roots(surface, ray)
    t = near if near > 0.0 and near >= floor else far
    return t if t > 0.0 and floor <= t <= ceiling else math.inf


@compiled
def roots(surface: Any, ray: Ray) -> tuple[float, float]:
    """Both roots of A t^2 + 2 B t + C = 0, solved in pairs; infinite where there are none.

    The discriminant B^2 - A C is A r^2 - |f x d|^2 (Lagrange's identity); q/A and C/q never cancel.
    """
    noinline()
    f, d = exact_difference(ray.origin, vector(surface.a)), dd_vector(ray.direction)
    a, b = dd_dot(d, d), dd_dot(f, d)
    r2 = two_product(surface.r, surface.r)
    across = dd_cross(f, d)
    discriminant = dd_subtract(dd_multiply(a, r2), dd_dot(across, across))
    if not discriminant[0] >= 0.0:
        return (math.inf, math.inf)
    half_chord = dd_sqrt(discriminant)
    if b[0] < 0.0:
        q = dd_subtract(half_chord, b)
        return (dd_divide(dd_subtract(dd_dot(f, f), r2), q), dd_divide(q, a))
    q = dd_add(half_chord, b)
    if q[0] == 0.0:
        return (0.0, 0.0)
    near = -dd_divide(q, a)
    return (near, -dd_divide(dd_subtract(dd_dot(f, f), r2), q))


@inlined
def next_hit(world: Any, surface: Any, ray: Ray) -> float:
    """The other end of the chord, for a ray that starts on this sphere: t = -2 f.d, no quadratic left to solve."""
    chord = -2.0 * dot(subtract(ray.origin, vector(surface.a)), ray.direction)
    return max(chord, SMALLEST) if ray.side < 0.0 else math.inf


@inlined
def interaction(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit, put onto the sphere, and its normal."""
    reach = ray.reach + t
    if surface.r > LARGE * reach or reach > SMALL * surface.r:
        return careful_interaction(surface, ray, t)
    center = vector(surface.a)
    f = subtract(add(ray.origin, scale(t, ray.direction)), center)
    n = unit(f)
    return (add(center, scale(surface.r, n)), n, n)


@compiled
def careful_interaction(surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """`locate` on a sphere whose centre or whose size is out of all proportion to the way there."""
    noinline()
    d, r = ray.direction, surface.r
    f, g = residual(surface, ray, t)
    to_hit = (f[0][0], f[1][0], f[2][0])
    if r > ray.reach + t:  # the centre has fewer digits than the hit: move this along the normal, no more
        n = unit(to_hit)
        p = add(ray.origin, scale(t, d))
        return (subtract(p, scale(0.5 * g / r, n)), n, n)
    # t has fewer digits than the sphere: from the ray's closest point, half a chord back or on.
    along = dot(to_hit, d)
    beside = scale(1.0 / r, subtract(to_hit, scale(along, d)))
    half_chord = math.sqrt(max(1.0 - dot(beside, beside), 0.0))
    center = vector(surface.a)
    back = t <= -dot(subtract(ray.origin, center), d) and ray.side >= 0.0
    n = unit(add(beside, scale(-half_chord if back else half_chord, d)))
    return (add(center, scale(r, n)), n, n)


@inlined
def normal_derivative(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
    n = unit(subtract(p, vector(surface.a)))
    return scale(1.0 / surface.r, subtract(v, scale(dot(n, v), n)))

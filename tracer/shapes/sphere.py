"""Sphere: |p - c|^2 = r^2. Packed as a = centre, r = radius.

The slides' quadratic, solved in three steps. First the form by Haines, Günther & Akenine-Möller (Ray Tracing Gems,
ch. 7) decides whether the ray hits, and about where: its discriminant comes from the distance between ray and
centre, not from the difference of two large numbers. Then a root that is kept takes one Newton step, from a residual
in double-double: a sphere much larger or smaller than its distance leaves the first form too few digits. Where the
first form cannot decide, the whole quadratic is solved in double-double.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

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
from tracer.formulas.exact import Exact, dot as exact_dot, exact, minus
from tracer.formulas.vector import Vector, add, dot, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes.outline import SPHERE_COUNT
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import unit_ball

# In the first form, the error of the ray's closest point to the centre is at most 8 u |f|, where f leads from the
# centre to the ray's origin. So its discriminant is off by less than SHARE (CLOSE (r^2 + beside^2) + ROUGH |f|^2),
# since 2xy <= x^2 + y^2.
SHARE = 2.0**-10
CLOSE = 2.0**-20
ROUGH = (8 * U) ** 2 / (SHARE * SHARE * CLOSE)
POWER_ERROR = 32 * U  # |f|^2 - r^2 has the right sign where it is more than this times |f|^2 + r^2

# A hit point is not computed from the centre if the radius is above LARGE times the distance to the hit, or below
# 1/SMALL times it.
LARGE = 4.0
SMALL = 2.0**20


@dataclass(frozen=True, slots=True)
class Sphere(Shape):
    name: ClassVar[str] = "sphere"
    has_edges: ClassVar[bool] = False

    center: Vector = field(metadata=fields.point())
    radius: float = field(metadata=fields.number(above=0))

    @classmethod
    def example(cls) -> "Sphere":
        return cls((0.0, 0.0, 0.0), 1.0)

    def pack(self, rows: np.ndarray) -> None:
        rows["a"] = self.center
        rows["r"] = self.radius
        rows["count"] = SPHERE_COUNT

    @classmethod
    def pack_together(cls, shapes: Sequence["Sphere"], rows: np.ndarray) -> np.ndarray:
        centers, radii = np.array([s.center for s in shapes]), np.array([s.radius for s in shapes])
        rows["a"], rows["r"], rows["count"] = centers, radii, SPHERE_COUNT
        return np.stack([centers - radii[:, None], centers + radii[:, None]], axis=1)

    def bounds(self) -> np.ndarray:
        center = np.array(self.center)
        return np.stack([center - self.radius, center + self.radius])[None]

    def is_closed(self) -> bool:
        return True

    def contains(self, p: np.ndarray) -> bool:
        distance = math.dist(p, self.center)
        if abs(distance - self.radius) > 8 * U * (distance + self.radius):
            return distance < self.radius
        return self._power(exact(p)) < 0

    def contains_each(self, points: np.ndarray) -> np.ndarray:
        inside = np.linalg.norm(points - self.center, axis=1) < self.radius
        for k in np.flatnonzero(self.may_touch(points, 0)).tolist():
            inside[k] = self.contains(points[k])
        return inside

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        distance = np.linalg.norm(points - self.center, axis=1)
        return np.abs(distance - self.radius) <= 8 * U * (np.abs(points).sum(axis=1) + distance + self.radius)

    def touches(self, p: Exact, row: int) -> bool:
        return self._power(p) == 0

    def _power(self, p: Exact) -> Fraction:
        arm = minus(p, exact(self.center))
        return exact_dot(arm, arm) - Fraction(self.radius) ** 2

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        corners, faces = unit_ball()
        return (np.array(self.center) + self.radius * corners)[faces], corners[faces]


@inlined
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The first root of the quadratic between t_min and t_max."""
    f = subtract(ray.origin, vector(surface.a))
    b = -dot(f, ray.direction)
    beside = add(f, scale(b, ray.direction))  # from the centre to the ray's closest point
    r2, beside2 = surface.r * surface.r, dot(beside, beside)
    discriminant = r2 - beside2
    error = CLOSE * (r2 + beside2) + ROUGH * (b * b)
    if discriminant < -error:
        return math.inf
    power = dot(f, f) - r2  # the product of both roots, positive outside the sphere
    if not (discriminant > error and abs(power) > POWER_ERROR * (power + 2.0 * r2)):
        return first_root(surface, ray, t_min, t_max)
    if power > 0.0 and b < 0.0:
        return math.inf
    half_chord = math.sqrt(discriminant)
    first = b - math.copysign(half_chord, power)
    error = SHARE * half_chord + POWER_ERROR * abs(b)
    if first - error > t_max:
        return math.inf
    if not exact and first - error > t_min and first + error < t_max:
        return first
    t = refined_root(surface, ray, first)
    if t < t_min and power > 0.0:
        t = refined_root(surface, ray, b + half_chord)
    return t if t_min <= t <= t_max else math.inf


@inlined
def refined_root(surface: SurfaceRow, ray: Ray, t: float) -> float:
    """The root near t, accurate to the last digit.

    A Newton step for g(t) = |f + t d|^2 - r^2 with g'(t) = 2 (f + t d).d; both roots in double-double where one step is
    not enough.
    """
    p, g = residual(surface, ray, t)
    slope = dot((p[0][0], p[1][0], p[2][0]), ray.direction)
    step = g / (2.0 * slope)
    # The left side bounds what a second step would change, and the effect of rounding in the slope.
    if abs(step) * (abs(step) + 8 * U * surface.r) <= 0.125 * U * abs(t * slope):
        return t - step
    near, far = roots(surface, ray)
    return near if slope < 0.0 else far


@inlined
def residual(surface: SurfaceRow, ray: Ray, t: float) -> tuple[DDVector, float]:
    """(p, |p|^2 - r^2), where p is the vector from the centre to the ray's point at t."""
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
    """o - c + t d in double-double."""
    start, way = two_sum(o, -c), two_product(t, d)
    total = two_sum(start[0], way[0])
    return quick_two_sum(total[0], total[1] + (start[1] + way[1]))


@compiled
def first_root(surface: SurfaceRow, ray: Ray, t_min: float, t_max: float) -> float:
    """`intersect` where the first form cannot decide."""
    noinline()
    near, far = roots(surface, ray)
    t = near if near > 0.0 and near >= t_min else far
    return t if t > 0.0 and t_min <= t <= t_max else math.inf


@compiled
def roots(surface: SurfaceRow, ray: Ray) -> tuple[float, float]:
    """Both roots of A t^2 + 2 B t + C = 0, solved in double-double; inf where there are none.

    The discriminant B^2 - A C is A r^2 - |f x d|^2 (Lagrange's identity). The roots q/A and C/q never cancel.
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
def next_hit(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """The other end of the chord, for a ray that starts on this sphere: t = -2 f.d."""
    chord = -2.0 * dot(subtract(ray.origin, vector(surface.a)), ray.direction)
    return max(chord, SMALLEST) if ray.side < 0.0 else math.inf


@inlined
def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit point, moved onto the sphere, and the normal twice."""
    reach = ray.magnitude + t
    if surface.r > LARGE * reach or reach > SMALL * surface.r:
        return accurate_interaction(surface, ray, t)
    center = vector(surface.a)
    f = subtract(add(ray.origin, scale(t, ray.direction)), center)
    n = unit(f)
    return (add(center, scale(surface.r, n)), n, n)


@compiled
def accurate_interaction(surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """`interaction` on a sphere that is much larger or much smaller than the distance to the hit."""
    noinline()
    d, r = ray.direction, surface.r
    f, g = residual(surface, ray, t)
    to_hit = (f[0][0], f[1][0], f[2][0])
    if r > ray.magnitude + t:  # the centre has fewer digits than the hit: move the hit along the normal only
        n = unit(to_hit)
        p = add(ray.origin, scale(t, d))
        return (subtract(p, scale(0.5 * g / r, n)), n, n)
    # t has fewer digits than the sphere: start from the ray's closest point to the centre, and go half a chord.
    along = dot(to_hit, d)
    beside = scale(1.0 / r, subtract(to_hit, scale(along, d)))
    half_chord = math.sqrt(max(1.0 - dot(beside, beside), 0.0))
    center = vector(surface.a)
    back = t <= -dot(subtract(ray.origin, center), d) and ray.side >= 0.0
    n = unit(add(beside, scale(-half_chord if back else half_chord, d)))
    return (add(center, scale(r, n)), n, n)


@inlined
def normal_derivative(world: ShapeArrays, surface: SurfaceRow, p: Vector, v: Vector) -> Vector:
    """The part of v in the tangent plane, divided by the radius."""
    n = unit(subtract(p, vector(surface.a)))
    return scale(1.0 / surface.r, subtract(v, scale(dot(n, v), n)))

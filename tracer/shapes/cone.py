"""Cone: the side of a cone, of a frustum or, with equal radii, of a cylinder. Open at both ends, as in E. Haines' NFF;
with `closed = true` its end discs belong to it, and it is one solid.

Packed as a = centre of the narrow end, normal + normal_low = the axis from there to the wide end, b = the same as a
unit vector, r = radius at a, c = (cosine and sine of the angle between axis and side, radius of the wide end), and
count = CLOSED for a closed cone. Heights count from the narrow end, where short distances need their digits.

A quick test finds most rays that miss: with f and d the parts of the ray's origin and direction across the axis, rho
the radius at the origin's height and rise its change along the ray, all times the cosine, a ray misses the double
cone if |rho d - rise f| < |f x d|. Other rays are solved in double-double (`cone_roots`).
"""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import U, dd_quotient, exact_difference
from tracer.formulas.exact import Exact, dot as exact_dot, exact, minus
from tracer.formulas.vector import Vector, add, cross, dot, length, negate, rescale, scale, subtract, unit, vector
from tracer.rays import Ray
from tracer.shapes.cone_roots import (
    SIDE,
    WIDE,
    coefficients,
    height_above_side,
    inside,
    is_between_ends,
    line_of,
    precedes,
    side_roots,
)
from tracer.shapes.disc import Disc
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import unit_circle

CLOSED = -1  # `count` of a closed cone
ROUGH = 64 * U  # rounding error of the quick test, relative to the distance of the origin and the radius


@dataclass(frozen=True, slots=True)
class Cone(Shape):
    name: ClassVar[str] = "cone"

    base: Vector = field(metadata=fields.point())
    base_radius: float = field(metadata=fields.number(least=0))
    apex: Vector = field(metadata=fields.point())
    apex_radius: float = field(metadata=fields.number(least=0))
    closed: bool = field(default=False, metadata=fields.flag())

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
        narrow, wide = self.ends()
        rows["a"] = narrow
        rows["b"] = unit(rescale(self.axis()))
        rows["r"] = min(self.base_radius, self.apex_radius)
        rows["c"] = (height / side, growth / side, max(self.base_radius, self.apex_radius))
        for k, (high, low) in enumerate(exact_difference(wide, narrow)):
            rows["normal"][..., k], rows["normal_low"][..., k] = high, low
        rows["count"] = CLOSED if self.closed else 0

    def bounds(self) -> np.ndarray:
        """The box about its two end discs: the side between them is straight."""
        axis = self.axis()
        rims = [Disc(self.base, axis, self.base_radius).bounds(), Disc(self.apex, axis, self.apex_radius).bounds()]
        both = np.concatenate(rims)
        return np.stack([both[:, 0].min(axis=0), both[:, 1].max(axis=0)])[None]

    def is_closed(self) -> bool:
        return self.closed

    def contains(self, p: np.ndarray) -> bool:
        along, across = self._place(exact(p))
        return self.closed and 0 < along < 1 and across < 0

    def touches(self, p: Exact, row: int) -> bool:
        along, across = self._place(p)
        on_end = self.closed and along in (0, 1) and across <= 0
        return on_end or (0 <= along <= 1 and across == 0)

    def _place(self, p: Exact) -> tuple[Fraction, Fraction]:
        """(height above the base as a share of the cone's, square of the distance from the axis minus that of the
        radius there).
        """
        arm, axis = minus(p, exact(self.base)), minus(exact(self.apex), exact(self.base))
        along, square = exact_dot(arm, axis), exact_dot(axis, axis)
        base, apex = Fraction(self.base_radius), Fraction(self.apex_radius)
        share = along / square
        return share, exact_dot(arm, arm) - along * share - (base + (apex - base) * share) ** 2

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
        for disc in self._ends():
            cap, up = disc.triangles(middle, radius)
            corners, normals = np.concatenate([corners, cap]), np.concatenate([normals, up])
        return corners, normals

    def faces(self) -> list[tuple[Shape, ...]]:
        return [(self,), *((disc,) for disc in self._ends())]

    def _ends(self) -> list[Disc]:
        """The end discs of a closed cone, facing outwards."""
        axis = self.axis() if self.base_radius <= self.apex_radius else negate(self.axis())
        ends = [(self.base, negate(axis), self.base_radius), (self.apex, axis, self.apex_radius)]
        return [Disc(*end) for end in ends if self.closed and end[2] > 0.0]


@inlined
def split_along(axis: Vector, v: Vector) -> tuple[float, Vector]:
    """(component of v along a unit axis, part of v across it)."""
    along = dot(axis, v)
    return (along, subtract(v, scale(along, axis)))


@inlined
def misses(surface: SurfaceRow, ray: Ray) -> bool:
    """Whether the ray certainly misses the side and all that it encloses."""
    axis, arm = vector(surface.b), subtract(ray.origin, vector(surface.a))
    cosine, sine = surface.c[0], surface.c[1]
    height, f = split_along(axis, arm)
    climb, d = split_along(axis, ray.direction)
    f, d, rho, rise = scale(cosine, f), scale(cosine, d), cosine * surface.r + sine * height, sine * climb
    bend = length(subtract(scale(rho, d), scale(rise, f)))
    beside = abs(dot(axis, cross(f, d)))  # f and d are across the axis, so f x d is along it
    reach = length(arm) + abs(rho)
    goes_along = surface.count == CLOSED and length(d) <= abs(rise)  # steeper than the side: it may stay inside
    return bend + ROUGH * reach < beside and not goes_along


@inlined
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The first crossing of the side between the two ends, or of the surface of a closed cone."""
    return math.inf if misses(surface, ray) else first_crossing(surface, ray, t_min)


@compiled
def first_crossing(surface: SurfaceRow, ray: Ray, t_min: float) -> float:
    """`intersect` of a ray that may hit."""
    noinline()
    line = line_of(surface, ray)
    if surface.count == CLOSED:
        part = inside(line)
        if precedes(part.leave, part.enter):
            return math.inf
        if part.enter[0] > 0.0 and part.enter[0] >= t_min:
            return part.enter[0]
        return part.leave[0] if part.leave[0] > 0.0 and part.leave[0] >= t_min else math.inf
    near, far, _, crosses = side_roots(line)
    if crosses and near[0] > 0.0 and near[0] >= t_min and is_between_ends(line, near):
        return near[0]
    if crosses and 0.0 < far[0] < math.inf and far[0] >= t_min and is_between_ends(line, far):
        return far[0]
    return math.inf


@compiled
def next_hit(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """The distance at which a ray that starts on the cone and goes inwards meets it again.

    On the side of an open one C is 0, so t = -2 B / A. Inwards, B < 0. Where A <= 0, the ray is steeper than the side
    and meets the double cone only behind its origin.
    """
    if ray.side > 0.0:
        return math.inf
    line = line_of(surface, ray)
    if surface.count == CLOSED:
        return max(inside(line).leave[0], 0.0) + 0.0
    a, b, _ = coefficients(line)
    if a[0] <= 0.0 or b[0] >= 0.0:
        return math.inf
    t = dd_quotient((-2.0 * b[0], -2.0 * b[1]), a)
    return t[0] if t[0] < math.inf and is_between_ends(line, t) else math.inf


@compiled
def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit point, moved along the normal onto the surface, and the normal twice: at the tip the axis, outwards.

    Rounding of the height leaves a part along the axis in f, which is removed. If that was most of f, then f is only
    rounding error, and the hit is on the axis.
    """
    axis = vector(surface.b)
    p = add(ray.origin, scale(t, ray.direction))
    if surface.count == CLOSED:
        part = inside(line_of(surface, ray))
        leaves_here = ray.start == surface.coincident or part.enter[0] != t
        face = part.leave_face if leaves_here else part.enter_face
        if face != SIDE:
            return end_interaction(surface, p, face)
    cosine, sine = surface.c[0], surface.c[1]
    _, f = split_along(axis, subtract(p, vector(surface.a)))
    _, across = split_along(axis, f)
    size = length(across)
    if size <= 0.5 * length(f):
        n = outwards(surface, ray, negate(axis))
        return (p, n, n)
    n = outwards(surface, ray, subtract(scale(cosine / size, across), scale(sine, axis)))
    return (subtract(p, scale(height_above_side(surface, ray, t), n)), n, n)


@inlined
def outwards(surface: SurfaceRow, ray: Ray, n: Vector) -> Vector:
    """The normal at a hit. A ray that has started inside meets the cone from inside. Where rounding says otherwise, as
    at the tip, its direction is taken, one of the many normals that the tip has.
    """
    from_inside = ray.start == surface.coincident and ray.side < 0.0
    return ray.direction if from_inside and dot(n, ray.direction) <= 0.0 else n


@inlined
def end_interaction(surface: SurfaceRow, p: Vector, face: int) -> tuple[Vector, Vector, Vector]:
    """`interaction` at an end disc: the point is moved into its plane."""
    axis = vector(surface.b)
    center = vector(surface.a)
    if face == WIDE:
        center = add(center, vector(surface.normal))
        return (subtract(p, scale(dot(axis, subtract(p, center)), axis)), axis, axis)
    n = negate(axis)
    return (subtract(p, scale(dot(axis, subtract(p, center)), axis)), n, n)


@inlined
def normal_derivative(world: ShapeArrays, surface: SurfaceRow, p: Vector, v: Vector) -> Vector:
    """The normal turns only about the axis; along a line of the side, and on an end, it is constant."""
    axis = vector(surface.b)
    height, across = split_along(axis, subtract(p, vector(surface.a)))
    size = length(across)
    if surface.count == CLOSED:
        from_narrow = abs(height) if surface.r > 0.0 else math.inf  # a tip has no disc
        from_end = min(from_narrow, abs(height - length(vector(surface.normal))))
        if from_end < abs(surface.c[0] * (size - surface.r) - surface.c[1] * height):
            return (0.0, 0.0, 0.0)
    if size == 0.0:
        return (math.inf, math.inf, math.inf)  # at the tip the normal is undefined
    around = scale(1.0 / size, cross(axis, across))
    return scale(surface.c[0] / size * dot(around, v), around)

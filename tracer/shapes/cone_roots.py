"""Crossings of a ray with a cone: its side |across| = radius(height), and the planes of its ends, in double-double.

Let w be the axis from the narrow to the wide end, and f the vector from the narrow end to a point. With s = f.w and
L2 = w.w, the height is s / |w|, and the part of f across the axis, times L2, is F = L2 f - s w. With the radii r and
R, the radius at that height, times L2, is P = r L2 + (R - r) s. No root and no division is needed, so these numbers
are as accurate as the cone itself. On the side |F|^2 = P^2. Along a ray F and P are linear in t:

    A t^2 + 2 B t + C = 0,  A = |F1|^2 - P1^2,  B = F0.F1 - P0 P1,  C = |F0|^2 - P0^2
    B^2 - A C = |P0 F1 - P1 F0|^2 - |F0 x F1|^2    (Lagrange's identity)
"""

import math
from typing import NamedTuple

from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import (
    DD,
    DDVector,
    dd_add,
    dd_cross,
    dd_dot,
    dd_minus,
    dd_multiply,
    dd_quotient,
    dd_scale,
    dd_sqrt,
    dd_subtract,
    dd_vector,
    exact_difference,
    two_sum,
)
from tracer.formulas.vector import vector
from tracer.rays import Ray
from tracer.shapes.surface_row import SurfaceRow

SIDE, NARROW, WIDE = range(3)  # the faces of a closed cone
NEVER: DD = (math.inf, 0.0)
ALWAYS: DD = (-math.inf, 0.0)


class Line(NamedTuple):
    """A ray in terms of a cone: s, F and P at its origin, and their changes along it."""

    square: DD  # L2
    top: DD  # s at the wide end
    s0: DD
    s1: DD
    f0: DDVector
    f1: DDVector
    p0: DD
    p1: DD


class Crossings(NamedTuple):
    """The part of a ray inside the side of a cone, or inside a closed cone."""

    enter: DD
    leave: DD
    enter_face: int
    leave_face: int


@inlined
def shrunk(high: float, low: float, exponent: int) -> DD:
    """A number times 2^-exponent."""
    return (math.ldexp(high, -exponent), math.ldexp(low, -exponent))


@compiled
def line_of(surface: SurfaceRow, ray: Ray) -> Line:
    """The ray in terms of the cone, whose axis is scaled by a power of two to a length of about 1."""
    n, low = surface.normal, surface.normal_low
    _, e = math.frexp(max(abs(n[0]), max(abs(n[1]), abs(n[2]))))
    w = (shrunk(n[0], low[0], e), shrunk(n[1], low[1], e), shrunk(n[2], low[2], e))
    growth = two_sum(surface.c[2], -surface.r)
    growth = shrunk(growth[0], growth[1], e)
    square = dd_dot(w, w)
    f, d = exact_difference(ray.origin, vector(surface.a)), dd_vector(ray.direction)
    s0, s1 = dd_dot(f, w), dd_dot(d, w)
    return Line(
        square,
        (math.ldexp(square[0], e), math.ldexp(square[1], e)),
        s0,
        s1,
        dd_minus(dd_scale(square, f), dd_scale(s0, w)),
        dd_minus(dd_scale(square, d), dd_scale(s1, w)),
        dd_add(dd_multiply((surface.r, 0.0), square), dd_multiply(growth, s0)),
        dd_multiply(growth, s1),
    )


@inlined
def coefficients(line: Line) -> tuple[DD, DD, DD]:
    """A, B and C of the quadratic of the side."""
    return (
        dd_subtract(dd_dot(line.f1, line.f1), dd_multiply(line.p1, line.p1)),
        dd_subtract(dd_dot(line.f0, line.f1), dd_multiply(line.p0, line.p1)),
        dd_subtract(dd_dot(line.f0, line.f0), dd_multiply(line.p0, line.p0)),
    )


@compiled
def side_roots(line: Line) -> tuple[DD, DD, float, bool]:
    """(lower root, higher root, sign of A, whether there are any) of the quadratic of the side.

    Where A is 0 there is one root, and the other is infinite, on the side to which the ray gets farther from the axis.
    """
    noinline()
    a, b, c = coefficients(line)
    bend = dd_minus(dd_scale(line.p0, line.f1), dd_scale(line.p1, line.f0))
    beside = dd_cross(line.f0, line.f1)
    discriminant = dd_subtract(dd_dot(bend, bend), dd_dot(beside, beside))
    if not discriminant[0] >= 0.0:
        return (NEVER, NEVER, a[0], False)
    root = dd_sqrt(discriminant)
    q = dd_subtract(root, b) if b[0] < 0.0 else dd_subtract((-root[0], -root[1]), b)
    if q[0] == 0.0:  # the ray runs along the side, or touches it where it starts
        return (NEVER, NEVER, a[0], False)
    one = dd_quotient(c, q)
    if a[0] == 0.0:
        return (ALWAYS, one, a[0], True) if b[0] > 0.0 else (one, NEVER, a[0], True)
    other = dd_quotient(q, a)
    return (one, other, a[0], True) if precedes(one, other) else (other, one, a[0], True)


@inlined
def precedes(a: DD, b: DD) -> bool:
    return a[0] < b[0] or (a[0] == b[0] and a[1] < b[1])


@inlined
def is_between_ends(line: Line, t: DD) -> bool:
    """Whether the point at t is between the planes of the two ends."""
    s = dd_add(line.s0, dd_multiply(line.s1, t))
    above = dd_subtract(s, line.top)
    return s[0] >= 0.0 and above[0] <= 0.0


@compiled
def inside(line: Line) -> Crossings:
    """The part of the ray inside the closed cone; `enter` comes after `leave` where there is none.

    Where A < 0 the ray is steeper than the side: it is inside the double cone before the lower root and after the
    higher one, and one of both is in the half of the cone.
    """
    noinline()
    low, high, a, crosses = side_roots(line)
    enter, leave = ALWAYS, NEVER
    if a > 0.0 or (a == 0.0 and crosses):
        enter, leave = (low, high) if crosses else (NEVER, ALWAYS)
    elif crosses:
        if line.p1[0] > 0.0:
            enter = high
        else:
            leave = low
    elif a == 0.0:  # it runs along the axis of a cylinder
        _, _, off = coefficients(line)
        if off[0] > 0.0:
            return Crossings(NEVER, ALWAYS, SIDE, SIDE)
    enter_face = leave_face = SIDE
    if line.s1[0] == 0.0:
        if line.s0[0] < 0.0 or dd_subtract(line.s0, line.top)[0] > 0.0:
            return Crossings(NEVER, ALWAYS, SIDE, SIDE)
        return Crossings(enter, leave, SIDE, SIDE)
    narrow = dd_quotient((-line.s0[0], -line.s0[1]), line.s1)
    wide = dd_quotient(dd_subtract(line.top, line.s0), line.s1)
    upwards = line.s1[0] > 0.0
    first, last = (narrow, wide) if upwards else (wide, narrow)
    if precedes(enter, first):
        enter, enter_face = first, NARROW if upwards else WIDE
    if precedes(last, leave):
        leave, leave_face = last, WIDE if upwards else NARROW
    return Crossings(enter, leave, enter_face, leave_face)


@compiled
def height_above_side(surface: SurfaceRow, ray: Ray, t: float) -> float:
    """The distance of the ray's point at t from the side, along the normal there: outside positive.

    (|F|^2 - P^2) / (|F| + P) is the distance across the axis times L2; times the cosine of the side's angle it is that
    along the normal.
    """
    noinline()
    line = line_of(surface, ray)
    p = dd_add(line.p0, dd_multiply(line.p1, (t, 0.0)))
    f = line.f0
    g = dd_scale((t, 0.0), line.f1)
    f = (dd_add(f[0], g[0]), dd_add(f[1], g[1]), dd_add(f[2], g[2]))
    off = dd_subtract(dd_dot(f, f), dd_multiply(p, p))
    across = math.sqrt(max(f[0][0] * f[0][0] + f[1][0] * f[1][0] + f[2][0] * f[2][0], 0.0))
    both = (across + abs(p[0])) * line.square[0]
    return surface.c[0] * off[0] / both if both > 0.0 else 0.0

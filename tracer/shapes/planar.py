"""What plane, polygon, triangle and disc share. Packed as a = a point of it, normal + low, r = its |x| + |y| + |z|.

t = n.(a - o) / n.d. Where a ray starts closer to the plane than rounding can tell, the sign of that t says nothing,
and no threshold would: at the corner of a room the next wall must be hit at once, at the edge of a cube it must not.
The answer is in the corners: a ray that leaves face A lies on that side of face B on which A lies.
"""

import math
from itertools import pairwise
from typing import Any

import numpy as np

from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import (
    DDVector,
    U,
    dd_add,
    dd_cross,
    dd_divide,
    dd_dot,
    dd_vector,
    exact_difference,
    two_product,
)
from tracer.formulas.vector import Vector, add, as_floats, dot, scale, subtract, vector
from tracer.rays import Ray

# Rounding errors of n.(a - o): three products, three differences and two sums, and as many again in the point of the
# surface the ray leaves; each at most 2^-53 of |a| + |o| in the 1-norm.
PLANE_ERROR = 16 * U

FAR_ANCHOR = 4.0  # times the way to the hit: where the plane's own point lies farther, it is the one with fewer digits

SPHERE_COUNT = 1  # the number of corners of a sphere


@inlined
def corner(world: Any, surface: Any, k: int) -> Vector:
    """The k-th corner of a face with `surface.count` corners (none: the face is a whole plane)."""
    if surface.first >= 0:
        return vector(world.corners[surface.first + k])
    if k == 0:
        return vector(surface.a)
    if k == 1:
        return vector(surface.b)
    return vector(surface.c)


@compiled
def side_of(world: Any, face: Any, plane: Any) -> int:
    """On which side of the plane all of a face lies: +1, -1, 0 in it, 2 on both. A ball is a corner with a radius."""
    above = below = False
    normal, a = vector(plane.normal), vector(plane.a)
    radius = face.r if face.count == SPHERE_COUNT else 0.0
    for k in range(face.count):
        p = corner(world, face, k)
        height = dot(normal, subtract(p, a))
        error = PLANE_ERROR * (plane.r + radius + abs(p[0]) + abs(p[1]) + abs(p[2]))
        above = above or height + radius > error
        below = below or height - radius < -error
    if above:
        return 2 if below else 1
    return -1 if below else 0


@inlined
def plane_rounding(surface: Any, ray: Ray) -> float:
    """How far from the plane of a face a ray's start may be computed that lies in it."""
    return PLANE_ERROR * (surface.r + ray.reach)


@inlined
def height_and_speed(surface: Any, ray: Ray) -> tuple[float, float]:
    """n.(a - o) and n.d; their ratio is the distance to the plane."""
    normal = vector(surface.normal)
    return (dot(normal, subtract(vector(surface.a), ray.origin)), dot(normal, ray.direction))


@inlined
def may_cross(surface: Any, ray: Ray, ceiling: float) -> bool:
    """Whether the ray may cross the plane no farther than the ceiling: most planes lie behind or too far, and that is
    seen without dividing. Nothing is dropped that rounding could have put there."""
    height, speed = height_and_speed(surface, ray)
    error = plane_rounding(surface, ray)
    behind = (height > 0.0) != (speed > 0.0) and abs(height) > error and abs(speed) > PLANE_ERROR
    return not behind and abs(height) - error <= (abs(speed) + PLANE_ERROR) * ceiling


@inlined
def outline_slack(surface: Any, ray: Ray) -> float:
    """How far outside of a face's outline rounding may have put a point on the edge of this face and the one the ray
    starts on; 0 where it starts elsewhere."""
    height, _ = height_and_speed(surface, ray)
    error = plane_rounding(surface, ray)
    return 2.0 * error if ray.start >= 0 and abs(height) <= error else 0.0


@inlined
def plane_distance(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    """t > 0 to the plane of the face, 0 where the ray starts on it and crosses it; infinite where not within limits."""
    height, speed = height_and_speed(surface, ray)
    error = plane_rounding(surface, ray)
    if ray.start >= 0 and abs(height) <= error:
        t = contact_distance(world, surface, ray, speed)
    elif is_aligned(surface) or (
        not exactly
        and (abs(speed) + PLANE_ERROR) * floor + error < abs(height) < (abs(speed) - PLANE_ERROR) * ceiling - error
    ):
        t = height / speed
    else:
        t = exact_distance(surface, ray)
    return t if floor <= t <= ceiling and 0.0 <= t < math.inf else math.inf


@inlined
def is_aligned(surface: Any) -> bool:
    """Whether the normal is along an axis: then n.(a - o) is one difference and n.d one number."""
    x, y, z = surface.normal[0] == 0.0, surface.normal[1] == 0.0, surface.normal[2] == 0.0
    return (x and y) or (y and z) or (z and x)


@inlined
def exact_normal(surface: Any) -> DDVector:
    n, low = surface.normal, surface.low
    return ((n[0], low[0]), (n[1], low[1]), (n[2], low[2]))


@compiled
def exact_distance(surface: Any, ray: Ray) -> float:
    """n.(a - o) / n.d in pairs, so that neither a grazing ray nor a far point of the plane costs digits."""
    normal = exact_normal(surface)
    height = dd_dot(normal, exact_difference(vector(surface.a), ray.origin))
    speed = dd_dot(normal, dd_vector(ray.direction))
    return dd_divide(height, speed) if speed[0] != 0.0 else math.inf


@compiled
def contact_distance(world: Any, surface: Any, ray: Ray, speed: float) -> float:
    """`plane_distance` for a ray whose start cannot be told from a point of the plane."""
    noinline()
    if speed == 0.0:
        return math.inf
    start = world.surfaces[ray.start]
    t = exact_distance(surface, ray)
    side = side_of(world, start, surface) if start.count > 0 else 2
    if side == 2:  # it has no corners, or the plane cuts it: nothing better to go by than t itself
        return t if t > 0.0 else math.inf
    if side == 0 or side * speed > 0.0:
        return math.inf
    if surface.count >= 3:
        heading = 1 if dot(vector(start.normal), ray.direction) > 0.0 else -1
        beyond = side_of(world, surface, start) if start.count >= 3 else 2
        if beyond != 2 and beyond != heading:
            return math.inf
    return max(t, 0.0)


@inlined
def is_near_edge(ax: float, ay: float, bx: float, by: float, slack: float) -> bool:
    """Whether the edge from a to b passes the ray, at (0, 0), no farther than `slack`."""
    ex, ey = bx - ax, by - ay
    size = math.sqrt(ex * ex + ey * ey)
    along = -(ax * ex + ay * ey)
    return abs(ax * by - ay * bx) <= slack * size and -slack * size <= along <= size * (size + slack)


@inlined
def interaction(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit moved into the plane, so that rounding does not lift it off."""
    n = vector(surface.normal)
    p = add(ray.origin, scale(t, ray.direction))
    if surface.r > FAR_ANCHOR * (ray.reach + t) and not is_aligned(surface):
        height = exact_height(surface, p)
    else:
        height = dot(n, subtract(p, vector(surface.a)))
    return (subtract(p, scale(height, n)), n, n)


@compiled
def exact_height(surface: Any, p: Vector) -> float:
    """n.(p - a) in pairs, for an `a` so far from the hit that it has fewer digits."""
    noinline()
    return dd_dot(exact_normal(surface), exact_difference(p, vector(surface.a)))[0]


@inlined
def no_next_hit(world: Any, surface: Any, ray: Ray) -> float:
    """A flat surface is not met again by a ray that leaves it."""
    return math.inf


def newell_normal(corners: np.ndarray) -> DDVector:
    """A normal, of any length, of a closed line of corners (n, 3), seen counter-clockwise from its tip; 0 for no area.

    Sum of the cross products of neighbouring corners about the first (M. Newell's rule; Sutherland, Sproull &
    Schumacker, Computing Surveys 6(1), 1974), in pairs.
    """
    arms = [exact_difference(as_floats(corner), as_floats(corners[0])) for corner in corners[1:]]
    area = dd_vector((0.0, 0.0, 0.0))
    for before, after in pairwise(arms):
        x, y, z = dd_cross(before, after)
        area = (dd_add(area[0], x), dd_add(area[1], y), dd_add(area[2], z))
    return area


@inlined
def constant_normal(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
    """The normal of a flat face is the same everywhere."""
    return (0.0, 0.0, 0.0)


def unit_normal(corners: np.ndarray) -> np.ndarray:
    """`newell` with length 1; 0 for no area."""
    area = np.array([high for high, _ in newell_normal(corners)])
    return area / (math.hypot(*area) or 1.0)


def pack_normal(rows: Any, area: DDVector) -> None:
    """Fill in `normal` and `low` from normals of any length above 0, numbers or arrays."""
    _, exponent = np.frexp(np.max(np.abs([high for high, _ in area]), axis=0))  # so that no square vanishes
    tamed = [(np.ldexp(high, -exponent), np.ldexp(low, -exponent)) for high, low in area]
    size = np.sqrt(sum(high * high for high, _ in tamed))
    for k, (high, low) in enumerate(tamed):
        rows["normal"][..., k] = n = high / size
        product, error = two_product(n, size)
        rows["low"][..., k] = ((high - product) - error + low) / size

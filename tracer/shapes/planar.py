"""Functions that plane, polygon, triangle and disc share.

Packed as a = a point of the plane, normal + normal_low = its unit normal, r = |a.x| + |a.y| + |a.z|.

t = n.(a - o) / n.d. Where a ray starts nearer to the plane than rounding can tell, the sign of this t means nothing,
and no threshold could replace it: in the corner of a room the next wall must be hit at once, at the edge of a cube
it must not. The corners decide: a ray that leaves face A starts on that side of face B on which A lies. Where A
lies on both sides, the way by which the ray has come decides: it has not crossed B yet.
"""

import math
from itertools import pairwise

import numpy as np

from tracer.compile.intrinsics import noinline, vector_at
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
from tracer.formulas.vector import Vector, add, as_floats, dot, rescale, scale, subtract, vector
from tracer.rays import APPROACH, BEFORE, Ray
from tracer.shapes.outline import (
    IN_PLANE,
    ON_BOTH_SIDES,
    PLANE_ERROR,
    into_outline,
    is_in_outline,
    side_of,
)
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow

# A face is seen edge-on where |n.d| is below this: the ray's distance to its edges then has less than 12 digits.
EDGE_ON = 2.0**-40

# At a slant, |n.d| below this, the distance of a ray from the edges of a face, with its rounding error, is a longer way
# on the face: a hit may lie outside.
OBLIQUE = 0.125

# The distance, in rounding errors, within which a ray in a corner meets the corner's faces, at a slant of 1 : CLOSE or
# more.
CLOSE = 2.0**16

# Rounding error of a hit point in units of `tracer.kernel.node_rows.rounding_scale`, divided by |n.d|.
HIT = 2.0

FAR_ANCHOR = 4.0  # times the distance to the hit: where the plane's point is farther, it has fewer digits than the hit


@inlined
def plane_rounding(surface: SurfaceRow, ray: Ray) -> float:
    """Bound on the computed distance between the plane and the start of a ray that starts in it."""
    return PLANE_ERROR * (surface.r + ray.magnitude)


@inlined
def height_and_n_dot_d(surface: SurfaceRow, ray: Ray) -> tuple[float, float]:
    """n.(a - o) and n.d. Their ratio is the distance to the plane."""
    normal = vector(surface.normal)
    return (dot(normal, subtract(vector(surface.a), ray.origin)), dot(normal, ray.direction))


@inlined
def may_cross(surface: SurfaceRow, ray: Ray, t_max: float) -> bool:
    """Whether the ray may cross the plane at a distance of at most t_max.

    Decides without a division, since most planes lie behind the ray or too far away. Never false because of rounding.
    """
    height, n_dot_d = height_and_n_dot_d(surface, ray)
    error = plane_rounding(surface, ray)
    behind = (height > 0.0) != (n_dot_d > 0.0) and abs(height) > error and abs(n_dot_d) > PLANE_ERROR
    return not behind and abs(height) - error <= (abs(n_dot_d) + PLANE_ERROR) * t_max


@inlined
def outline_slack(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """Bound on the distance by which rounding may put the crossing of a ray that leaves a neighbouring face outside the
    face.

    Such a ray crosses the plane where it starts, or so near the plane of the face that it leaves that rounding cannot
    tell. In a corner the neighbour may be a face that it has met before. So the slack also holds where the ray crosses
    the plane close to its start. It is 0 for other rays.
    """
    if ray.start < 0:
        return 0.0
    height, n_dot_d = height_and_n_dot_d(surface, ray)
    error = plane_rounding(surface, ray)
    if abs(height) <= max(error, CLOSE * error * abs(n_dot_d)):
        return 2.0 * error
    start = world.surfaces[ray.start]
    climb = dot(vector(start.normal), ray.direction)
    return 2.0 * error if start.count >= 3 and abs(climb * height) <= error * abs(n_dot_d) else 0.0


@inlined
def plane_distance(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """Distance t > 0 to the plane, 0 if the ray starts on it and crosses it; inf if not between t_min and t_max."""
    height, n_dot_d = height_and_n_dot_d(surface, ray)
    error = plane_rounding(surface, ray)
    if ray.start >= 0 and abs(height) <= error:
        t = contact_distance(world, surface, ray, n_dot_d)
    elif abs(n_dot_d) < EDGE_ON and surface.count >= 3:
        t = edge_on_distance(world, surface, ray)
    elif is_axis_aligned(surface) or (
        not exact
        and (abs(n_dot_d) + PLANE_ERROR) * t_min + error < abs(height) < (abs(n_dot_d) - PLANE_ERROR) * t_max - error
    ):
        t = height / n_dot_d
    else:
        t = exact_distance(surface, ray.origin, ray.direction)
    return t if t_min <= t <= t_max and 0.0 <= t < math.inf else math.inf


@inlined
def is_axis_aligned(surface: SurfaceRow) -> bool:
    """Whether the normal is parallel to an axis. Then n.(a - o) is one difference and n.d one number."""
    x, y, z = surface.normal[0] == 0.0, surface.normal[1] == 0.0, surface.normal[2] == 0.0
    return (x and y) or (y and z) or (z and x)


@inlined
def dd_normal(surface: SurfaceRow) -> DDVector:
    """The normal in double-double."""
    n, low = surface.normal, surface.normal_low
    return ((n[0], low[0]), (n[1], low[1]), (n[2], low[2]))


@compiled
def exact_distance(surface: SurfaceRow, origin: Vector, direction: Vector) -> float:
    """n.(a - o) / n.d in double-double: accurate for grazing rays and for far points of the plane."""
    normal = dd_normal(surface)
    height = dd_dot(normal, exact_difference(vector(surface.a), origin))
    n_dot_d = dd_dot(normal, dd_vector(direction))
    return dd_divide(height, n_dot_d) if n_dot_d[0] != 0.0 else math.inf


@compiled
def edge_on_distance(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """`exact_distance` to a face that the ray sees edge-on; inf if the hit is outside the face by more than its error.

    Seen so, the outline is a line, and rounding decides whether the ray is inside. Here the hit itself is compared
    with the outline.
    """
    noinline()
    t = exact_distance(surface, ray.origin, ray.direction)
    if not 0.0 <= t < math.inf:
        return math.inf
    o = ray.origin
    size = max(ray.magnitude, abs(o[0]) + abs(o[1]) + abs(o[2]) + t)
    slack = HIT * U * size / abs(dot(vector(surface.normal), ray.direction))
    return t if is_in_outline(world, surface, add(o, scale(t, ray.direction)), slack) else math.inf


@compiled
def contact_distance(world: ShapeArrays, surface: SurfaceRow, ray: Ray, n_dot_d: float) -> float:
    """`plane_distance` for a ray whose start cannot be told from a point of the plane."""
    noinline()
    if n_dot_d == 0.0:
        return math.inf
    start = world.surfaces[ray.start]
    t = exact_distance(surface, ray.origin, ray.direction)
    if ray.settles and surface.solid >= 0 and surface.solid != start.solid:
        return max(t, 0.0) + 0.0  # whether it crosses the face or turns back, the set of solids is put right
    side = side_of(world, start, surface) if start.count > 0 else ON_BOTH_SIDES
    if side == ON_BOTH_SIDES:  # it has no corners, or crosses the plane
        error = plane_rounding(surface, ray)
        came = dot(vector(surface.normal), vector_at(ray.history, APPROACH))
        if abs(came) <= error:
            came = dot(vector(surface.normal), vector_at(ray.history, BEFORE))
        if abs(came) <= error:
            return t if t > 0.0 else math.inf
        if (came > 0.0) != (n_dot_d > 0.0):  # the ray has turned back from the plane
            return math.inf
    elif side == IN_PLANE or side * n_dot_d > 0.0:
        return math.inf
    if surface.count >= 3:
        heading = 1 if dot(vector(start.normal), ray.direction) > 0.0 else -1
        beyond = side_of(world, surface, start) if start.count >= 3 else ON_BOTH_SIDES
        if beyond != ON_BOTH_SIDES and beyond != heading:
            return math.inf
    return max(t, 0.0) + 0.0  # not -0


@inlined
def plane_interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit point, projected into the plane so that rounding does not lift it off, and the normal twice."""
    n = vector(surface.normal)
    p = add(ray.origin, scale(t, ray.direction))
    if surface.r > FAR_ANCHOR * (ray.magnitude + t) and not is_axis_aligned(surface):
        height = exact_height(surface, p)
    else:
        height = dot(n, subtract(p, vector(surface.a)))
    p = subtract(p, scale(height, n))
    if surface.count >= 3 and abs(dot(n, ray.direction)) < OBLIQUE:
        p = into_outline(world, surface, p)
    return (p, n, n)


@inlined
def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The `plane_interaction` of the world's formulas."""
    return world.formulas.plane_interaction(world, surface, ray, t)


@compiled
def exact_height(surface: SurfaceRow, p: Vector) -> float:
    """n.(p - a) in double-double, for an `a` so far from the hit that it has fewer digits."""
    noinline()
    return dd_dot(dd_normal(surface), exact_difference(p, vector(surface.a)))[0]


@inlined
def no_next_hit(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """Infinite: a ray that leaves a flat surface never meets it again."""
    return math.inf


@inlined
def constant_normal(world: ShapeArrays, surface: SurfaceRow, p: Vector, v: Vector) -> Vector:
    """No change: a flat face has the same normal everywhere."""
    return (0.0, 0.0, 0.0)


def newell_normal(corners: np.ndarray) -> DDVector:
    """A normal, of any length, of a closed outline (n, 3), counter-clockwise seen from its tip; 0 for no area.

    The sum of the cross products of neighbouring corners about the first one (M. Newell's rule; Sutherland, Sproull &
    Schumacker, Computing Surveys 6(1), 1974), in double-double.
    """
    arms = [exact_difference(as_floats(corner), as_floats(corners[0])) for corner in corners[1:]]
    area = dd_vector((0.0, 0.0, 0.0))
    for before, after in pairwise(arms):
        x, y, z = dd_cross(before, after)
        area = (dd_add(area[0], x), dd_add(area[1], y), dd_add(area[2], z))
    return area


def unit_normal(corners: np.ndarray) -> np.ndarray:
    """`newell_normal` with length 1; 0 for no area."""
    area = np.array([high for high, _ in newell_normal(corners)])
    return area / (math.hypot(*area) or 1.0)


def pack_normal(rows: np.ndarray, area: DDVector) -> None:
    """Fill in `normal` and `normal_low` from normals of any length above 0. The components may be arrays."""
    _, exponent = np.frexp(np.max(np.abs([high for high, _ in area]), axis=0))  # no square may underflow
    scaled = [(np.ldexp(high, -exponent), np.ldexp(low, -exponent)) for high, low in area]
    size = np.sqrt(sum(high * high for high, _ in scaled))
    for k, (high, low) in enumerate(scaled):
        rows["normal"][..., k] = n = high / size
        product, error = two_product(n, size)
        rows["normal_low"][..., k] = ((high - product) - error + low) / size


def heights(points: np.ndarray, point: Vector, normal: Vector) -> np.ndarray:
    """The heights of points (n, 3) above a plane, in units of the length of its normal."""
    return (points - point) @ np.array(rescale(normal))


def may_lie_in_plane(points: np.ndarray, point: Vector, normal: Vector) -> np.ndarray:
    """Whether rounding can tell each point (n, 3) from the points of a plane."""
    error = PLANE_ERROR * (np.abs(points).sum(axis=1) + np.abs(point).sum())
    return np.abs(heights(points, point, normal)) <= 4.0 * error

"""Functions that plane, polygon, triangle and disc share.

Packed as a = a point of the plane, normal + normal_low = its unit normal, r = |a.x| + |a.y| + |a.z|.

t = n.(a - o) / n.d. Where a ray starts nearer to the plane than rounding can tell, the sign of this t means nothing,
and no threshold could replace it: in the corner of a room the next wall must be hit at once, at the edge of a cube
it must not. The corners decide: a ray that leaves face A starts on that side of face B on which A lies.
"""

import math
from itertools import pairwise

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
from tracer.formulas.vector import Vector, add, as_floats, dot, rescale, scale, subtract, vector
from tracer.rays import Ray
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow

# Bound on the rounding error of n.(a - o), relative to |a| + |o| in the 1-norm: three products, three differences and
# two sums, and as many again in the point of the surface that the ray leaves; each at most 2^-53.
PLANE_ERROR = 16 * U

# A ray whose direction has no larger component along a normal may have been in the plane all its way, up to rounding.
LEVEL = 16.0 * PLANE_ERROR

# A face is seen edge-on where |n.d| is below this: the ray's distance to its edges then has less than 12 digits.
EDGE_ON = 2.0**-40

# At a slant, |n.d| below this, the distance of a ray from the edges of a face, with its rounding error, is a longer way
# on the face: a hit may lie outside.
OBLIQUE = 0.125

# Rounding error of a hit point in units of `tracer.kernel.node_rows.rounding_scale`, divided by |n.d|.
HIT = 2.0

FAR_ANCHOR = 4.0  # times the distance to the hit: where the plane's point is farther, it has fewer digits than the hit

SPHERE_COUNT = 1  # `count` of a sphere, which is a corner with a radius

IN_PLANE, ON_BOTH_SIDES = 0, 2  # besides +1 and -1: where a face lies relative to a plane


@inlined
def corner(world: ShapeArrays, surface: SurfaceRow, k: int) -> Vector:
    """Corner k of a face with `surface.count` corners. A plane has none."""
    if surface.first >= 0:
        return vector(world.corners[surface.first + k])
    if k == 0:
        return vector(surface.a)
    if k == 1:
        return vector(surface.b)
    return vector(surface.c)


@compiled
def side_of(world: ShapeArrays, face: SurfaceRow, plane: SurfaceRow) -> int:
    """The side of the plane on which all of a face or sphere lies: +1, -1, IN_PLANE or ON_BOTH_SIDES."""
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
        return ON_BOTH_SIDES if below else 1
    return -1 if below else IN_PLANE


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
    tell. The slack is 0 for other rays.
    """
    if ray.start < 0:
        return 0.0
    height, n_dot_d = height_and_n_dot_d(surface, ray)
    error = plane_rounding(surface, ray)
    if abs(height) <= error:
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
        t = exact_distance(surface, ray)
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
def exact_distance(surface: SurfaceRow, ray: Ray) -> float:
    """n.(a - o) / n.d in double-double: accurate for grazing rays and for far points of the plane."""
    normal = dd_normal(surface)
    height = dd_dot(normal, exact_difference(vector(surface.a), ray.origin))
    n_dot_d = dd_dot(normal, dd_vector(ray.direction))
    return dd_divide(height, n_dot_d) if n_dot_d[0] != 0.0 else math.inf


@compiled
def edge_on_distance(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """`exact_distance` to a face that the ray sees edge-on; inf if the hit is outside the face by more than its error.

    Seen so, the outline is a line, and rounding decides whether the ray is inside. Here the hit itself is compared
    with the outline, along the axis closest to the normal.
    """
    noinline()
    t = exact_distance(surface, ray)
    if not 0.0 <= t < math.inf:
        return math.inf
    p = add(ray.origin, scale(t, ray.direction))
    o, n = ray.origin, vector(surface.normal)
    size = max(ray.magnitude, abs(o[0]) + abs(o[1]) + abs(o[2]) + t)
    slack = HIT * U * size / abs(dot(n, ray.direction))
    i, j = axes_across(n)
    inside = False
    last = subtract(corner(world, surface, surface.count - 1), p)
    ax, ay = last[i], last[j]
    for k in range(surface.count):
        here = subtract(corner(world, surface, k), p)
        bx, by = here[i], here[j]
        if is_near_edge(ax, ay, bx, by, slack):
            return t
        if (ay > 0.0) != (by > 0.0) and (ax * by - bx * ay > 0.0) == (by > ay):
            inside = not inside
        ax, ay = bx, by
    return t if inside else math.inf


@compiled
def contact_distance(world: ShapeArrays, surface: SurfaceRow, ray: Ray, n_dot_d: float) -> float:
    """`plane_distance` for a ray whose start cannot be told from a point of the plane."""
    noinline()
    if n_dot_d == 0.0:
        return math.inf
    start = world.surfaces[ray.start]
    t = exact_distance(surface, ray)
    if ray.settles and surface.solid >= 0 and surface.solid != start.solid:
        return max(t, 0.0) + 0.0  # whether it crosses the face or turns back, the set of solids is put right
    side = side_of(world, start, surface) if start.count > 0 else ON_BOTH_SIDES
    if side == ON_BOTH_SIDES:  # it has no corners, or crosses the plane
        came = dot(vector(surface.normal), ray.approach)
        if abs(came) <= LEVEL:
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
def is_near_edge(ax: float, ay: float, bx: float, by: float, slack: float) -> bool:
    """Whether the edge from a to b passes the ray, which is at (0, 0), no farther than `slack`."""
    ex, ey = bx - ax, by - ay
    size = math.sqrt(ex * ex + ey * ey)
    along = -(ax * ex + ay * ey)
    return abs(ax * by - ay * bx) <= slack * size and -slack * size <= along <= size * (size + slack)


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


@compiled
def into_outline(world: ShapeArrays, surface: SurfaceRow, p: Vector) -> Vector:
    """A point in the plane of a face, moved to the nearest point of its outline if it is outside."""
    noinline()
    nearest, least = p, math.inf
    inside = False
    i, j = axes_across(vector(surface.normal))
    a = corner(world, surface, surface.count - 1)
    for k in range(surface.count):
        b = corner(world, surface, k)
        from_a, edge = subtract(p, a), subtract(b, a)
        if (a[j] > p[j]) != (b[j] > p[j]) and (from_a[j] * edge[i] - from_a[i] * edge[j] > 0.0) == (edge[j] > 0.0):
            inside = not inside
        # From the nearer end, since the foot has the rounding error of the way to it.
        share, other = dot(from_a, edge) / dot(edge, edge), dot(subtract(b, p), edge) / dot(edge, edge)
        foot = add(a, scale(max(share, 0.0), edge)) if share < other else subtract(b, scale(max(other, 0.0), edge))
        away = subtract(p, foot)
        if dot(away, away) < least:
            nearest, least = foot, dot(away, away)
        a = b
    return p if inside else nearest


@inlined
def axes_across(n: Vector) -> tuple[int, int]:
    """The two axes that are farthest from a normal."""
    x, y, z = abs(n[0]), abs(n[1]), abs(n[2])
    return (1, 2) if x >= y and x >= z else ((2, 0) if y >= z else (0, 1))


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
    error = 2.0 * PLANE_ERROR * (np.abs(points).sum(axis=1) + np.abs(point).sum())
    return np.abs(heights(points, point, normal)) <= 2.0 * error

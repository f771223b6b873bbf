"""Outlines of flat faces: their corners, their side of a plane, and whether a point of their plane is inside."""

import math

from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, add, dot, scale, subtract, vector
from tracer.rays import Ray, sheared
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow

# Bound on the rounding error of n.(a - o), relative to |a| + |o| in the 1-norm: three products, three differences and
# two sums, and as many again in the point of the surface that the ray leaves; each at most 2^-53.
PLANE_ERROR = 16 * U

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
    """The side of the plane on which all of a face or sphere lies: +1, -1, IN_PLANE or ON_BOTH_SIDES.

    The corners of the plane's own face are rounded too, so it is known only to the error of the farthest one.
    """
    above = below = False
    reach = plane.r
    for k in range(plane.count):
        p = corner(world, plane, k)
        reach = max(reach, abs(p[0]) + abs(p[1]) + abs(p[2]))
    normal, a = vector(plane.normal), vector(plane.a)
    radius = face.r if face.count == SPHERE_COUNT else 0.0
    for k in range(face.count):
        p = corner(world, face, k)
        height = dot(normal, subtract(p, a))
        error = PLANE_ERROR * (reach + radius + abs(p[0]) + abs(p[1]) + abs(p[2]))
        above = above or height + radius > error
        below = below or height - radius < -error
    if above:
        return ON_BOTH_SIDES if below else 1
    return -1 if below else IN_PLANE


@inlined
def is_near_edge(ax: float, ay: float, bx: float, by: float, slack: float) -> bool:
    """Whether the edge from a to b passes the ray, which is at (0, 0), no farther than `slack`."""
    ex, ey = bx - ax, by - ay
    size = math.sqrt(ex * ex + ey * ey)
    along = -(ax * ex + ay * ey)
    return abs(ax * by - ay * bx) <= slack * size and -slack * size <= along <= size * (size + slack)


@compiled
def is_beside_outline(world: ShapeArrays, surface: SurfaceRow, ray: Ray, slack: float) -> bool:
    """Whether the ray passes an edge of a face no farther than `slack`."""
    noinline()
    beside = False
    ax, ay = sheared(ray, corner(world, surface, surface.count - 1))
    for k in range(surface.count):
        bx, by = sheared(ray, corner(world, surface, k))
        beside = beside or is_near_edge(ax, ay, bx, by, slack)
        ax, ay = bx, by
    return beside


@compiled
def is_in_outline(world: ShapeArrays, surface: SurfaceRow, p: Vector, slack: float) -> bool:
    """Whether a point in the plane of a face is inside, or no farther outside than `slack`. Seen along the axis that is
    closest to the normal.
    """
    i, j = axes_across(vector(surface.normal))
    inside = False
    last = subtract(corner(world, surface, surface.count - 1), p)
    ax, ay = last[i], last[j]
    for k in range(surface.count):
        here = subtract(corner(world, surface, k), p)
        bx, by = here[i], here[j]
        if is_near_edge(ax, ay, bx, by, slack):
            return True
        if (ay > 0.0) != (by > 0.0) and (ax * by - bx * ay > 0.0) == (by > ay):
            inside = not inside
        ax, ay = bx, by
    return inside


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

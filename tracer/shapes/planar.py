"""What plane, polygon, triangle and disc share. Packed as a = a point of it, normal, r = |x| + |y| + |z| of that point.

t = n.(a - o) / n.d. Where a ray starts closer to the plane than rounding can tell, the sign of that t says nothing,
and no threshold would: at the corner of a room the next wall must be hit at once, at the edge of a cube it must not.
The answer is in the corners: a ray that leaves face A lies on that side of face B on which A lies.
"""

import math
from typing import Any

import numpy as np

from tracer.jit import compiled, routine, stay_apart
from tracer.rays import Ray
from tracer.vector import Vector, add, dot, scale, subtract, vector

# Rounding errors of n.(a - o): three products, three differences and two sums, and as many again in the point of the
# surface the ray leaves; each at most 2^-53 of |a| + |o| in the 1-norm.
NEAR = 16 * 2.0**-53


LOOSE = 1.0 + 2.0**-50


@compiled
def corner(world: Any, surface: Any, k: int) -> Vector:
    """The k-th corner of a face with `surface.count` corners (none: the face is a whole plane)."""
    if surface.first >= 0:
        return vector(world.corners[surface.first + k])
    if k == 0:
        return vector(surface.a)
    if k == 1:
        return vector(surface.b)
    return vector(surface.c)


@routine
def side_of(world: Any, face: Any, plane: Any) -> int:
    """On which side of the plane all of a face lies: +1, -1, 0 in it, 2 on both."""
    above = below = False
    normal, a = vector(plane.normal), vector(plane.a)
    for k in range(face.count):
        p = corner(world, face, k)
        height = dot(normal, subtract(p, a))
        error = NEAR * (plane.r + abs(p[0]) + abs(p[1]) + abs(p[2]))
        above = above or height > error
        below = below or height < -error
    if above:
        return 2 if below else 1
    return -1 if below else 0


@compiled
def plane_distance(world: Any, surface: Any, ray: Ray, ceiling: float) -> tuple[float, float]:
    """(t, slack): t > 0 to the plane of the face, 0 where the ray starts on it and crosses it, else infinite.

    The slack is 0, but where the ray starts on the plane: there it is how far outside of the face's outline rounding
    may have put a point that lies on the edge of both faces.
    """
    normal = vector(surface.normal)
    height = dot(normal, subtract(vector(surface.a), ray.origin))
    speed = dot(normal, ray.direction)
    error = NEAR * (surface.r + ray.reach)
    if ray.start >= 0 and abs(height) <= error and speed != 0.0:
        return (touching_distance(world, surface, ray, height / speed, speed), 2.0 * error)
    # Most planes lie behind or too far: that is seen without dividing. Nothing is dropped that would round to the
    # ceiling.
    if (height > 0.0) != (speed > 0.0) or abs(height) > abs(speed) * (ceiling * LOOSE):
        return (math.inf, 0.0)
    if height == 0.0 or speed == 0.0:
        return (math.inf, 0.0)
    return (height / speed, 0.0)


@routine
def touching_distance(world: Any, surface: Any, ray: Ray, t: float, speed: float) -> float:
    """`plane_distance` for a ray whose start cannot be told from a point of the plane."""
    stay_apart()
    start = world.surfaces[ray.start]
    if start.count < 3:  # not a face with corners: nothing better to go by than t itself
        return t if t > 0.0 else math.inf
    side = side_of(world, start, surface)
    if side == 2:
        return t if t > 0.0 else math.inf
    if side == 0 or side * speed > 0.0:
        return math.inf
    if surface.count >= 3:
        heading = 1 if dot(vector(start.normal), ray.direction) > 0.0 else -1
        beyond = side_of(world, surface, start)
        if beyond != 2 and beyond != heading:
            return math.inf
    return max(t, 0.0)


@compiled
def is_beside(ax: float, ay: float, bx: float, by: float, slack: float) -> bool:
    """Whether the edge from a to b passes the ray, at (0, 0), no farther than `slack`."""
    ex, ey = bx - ax, by - ay
    size = math.sqrt(ex * ex + ey * ey)
    along = -(ax * ex + ay * ey)
    return abs(ax * by - ay * bx) <= slack * size and -slack * size <= along <= size * (size + slack)


@compiled
def locate(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit moved into the plane, so that the rounding of t does not lift it off."""
    n = vector(surface.normal)
    p = add(ray.origin, scale(t, ray.direction))
    height = dot(n, subtract(p, vector(surface.a)))
    return (subtract(p, scale(height, n)), n, n)


@compiled
def never(world: Any, surface: Any, ray: Ray) -> float:
    """A flat surface is not met again by a ray that leaves it."""
    return math.inf


def newell(corners: np.ndarray) -> np.ndarray:
    """Unit normal of a closed line of corners (n, 3), seen counter-clockwise from its tip; zero for no area.

    Sum of the cross products of neighbouring corners about their mean (M. Newell's rule; Sutherland, Sproull &
    Schumacker, Computing Surveys 6(1), 1974).
    """
    arms = corners - corners.mean(axis=0)
    area = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    size = math.hypot(*area)
    return area / size if size > 0.0 else area

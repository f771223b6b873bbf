"""Exact arithmetic with vectors of fractions: whether a point lies on a surface, as its author wrote it.

Every float is a fraction, so no rounding comes in between.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise

Exact = tuple[Fraction, Fraction, Fraction]
ExactPlane = tuple[Exact, Exact]  # a point, and a normal of any length above 0


def exact(values: Iterable[float]) -> Exact:
    x, y, z = map(Fraction, values)
    return (x, y, z)


def minus(a: Exact, b: Exact) -> Exact:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Exact, b: Exact) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Exact, b: Exact) -> Exact:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def area(corners: Sequence[Exact]) -> Exact:
    """Twice the area vector of an outline (Newell's rule). It points to where the corners are counter-clockwise."""
    arms = [minus(corner, corners[0]) for corner in corners]
    total = exact((0, 0, 0))
    for part in (cross(a, b) for a, b in pairwise(arms[1:])):
        total = (total[0] + part[0], total[1] + part[1], total[2] + part[2])
    return total


def plane_of(corners: Sequence[Exact]) -> ExactPlane:
    """The plane of an outline: through its first corner, with the area vector as normal."""
    return corners[0], area(corners)


def are_one_plane(a: ExactPlane, b: ExactPlane) -> bool:
    """Whether two planes are the same, whichever way their normals point."""
    (p, n), (q, m) = a, b
    return not any(cross(n, m)) and dot(n, minus(q, p)) == 0


def is_in_outline(p: Exact, corners: Sequence[Exact]) -> bool:
    """Whether a point lies in a polygon or on its sides. It lies in the plane of the polygon if it lies in that of the
    first corner with the area vector as normal.
    """
    normal = area(corners)
    if dot(normal, minus(p, corners[0])) != 0:
        return False
    drop = max(range(3), key=lambda k: abs(normal[k]))
    u, v = (k for k in range(3) if k != drop)
    flat = [(corner[u] - p[u], corner[v] - p[v]) for corner in corners]
    inside = False
    for (ax, ay), (bx, by) in zip(flat, [*flat[1:], flat[0]], strict=True):
        turn = ax * by - bx * ay
        if turn == 0 and ax * bx <= 0 and ay * by <= 0:
            return True  # on this side
        if (ay > 0) != (by > 0) and (turn > 0) == (by > ay):
            inside = not inside
    return inside

"""The formulas of the textbooks in plain Python, to show the digits that they lose.

Nothing else uses this file. Each function is the usual way: the quadratic by (-b - sqrt(b^2 - 4ac)) / 2a, refraction
by 1 - eta^2 (1 - c1^2), angles by acos, the refracted share as 1 - R, and a smallest distance below which no hit
counts.
"""

import math
from collections.abc import Sequence

import numpy as np

Vector = Sequence[float]

TMIN = 1e-4  # the usual smallest distance, and the usual offset along the normal


def dot(a: Vector, b: Vector) -> float:
    return sum(x * y for x, y in zip(a, b, strict=True))


def unit(a: Vector) -> Vector:
    size = math.sqrt(dot(a, a))
    return [x / size for x in a]


def at(origin: Vector, direction: Vector, t: float) -> Vector:
    return [o + t * d for o, d in zip(origin, direction, strict=True)]


def sphere(origin: Vector, direction: Vector, center: Vector, radius: float, tmin: float = TMIN) -> float:
    """The distance to a sphere; inf for none."""
    f = [o - c for o, c in zip(origin, center, strict=True)]
    a, b, c = dot(direction, direction), 2.0 * dot(f, direction), dot(f, f) - radius * radius
    discriminant = b * b - 4.0 * a * c
    if not discriminant >= 0.0 or a == 0.0:
        return math.inf
    for t in ((-b - math.sqrt(discriminant)) / (2.0 * a), (-b + math.sqrt(discriminant)) / (2.0 * a)):
        if t > tmin:
            return t
    return math.inf


def plane(origin: Vector, direction: Vector, point: Vector, normal: Vector, tmin: float = TMIN) -> float:
    """The distance to a plane; inf for none."""
    n_dot_d = dot(normal, direction)
    if n_dot_d == 0.0:
        return math.inf
    t = dot(normal, [p - o for p, o in zip(point, origin, strict=True)]) / n_dot_d
    return t if t > tmin else math.inf


def triangle(
    origin: Vector, direction: Vector, corners: Sequence[Vector], least: float = 1e-8, tmin: float = TMIN
) -> float:
    """The distance to a triangle by Moeller and Trumbore, with their threshold for the determinant; inf for none."""
    a, b, c = corners
    e1, e2 = [y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, c, strict=True)]
    p = cross(direction, e2)
    determinant = dot(e1, p)
    if abs(determinant) < least or determinant == 0.0:
        return math.inf
    s = [o - x for o, x in zip(origin, a, strict=True)]
    q = cross(s, e1)
    u, v = dot(s, p) / determinant, dot(direction, q) / determinant
    if u < 0.0 or v < 0.0 or u + v > 1.0:
        return math.inf
    t = dot(e2, q) / determinant
    return t if t > tmin else math.inf


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def reflect(v: Vector, n: Vector) -> Vector:
    k = 2.0 * dot(n, v)
    return [x - k * y for x, y in zip(v, n, strict=True)]


def refract(v: Vector, n: Vector, n1: float, n2: float) -> Vector | None:
    """The direction of the refracted ray; None on total internal reflection."""
    eta, c1 = n1 / n2, -dot(n, v)
    root = 1.0 - eta * eta * (1.0 - c1 * c1)
    if root < 0.0:
        return None
    k = eta * c1 - math.sqrt(root)
    return [eta * x + k * y for x, y in zip(v, n, strict=True)]


def fresnel(c1: float, n1: float, n2: float) -> float:
    """R, unpolarised. The refracted share is then taken as 1 - R."""
    root = 1.0 - (n1 / n2) ** 2 * (1.0 - c1 * c1)
    if root < 0.0:
        return 1.0
    c2 = math.sqrt(root)
    rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2)
    rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
    return 0.5 * (rs * rs + rp * rp)


def angle(a: Vector, b: Vector) -> float:
    return math.acos(max(-1.0, min(1.0, dot(a, b))))


def offset(point: Vector, normal: Vector, direction: Vector) -> Vector:
    """A hit moved off its surface, towards the next ray: the other usual way to avoid hitting it again."""
    side = 1.0 if dot(normal, direction) > 0.0 else -1.0
    return [p + side * TMIN * n for p, n in zip(point, normal, strict=True)]


def haines(origin: Vector, direction: Vector, center: Vector, radius: float) -> bool:
    """Whether a ray of unit direction comes within the radius of the centre, without the quadratic's discriminant."""
    f = [o - c for o, c in zip(origin, center, strict=True)]
    b = -dot(f, direction)
    beside = at(f, direction, b)
    return b > 0.0 and radius * radius - dot(beside, beside) >= 0.0


def stable_quadratic(a: float, b: float, c: float) -> tuple[float, float]:
    """Roots of the quadratic by q = -(b + sign(b) sqrt(b^2 - 4ac)) / 2, as q/a and c/q. 0/0 is NaN, as in C."""
    q = -0.5 * (b + math.copysign(math.sqrt(b * b - 4.0 * a * c), b))
    return (q / a, c / q if q != 0.0 else math.nan)


def pole_normal(point: Vector, radius: float) -> Vector:
    """The normal of a ball around the origin with longitudes. On the axis, which has none, x is set to 1e-5 radius."""
    x, y, z = point
    return unit((1e-5 * radius if x == 0.0 and y == 0.0 else x, y, z))


def slab(origin: Vector, direction: Vector, low: Vector, high: Vector) -> tuple[float, float]:
    """The distances at which a ray enters and leaves a box, by 1/d: three slabs at once, as array programs write it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / np.array(direction, float)
        first, second = np.subtract(low, origin) * inverse, np.subtract(high, origin) * inverse
    return (float(np.minimum(first, second).max()), float(np.maximum(first, second).min()))


def mirrors(
    origin: Vector, direction: Vector, sides: Sequence[tuple[Vector, Vector]], bounces: int
) -> tuple[Vector, Vector]:
    """The last hit of a ray between plane mirrors (point, normal), and the direction after it."""
    hit = origin
    for _ in range(bounces):
        t, n, hit = min((t := plane(origin, direction, p, n), n, at(origin, direction, min(t, 1e99))) for p, n in sides)
        direction = reflect(direction, n)
        origin = offset(hit, n, direction)
    return hit, direction


def inside_ball(origin: Vector, direction: Vector, bounces: int, axis: int = -1) -> Vector:
    """The hit after some bounces inside a mirrored unit ball around 0; with an axis, inside the tube along it."""
    hit = origin
    for _ in range(bounces + 1):
        flat_origin, flat = ([0.0 if i == axis else x for i, x in enumerate(a)] for a in (origin, direction))
        t = sphere(flat_origin, flat, (0.0, 0.0, 0.0), 1.0)
        if t == math.inf:
            break
        hit = at(origin, direction, t)
        n = unit([0.0 if i == axis else x for i, x in enumerate(hit)])
        direction = reflect(direction, n)
        origin = offset(hit, n, direction)
    return hit


def to_and_fro(origin: Vector, direction: Vector, centers: Sequence[Vector], count: int) -> list[Vector]:
    """The points on mirrored unit balls that a ray meets in turn."""
    hits: list[Vector] = []
    direction = unit(direction)
    for _ in range(count):
        t, center = min((sphere(origin, direction, center, 1.0), center) for center in centers)
        hits.append(at(origin, direction, t) if t < math.inf else [math.inf] * 3)
        if t == math.inf:
            break
        n = unit([x - c for x, c in zip(hits[-1], center, strict=True)])
        direction = reflect(direction, n)
        origin = offset(hits[-1], n, direction)
    return hits + [[math.inf] * 3] * (count - len(hits))


def drop(origin: Vector, direction: Vector, n: float, inner: int, radius: float = 1.0) -> tuple[Vector, Vector]:
    """The last hit in a ball around 0 after some inner reflections, and the direction out."""
    hit = origin
    for k in range(inner + 2):
        t = sphere(origin, direction, (0.0, 0.0, 0.0), radius)
        if t == math.inf:
            break
        hit = at(origin, direction, t)
        out = unit(hit)
        if k == 0:
            direction = refract(direction, out, 1.0, n) or direction
        elif k <= inner:
            direction = reflect(direction, out)
        else:
            direction = refract(direction, [-x for x in out], n, 1.0) or direction
        origin = offset(hit, out, direction)
    return hit, direction


def layers(origin: Vector, direction: Vector, faces: Sequence[tuple[float, float]]) -> tuple[list[Vector], Vector]:
    """The hits and the last direction of a ray from air down through horizontal faces (height, index below)."""
    hits, n1, below = [], 1.0, list(faces)
    while below:
        found = [(plane(origin, direction, (0.0, y, 0.0), (0.0, 1.0, 0.0)), y, n2) for y, n2 in below]
        t, y, n2 = min(found)
        if t == math.inf:
            break
        below = [face for face in below if face[0] < y]
        hits.append(at(origin, direction, t))
        direction, n1 = refract(direction, (0.0, 1.0, 0.0), n1, n2) or direction, n2
        origin = offset(hits[-1], (0.0, 1.0, 0.0), direction)
    return hits, direction


def panes(origin: Vector, direction: Vector, heights: Sequence[float], n: float) -> tuple[int, Vector | None]:
    """The number of hits and the direction out of a ray through panes of glass, which alternate with air."""
    inside, hits = False, 0
    while True:
        t = min(plane(origin, direction, (0.0, y, 0.0), (0.0, 1.0, 0.0)) for y in heights)
        if t == math.inf:
            return hits, direction
        hit, hits = at(origin, direction, t), hits + 1
        onward = refract(direction, (0.0, 1.0, 0.0), n if inside else 1.0, 1.0 if inside else n)
        if onward is None:
            return hits, None
        origin, direction, inside = hit, onward, not inside

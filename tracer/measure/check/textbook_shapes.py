"""The textbook's formulas for cones, cylinders, discs, and rooms, in plain Python, as in `textbook.py`."""

import math
from collections.abc import Callable, Sequence

from tracer.measure.check.exact_shapes import Tube
from tracer.measure.check.textbook import TMIN, Vector, at, cross, dot, plane, reflect, slab, triangle, unit


def tube(origin: Vector, direction: Vector, shape: Tube, tmin: float = TMIN) -> float:
    """The distance to the side of a cone or cylinder by the quadratic; inf for none."""
    base, base_radius, apex, apex_radius = shape
    axis = [y - x for x, y in zip(base, apex, strict=True)]
    length = math.sqrt(dot(axis, axis))
    axis = [x / length for x in axis]
    slope = (apex_radius - base_radius) / length
    arm = [o - x for o, x in zip(origin, base, strict=True)]
    height, climb = dot(arm, axis), dot(direction, axis)
    f, g = at(arm, axis, -height), at(direction, axis, -climb)
    radius, rise = base_radius + slope * height, slope * climb
    a, b, c = dot(g, g) - rise * rise, 2.0 * (dot(f, g) - rise * radius), dot(f, f) - radius * radius
    discriminant = b * b - 4.0 * a * c
    if not discriminant >= 0.0 or a == 0.0:
        return math.inf
    roots = sorted(((-b - math.sqrt(discriminant)) / (2.0 * a), (-b + math.sqrt(discriminant)) / (2.0 * a)))
    return next((t for t in roots if t > tmin and 0.0 <= height + t * climb <= length), math.inf)


def disc(origin: Vector, direction: Vector, center: Vector, normal: Vector, radius: float, tmin: float = TMIN) -> float:
    """The distance to a disc; inf for none."""
    t = plane(origin, direction, center, normal, tmin)
    if t == math.inf:
        return t
    beside = [x - c for x, c in zip(at(origin, direction, t), center, strict=True)]
    return t if dot(beside, beside) <= radius * radius else math.inf


def placed(vertex: Vector, scale: float, rotate: Vector, move: Vector) -> Vector:
    """A vertex scaled, rotated about x, y and z by angles in degrees, and moved."""
    p = [scale * x for x in vertex]
    for axis, degrees in enumerate(rotate):
        s, c, i, j = math.sin(math.radians(degrees)), math.cos(math.radians(degrees)), (axis + 1) % 3, (axis + 2) % 3
        p[i], p[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
    return [x + y for x, y in zip(p, move, strict=True)]


# A wall of a room: the distance to it along a ray and its normal at a point.
Wall = tuple[Callable[[Vector, Vector], float], Callable[[Vector], Vector]]


def leaves(origin: Vector, direction: Vector, walls: Sequence[Wall], bounces: int, offset: float) -> bool:
    """Whether a ray finds no wall in a mirrored room. Each start is moved off its wall by the offset."""
    for _ in range(bounces + 1):
        t, normal = min(((find(origin, direction), normal) for find, normal in walls), key=lambda found: found[0])
        if t == math.inf:
            return True
        hit = at(origin, direction, t)
        n = normal(hit)
        direction = reflect(direction, n)
        side = offset if dot(n, direction) > 0.0 else -offset
        origin = at(hit, n, side)
    return False


def box_walls(low: Vector, high: Vector, tmin: float) -> list[Wall]:
    """A box from inside, as one wall: the nearest of the three planes ahead, and the normal of the face nearest to the
    hit.
    """

    def find(origin: Vector, direction: Vector) -> float:
        t = slab(origin, direction, low, high)[1]
        return t if t > tmin else math.inf

    def normal(hit: Vector) -> Vector:
        gaps = [min(abs(x - a), abs(b - x)) for x, a, b in zip(hit, low, high, strict=True)]
        return [float(k == gaps.index(min(gaps))) for k in range(3)]

    return [(find, normal)]


def mesh_walls(corners: Sequence[Sequence[Vector]], tmin: float) -> list[Wall]:
    """Triangles by Moeller and Trumbore's test, without its threshold for the determinant."""

    def wall(face: Sequence[Vector]) -> Wall:
        a, b, c = face
        n = unit(cross([y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, c, strict=True)]))
        return (lambda o, d: triangle(o, d, face, 0.0, tmin)), lambda hit: n

    return [wall(face) for face in corners]


def tube_walls(shape: Tube, tmin: float) -> list[Wall]:
    """The side of a cylinder, cone or frustum and its two discs. On the axis the side's normal is 0/0."""
    axis = [y - x for x, y in zip(shape.base, shape.apex, strict=True)]
    slope = (shape.apex_radius - shape.base_radius) / math.sqrt(dot(axis, axis))
    axis = unit(axis)

    def out(hit: Vector) -> Vector:
        arm = [x - y for x, y in zip(hit, shape.base, strict=True)]
        across = at(arm, axis, -dot(arm, axis))
        return unit(at(unit(across), axis, -slope)) if any(across) else [math.nan] * 3

    def end(center: Vector, radius: float) -> Wall:
        return (lambda o, d: disc(o, d, center, axis, radius, tmin)), lambda hit: axis

    side = (lambda o, d: tube(o, d, shape, tmin)), out
    return [side, end(shape.base, shape.base_radius), end(shape.apex, shape.apex_radius)]

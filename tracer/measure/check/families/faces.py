"""Families of flat faces: seen edge-on or nearly so, and hit or miss at the rims of discs."""

import math
from collections.abc import Iterator
from decimal import localcontext

from tracer.formulas.vector import Vector, cross, scale, subtract
from tracer.measure.check import exact_shapes, textbook, textbook_shapes
from tracer.measure.check.case import Reading, U, case, decimal, exactly, worst_of
from tracer.measure.check.draws import Draws, perpendicular, plus
from tracer.measure.check.exact_optics import along, dot, point
from tracer.measure.check.exact_shapes import DECIDING
from tracer.measure.check.families.judged import Decision, Hit, distances, wrong_of
from tracer.measure.check.scenes import DARK, path, paths, world
from tracer.scene import Object
from tracer.shapes.disc import Disc
from tracer.shapes.polygon import Polygon
from tracer.shapes.triangle import Triangle

Corners = tuple[Vector, Vector, Vector]
Face = type[Triangle] | type[Polygon]

# In units of u times the largest coordinate. The hit is o + t d: for each coordinate a product and a sum are rounded,
# and t d is at most twice the largest coordinate.
POINT = 4.0


def corners_of(chance: Draws) -> tuple[float, Corners]:
    """A triangle of any size in any place."""
    size = chance.size(-6, 6)
    middle = chance.place(size * chance.size(-3, 3))
    a, b, c = (plus(middle, chance.place(size)) for _ in range(3))
    return size, (a, b, c)


def in_plane(corners: Corners, u: float, v: float) -> Vector:
    """A point of the plane, up to rounding."""
    a, b, c = corners
    return plus(a, scale(u, subtract(b, a)), scale(v, subtract(c, a)))


def beside(hit: list[float] | None, corners: Corners) -> float:
    """The distance of a hit from the face; 0 for a miss."""
    return float(exact_shapes.distance_to_face(hit, corners)) if hit else 0.0


def edge_on(kind: Face, chance: Draws) -> Iterator[Reading]:
    """From an eye in the plane of the face, up to rounding, at points in and around the face."""
    drawn, beyond = [], 0
    for _ in range(50):
        _, corners = corners_of(chance)
        eye = in_plane(corners, chance.uniform(-9, 9), chance.uniform(-9, 9))
        aims = [subtract(in_plane(corners, chance.uniform(-1, 2), chance.uniform(-1, 2)), eye) for _ in range(10)]
        unit = U * max(abs(x) for x in (*eye, *corners[0], *corners[1], *corners[2]))
        for row in paths(world(Object(kind(corners), DARK, "face")), [eye], aims).hits:
            direction = row["direction"].tolist()
            ours = beside(row["point"].tolist() if math.isfinite(row["t"]) else None, corners)
            t = textbook.triangle(eye, direction, corners, least=0.0, tmin=0.0)
            usual = beside(list(textbook.at(eye, direction, t)) if t < math.inf else None, corners)
            drawn.append(Reading("", 0, ours, unit, POINT, usual))
            beyond += ours > float(row["error"])
    yield worst_of(f"edge-on {kind.name}: off by", drawn)
    yield exactly(f"edge-on {kind.name}: off by more than told, of {len(drawn)}", 0, beyond)


def nearly_edge_on(chance: Draws, count: int) -> Iterator[Hit]:
    """Rays at the inside of a face, with sines of 1e-8 to 1 between ray and face."""
    for _ in range(count):
        size, corners = corners_of(chance)
        u = chance.uniform(0.1, 0.8)
        target = in_plane(corners, u, chance.uniform(0.1, 0.9 - u))
        n = cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]))
        n = scale(1.0 / math.hypot(*n), n)
        away = plus(perpendicular(n, chance.direction()), scale(chance.size(-8, 0), n))
        eye = plus(target, scale(size * chance.size(-2, 2), away))
        row = path(world(Object(Triangle(corners), DARK, "face")), eye, subtract(target, eye)).nodes[0]
        direction = row["direction"].tolist()
        exact = exact_shapes.plane(eye, direction, corners[0], exact_shapes.normal(corners))
        usual = textbook.triangle(eye, direction, corners, least=0.0, tmin=0.0)
        yield Hit(exact, float(row["t"]), float(row["error"]), usual)


@case("B12", "faces seen edge-on, or nearly so", seconds=0.3)
def any_edge() -> Iterator[Reading]:
    """Seen edge-on the determinant is 0 up to rounding errors, and so are the products that are divided by it. u, v and
    t are then random numbers: the face is hit far from where it is. Moeller and Trumbore's threshold for the
    determinant would hide that, and small faces with it; it is left out here. A hit is compared with the face. The
    unit is u times the largest coordinate; of t, nearly edge-on, it is u times t.
    """
    for kind, seed in ((Triangle, 51), (Polygon, 52)):
        yield from edge_on(kind, Draws(seed))
    yield from distances("nearly edge-on", nearly_edge_on(Draws(53), 300))


def rims(chance: Draws) -> Iterator[Decision]:
    for _ in range(50):
        radius = chance.size(-6, 6)
        center, normal = chance.place(radius * chance.size(-3, 3)), chance.direction()
        eyes, aims = [], []
        for _ in range(10):
            margin = chance.choice((-1.0, 1.0)) * 2.0 ** -chance.uniform(1, 52)
            target = plus(center, scale(radius * (1.0 + margin), perpendicular(normal, chance.direction())))
            away = plus(chance.direction(), scale(chance.choice((-1.0, 1.0)), normal))
            eyes.append(plus(target, scale(radius * chance.size(-2, 4), away)))
            aims.append(subtract(target, eyes[-1]))
        found = paths(world(Object(Disc(center, normal, radius), DARK, "disc")), eyes, aims).hits
        for row, eye in zip(found, eyes, strict=True):
            direction = row["direction"].tolist()
            t = exact_shapes.plane(eye, direction, center, normal)
            arm = exact_shapes.minus(along(point(eye), point(direction), t), point(center))
            margin = dot(arm, arm) / decimal(radius) ** 2 - 1
            usual = textbook_shapes.disc(eye, direction, center, normal, radius, tmin=0.0)
            yield Decision(margin <= 0, math.isfinite(row["t"]), usual < math.inf, float(margin))


@case("B14", "the rims of discs of any size, seen from anywhere", seconds=0.06)
def any_rim() -> Iterator[Reading]:
    """The textbook computes the hit, and then its distance from the centre. The hit is rounded to the digits of the
    distance and of the place, so the last digits of the radius cannot decide. The margin is the difference between
    the squared distance of the exact hit and the squared radius, relative to the latter.
    """
    with localcontext(DECIDING):
        yield wrong_of("discs", list(rims(Draws(54))))

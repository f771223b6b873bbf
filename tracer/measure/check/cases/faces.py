"""Group B: a ray and a flat face: slivers, sizes, and rays inside a plane."""

import math
import random
from collections.abc import Iterator, Sequence
from decimal import Decimal

from tracer.formulas.vector import Vector, as_floats
from tracer.measure.check import textbook
from tracer.measure.check.case import DIGITS, Reading, U, case, decimal, exactly, worst_of
from tracer.measure.check.exact_optics import dot, point
from tracer.measure.check.scenes import DARK, box, glass, path, plane, world
from tracer.scene import Object
from tracer.shapes.triangle import Triangle

FLAT = ((-1e6, 0.0, -1e6), (1e6, 0.0, -1e6), (0.0, 0.0, 1e6))


def triangle(corners: Sequence[Sequence[float]]) -> Object:
    a, b, c = (as_floats(corner) for corner in corners)
    return Object(Triangle((a, b, c)), DARK, "triangle")


def distance(origin: Sequence[float], direction: Sequence[float], corners: Sequence[Sequence[float]]) -> Decimal:
    """The distance to the plane of a triangle, with 50 digits: n.(a - o) / n.d with n = (b - a) x (c - a)."""
    a, b, c = (point(as_floats(corner)) for corner in corners)
    o, d = point(origin), point(direction)
    p, q = [y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, c, strict=True)]
    n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    return DIGITS.divide(dot(n, [x - y for x, y in zip(a, o, strict=True)]), dot(n, d))


def reading(
    setting: str, corners: Sequence[Sequence[float]], origin: Sequence[float], aim: Sequence[float], allowed: float
) -> Reading:
    row = path(world(triangle(corners)), origin, aim).nodes[0]
    o, d = row["origin"].tolist(), row["direction"].tolist()
    exact = distance(o, d, corners)
    return Reading(setting, exact, float(row["t"]), U * float(exact), allowed, textbook.triangle(o, d, corners))


@case("B4", "the hit on an ordinary triangle: t and the point", seconds=0.3)
def inside() -> Iterator[Reading]:
    """Nothing goes wrong here: with sides of length 1 and the eye at distance 1, the textbook is right to the last
    digits, too. The case shows that care for the others costs nothing here.
    """
    corners, chance = ((0, 0, 0), (1, 0, 0), (0, 1, 0)), random.Random(2)
    some: dict[str, list[Reading]] = {"t": [], "u": [], "v": []}
    for _ in range(200):
        u, v = chance.random(), chance.random()
        u, v = (u, v) if u + v < 1.0 else (1.0 - u, 1.0 - v)
        some["t"].append(reading("", corners, (0, 0, -1), (u, v, 1.0), 4.0))
        row = path(world(triangle(corners)), (0, 0, -1), (u, v, 1.0)).nodes[0]
        d = row["direction"].tolist()
        usual = textbook.at((0, 0, -1), d, textbook.triangle((0, 0, -1), d, corners))
        for k, name in ((0, "u"), (1, "v")):
            exact = DIGITS.divide(decimal(d[k]), decimal(d[2]))
            some[name].append(Reading("", exact, float(row["point"][k]), U, 4.0, usual[k]))
    for name, readings in some.items():
        yield worst_of(name, readings)


@case("B6", "a sliver of a triangle, 1e-6 to 1e-100 wide")
def needle() -> Iterator[Reading]:
    """The usual test rejects a triangle if its determinant is below 1e-8, as if the ray were parallel to it. But the
    determinant is twice the area seen along the ray, and a sliver of width 1e-12 seen from above has an area of just
    1e-12. So it is missed. A test by signs needs no such limit.
    """
    for width in (1e-6, 1e-12, 1e-100):
        corners = ((0, 0, 0), (1, 0, 0), (0.5, width, 0))
        yield reading(f"width {width:g}", corners, (0.5, width / 3, 1), (0, 0, -1), 4.0)


@case("B7", "triangles of any size, legs of 1e-60 to 1e60")
def sizes() -> Iterator[Reading]:
    """The determinant is the product of two legs: 1e-12 for legs of 1e-6, 1e-120 for legs of 1e-60. A limit of 1e-8
    takes either for a ray parallel to the plane. A scene in metres is complete, but in kilometres, or as a fine
    mesh, it has holes.
    """
    for size in (1e-60, 1e-6, 1.0, 1e8, 1e60):
        corners = ((0, 0, 0), (size, 0, 0), (0, size, 0))
        yield reading(f"legs {size:g}", corners, (0.25 * size, 0.25 * size, 1), (0, 0, -1), 4.0)


@case("B8", "a millimetre above a triangle of a thousand kilometres")
def flat() -> Iterator[Reading]:
    """The distance is computed from corners 1e6 away, and the eye is 1e-6 above: products of size 1e12 are rounded
    before they cancel. A horizontal triangle is lucky, as its zeros are exact. Of a rotated one, the textbook's
    distance has a few digits or none. Double-double numbers keep twice the digits until all has cancelled.
    """
    turned = [turn(corner) for corner in FLAT]
    for height in (1e-3, 1e-6):
        origin, aim = (123.456, height, 7.89), (1.0, -1e-3, 1e-3)
        yield reading(f"{height:g} above it", FLAT, origin, aim, 8.0)
        row = path(world(triangle(FLAT)), origin, aim).nodes[0]
        usual = textbook.at(origin, row["direction"].tolist(), float(row["t"]))[1]
        yield exactly(f"{height:g} above it: height of the hit", 0, float(row["point"][1]), usual)
        yield reading(f"{height:g} above it, all rotated", turned, turn(origin), turn(aim), 8.0)


def turn(a: Sequence[float]) -> Vector:
    """A rotation about x by acos .6, then about z by acos .8. It is rounded, so the exact answer uses the rounded
    corners.
    """
    x, y, z = a[0], 0.6 * a[1] - 0.8 * a[2], 0.8 * a[1] + 0.6 * a[2]
    return (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y, z)


@case("B9", "a ray within a plane, and rays that graze it")
def within() -> Iterator[Reading]:
    """For a ray in the plane t is 0/0, so a program must test for this case. The distance is right at every angle, but
    o + t d is rounded: the hit may be 1e-16 beside the plane, on either side, and the next ray then starts under the
    floor. Here the hit is moved onto the plane.
    """
    scene = world(plane((0, 0, 0), (0, 1, 0), DARK))
    for aim in ((1, 0, 0), (0.6, 0, -0.8)):
        usual = textbook.plane((0, 0, 0), aim, (0, 0, 0), (0, 1, 0)) < math.inf
        got = path(scene, (0, 0, 0), aim).object_name(0) is not None
        yield exactly(f"in the plane, along {aim}", "miss", "hit" if got else "miss", "hit" if usual else "miss")
    for angle in (0.3, 1e-2, 1e-4, 1e-8):
        row = path(scene, (0, 1, 0), (math.cos(angle), -math.sin(angle), 0)).nodes[0]
        d = row["direction"].tolist()
        exact, usual = DIGITS.divide(Decimal(-1), decimal(d[1])), textbook.plane((0, 1, 0), d, (0, 0, 0), (0, 1, 0))
        yield Reading(f"at {angle:g}: t", exact, float(row["t"]), U * float(exact), 4.0, usual)
        after = textbook.at((0, 1, 0), d, usual)[1]
        yield exactly(f"at {angle:g}: height of the hit", 0, float(row["point"][1]), after)


@case("B10", "a ray in the face of a box")
def slabs() -> Iterator[Reading]:
    """The usual test multiplies by 1/d, which is infinite if d is 0. For a ray that starts in the plane of a face that
    gives 0 times infinity: NaN, which fails every comparison, so the box is missed. A direction of 0 never crosses
    that pair of planes, so the start decides.
    """
    low, high = (0.0, -1.0, -1.0), (1.0, 1.0, 1.0)
    scene = world(box(low, high, glass(1.0)))
    for setting, x, across in (
        ("in its face x = 0", 0.0, 0.0),
        ("inside, d.x = -0", 0.5, -0.0),
        ("in its face x = 1", 1.0, 0.0),
    ):
        t = path(scene, (x, 0, -5), (across, 0, 1), depth=1).nodes["t"]
        enter, leave = textbook.slab((x, 0, -5), (across, 0, 1), low, high)
        usual = f"{enter:g} to {leave:g}" if enter <= leave else "miss"
        got = f"{t[0]:.17g} to {t[0] + t[1]:.17g}" if len(t) > 1 else "miss"
        yield exactly(setting, "4 to 6", got, usual)

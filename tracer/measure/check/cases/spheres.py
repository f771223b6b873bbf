"""Group A: a ray and a sphere, far, near, huge, tiny: the distance to the hit."""

import math
import random
from collections.abc import Iterator, Sequence
from decimal import Decimal

from tracer.measure.check import textbook
from tracer.measure.check.case import DIGITS, Reading, U, case, decimal, root, worst_of
from tracer.measure.check.exact_optics import dot, point
from tracer.measure.check.scenes import MATTE, ball, glass, path, world


def roots(
    origin: Sequence[float], direction: Sequence[float], center: Sequence[float], radius: float
) -> tuple[Decimal, Decimal]:
    """Both distances with 50 digits. The given numbers are taken as exact."""
    f = [o - c for o, c in zip(point(origin), point(center), strict=True)]
    d = point(direction)
    a, b, c = dot(d, d), dot(f, d), dot(f, f) - decimal(radius) ** 2
    half = root(b * b - a * c)
    return DIGITS.divide(-b - half, a), DIGITS.divide(-b + half, a)


def reading(
    setting: str,
    origin: Sequence[float],
    direction: Sequence[float],
    center: Sequence[float] = (0, 0, 0),
    radius: float = 1.0,
    inside: bool = False,
) -> Reading:
    """The distance to the sphere, with an error of at most 4 roundings."""
    row = path(world(ball(center, radius, MATTE)), origin, direction).nodes[0]
    exact = roots(row["origin"].tolist(), row["direction"].tolist(), center, radius)[1 if inside else 0]
    usual = textbook.sphere(row["origin"].tolist(), row["direction"].tolist(), center, radius)
    return Reading(setting, exact, float(row["t"]), U * abs(float(exact)), 4.0, usual)


@case("A1", "a unit sphere seen from far away, near its edge", seconds=0.1)
def far() -> Iterator[Reading]:
    """The textbook takes b^2 - 4ac, two numbers of the size of the squared distance, for a difference of the size of
    the squared radius. At D = 1e7 they share all but their last digits, and the hit is visibly off the sphere. At D
    = 1e8 the difference is all rounding error: the silhouette is ragged, and rays miss the sphere. Measured from the
    ray's closest point to the centre, nothing large is left to cancel.
    """
    w = textbook.unit((0.3, -0.5, 0.81))
    aim = [0.9 * x for x in textbook.unit(textbook.cross(w, (1.0, 0.0, 0.0)))]
    scene = world(ball((0, 0, 0), 1.0, MATTE))
    for distance in (1e3, 1e5, 1e6, 1e7, 4.6e7, 9.5e7, 1.9e8, 1e9, 1e12):
        origin = textbook.at(aim, w, -distance)
        row = path(scene, origin, w).nodes[0]
        d = row["direction"].tolist()
        exact = roots(origin, d, (0, 0, 0), 1.0)[0]
        usual = textbook.sphere(origin, d, (0, 0, 0), 1.0)
        yield Reading(f"D = {distance:g}", exact, float(row["t"]), 2 * U * distance, 4.0, usual)
        above = textbook.at(origin, d, usual) if usual < math.inf else None
        yield Reading(
            f"D = {distance:g}: hit to centre",
            1,
            float(root(sum(decimal(x) ** 2 for x in row["point"].tolist()))),
            textbook=math.sqrt(textbook.dot(above, above)) if above else math.inf,
        )


@case("A2", "a ray that starts just above a unit sphere")
def near() -> Iterator[Reading]:
    """The near root is -b - sqrt(b^2 - 4ac), two numbers near 1 whose difference is as small as the height, down to
    1e-15. Each has an error of 1e-16. A smallest distance of 1e-4 hides that: it discards nearer hits, and the ray
    continues to the far side.
    """
    for k in (10, 20, 30, 40, 50):
        yield reading(f"2^-{k} above it", (0, 0, 1 + 2.0**-k), (0.6, 0, -0.8))


@case("A3", "a sphere of radius 1e3 to 1e15 as the ground", seconds=0.1)
def ground() -> Iterator[Reading]:
    """The centre is R below, so b^2 and 4ac are of size R^2, and the height of the eye is left when they cancel. The
    error grows with R, except for a few round numbers: at R = 1e9 seven digits of the distance are right, at 1e15
    hardly one. The floor of the scene then shows rings, or is missing.
    """
    chance = random.Random(3)
    for radius in (1e3, 1e6, 6.371e6, 1e9, 1e12, 1e15):
        yield reading(f"R = {radius:g}", (0, 0, 1), (0.6, 0, -0.8), (0, 0, -radius), radius)
        some = []
        for _ in range(30):
            tilt, turn = math.radians(chance.uniform(0, 80)), chance.uniform(0, 2 * math.pi)
            aim = (math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), -math.cos(tilt))
            some.append(reading("", (0, 0, chance.uniform(0.5, 2)), aim, (0, 0, -radius), radius))
        yield worst_of(f"R = {radius:g}", some)
    yield reading("R = 1e12, from the side", (0.3, 0.2, 1.1), (0.6, 0, -0.8), (0, 0, -1e12), 1e12)


@case("A6", "the exit from a sphere just below its top")
def grazing() -> Iterator[Reading]:
    """With y = 1 - 2^-k the root is that of 1 - y^2, which is about 2^(1-k). The textbook rounds y^2 to 1e-16 first,
    which can leave four digits of the difference at k = 40. (1 - y)(1 + y) loses nothing. And a smallest distance of
    1e-4 discards the exit itself: the ray never leaves the sphere.
    """
    for k in (10, 20, 30, 40, 50):
        yield reading(f"2^-{k} below the top", (0, 1 - 2.0**-k, 0), (1, 0, 0), inside=True)


@case("A7", "directions of any length, 1e-170 to 1e170")
def lengths() -> Iterator[Reading]:
    """a = d.d is the square of the length: for 1e-170 it is 0, for 1e170 infinite, and there is no quadratic any more.
    A length of 1e100 makes the distance 4e-100 in units of d, which a smallest distance of 1e-4 discards. Scaled by
    a power of two first, every direction keeps all its digits.
    """
    scene = world(ball((0, 0, 0), 1.0, MATTE))
    for s in (1e-170, 1e-100, 1e100, 1e170):
        got = float(path(scene, (0, 0, 5), (0, 0, -s)).nodes[0]["t"])
        usual = textbook.sphere((0, 0, 5), (0, 0, -s), (0, 0, 0), 1.0) * s
        yield Reading(f"|d| = {s:g}", 4, got, 4 * U, 4.0, usual)


@case("A8", "half a metre above the Earth, in metres")
def earth() -> Iterator[Reading]:
    """The squared radius is 4e13, and the hit is half a metre away: the rounding of the squares alone is 0.004. The
    textbook's distance has nine right digits here, and a tracer in single precision has none: it finds the other
    side of the Earth.
    """
    for name, aim in (("down", (0, 0, -1)), ("slanting", (0.6, 0, -0.8)), ("flat", (0.9995, 0, -0.0316))):
        yield reading(name, (0, 0, 6.371e6 + 0.5), aim, radius=6.371e6)


@case("A9", "a tiny glass ball at distance 1: the chord through it")
def tiny() -> Iterator[Reading]:
    """c = f.f - r^2 is 1 for every r below 1e-8: the radius is lost before the discriminant is computed. Both roots are
    then 1: the ball has no thickness, and rays that pass it at a few radii hit it, too. Our ray starts on the sphere
    and computes the chord, -2 f.d, which depends only on the radius.
    """
    for radius in (1e-3, 1e-5, 1e-6, 1e-9, 1e-12, 1e-100, 1e-150):
        rows = path(world(ball((0, 0, 0), radius, glass(1.0))), (0, 0, 1), (0, 0, -1), depth=1).nodes
        enters = textbook.sphere((0, 0, 1), (0, 0, -1), (0, 0, 0), radius)
        usual = textbook.sphere((0, 0, 1), (0, 0, -1), (0, 0, 0), radius, enters) - enters
        got = float(rows["t"][1]) if len(rows) > 1 else math.nan
        yield Reading(f"r = {radius:g}", 2 * decimal(radius), got, 2 * U * radius, 4.0, usual)

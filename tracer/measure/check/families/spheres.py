"""Families of spheres: the distance to the hit, and hit or miss at the silhouette."""

import math
from collections.abc import Iterator
from decimal import localcontext

from tracer.formulas.vector import scale, subtract
from tracer.measure.check import exact_shapes, textbook
from tracer.measure.check.case import Reading, case, decimal
from tracer.measure.check.draws import Draws, perpendicular, plus
from tracer.measure.check.exact_shapes import DECIDING
from tracer.measure.check.families.judged import Decision, Hit, distances, wrong_of
from tracer.measure.check.scenes import MATTE, ball, path, paths, world


def hits(chance: Draws, count: int) -> Iterator[Hit]:
    """Rays from outside, far and near, through the middle and near the silhouette."""
    while count:
        radius = chance.size(-9, 9)
        center = chance.place(radius * chance.size(-3, 6))
        away = chance.direction()
        eye = plus(center, scale(radius * (1.0 + chance.size(-9, 6)), away))
        beside = scale(radius * (1.0 - chance.size(-12, 0)), perpendicular(away, chance.direction()))
        row = path(world(ball(center, radius, MATTE)), eye, subtract(plus(center, beside), eye)).nodes[0]
        direction = row["direction"].tolist()
        if exact := exact_shapes.sphere(eye, direction, center, radius):
            count -= 1
            usual = textbook.sphere(eye, direction, center, radius, tmin=0.0)
            yield Hit(exact[0], float(row["t"]), float(row["error"]), usual)


@case("A12", "any sphere from anywhere: radius 1e-9 to 1e9, 1e-9 to 1e6 radii away", seconds=0.3)
def any_sphere() -> Iterator[Reading]:
    """b^2 - 4ac loses the digits of the radius if the sphere is far away, and -b - sqrt(b^2 - 4ac) those of the height
    if the eye is close to it. The textbook has no smallest distance here, which would cost it all small spheres. The
    ray and the sphere are taken as exact, so the condition number is 1: the unit is u times the distance.
    """
    yield from distances("spheres", hits(Draws(12), 500))


def silhouettes(chance: Draws) -> Iterator[Decision]:
    for _ in range(60):
        radius = chance.size(-9, 9)
        center = chance.place(radius * chance.size(-3, 3))
        away = chance.direction()
        far = 1.0 + chance.size(-2, 4)
        eye, aims = plus(center, scale(radius * far, away)), []
        for _ in range(10):
            sine = min((1.0 + chance.choice((-1.0, 1.0)) * 2.0 ** -chance.uniform(1, 52)) / far, 1.0)
            beside = scale(sine, perpendicular(away, chance.direction()))
            aims.append(plus(scale(-math.sqrt((1.0 - sine) * (1.0 + sine)), away), beside))
        for row in paths(world(ball(center, radius, MATTE)), [eye], aims).hits:
            direction = row["direction"].tolist()
            exact = exact_shapes.sphere(eye, direction, center, radius)
            usual = textbook.sphere(eye, direction, center, radius, tmin=0.0)
            margin = exact_shapes.beside(eye, direction, center) / decimal(radius) ** 2 - 1
            yield Decision(bool(exact), math.isfinite(row["t"]), usual < math.inf, float(margin))


@case("A13", "the silhouettes of spheres of any size, seen from anywhere", seconds=0.1)
def any_silhouette() -> Iterator[Reading]:
    """Hit or miss is the sign of b^2 - 4ac, which has rounding errors of the size of the squared distance. At 1e4 radii
    away these are 1e-8 of the squared radius, and any margin below that is decided at random. The margin of a ray is
    the difference between its squared distance from the centre and the squared radius, relative to the latter.
    """
    with localcontext(DECIDING):
        yield wrong_of("spheres", list(silhouettes(Draws(13))))

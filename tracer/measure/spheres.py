"""Group A: a ray and a sphere, far, near, huge, tiny, grazing."""

from collections.abc import Iterator
from decimal import Decimal

from tracer.measure import textbook
from tracer.measure.case import DIGITS, Case, Reading, U, decimal, root
from tracer.measure.stages import MATTE, ball, path, world


def _roots(origin, direction, center, radius) -> tuple[Decimal, Decimal]:
    """Both distances with 50 digits, of numbers taken as they are."""
    f = [decimal(o) - decimal(c) for o, c in zip(origin, center, strict=True)]
    d = [decimal(x) for x in direction]
    a = sum((x * x for x in d), Decimal(0))
    b = sum((x * y for x, y in zip(f, d, strict=True)), Decimal(0))
    c = sum((x * x for x in f), Decimal(0)) - decimal(radius) ** 2
    half = root(b * b - a * c)
    return DIGITS.divide(-b - half, a), DIGITS.divide(-b + half, a)


def far() -> Iterator[Reading]:
    for distance in (1e3, 1e6, 1e7, 1e9, 1e12):
        w = textbook.unit((0.3, -0.5, 0.81))
        origin = [x - distance * y for x, y in zip((0.4, 0.3, -0.2), w, strict=True)]
        row = path(world(ball((0, 0, 0), 1.0, MATTE)), origin, w).nodes[0]
        exact = _roots(row["origin"].tolist(), row["direction"].tolist(), (0, 0, 0), 1.0)[0]
        usual = textbook.sphere(origin, w, (0, 0, 0), 1.0)
        yield Reading(f"D = {distance:g}", exact, float(row["t"]), 2 * U * distance, 4.0, usual)


CASES = (
    Case(
        "A1",
        "a unit sphere seen from far away: the distance to it",
        far,
        "The textbook takes b^2 - 4ac, two numbers of the size of the squared distance, to find a difference of the "
        "size of the squared radius. At D = 1e8 that difference is all rounding: the edge frays, then the sphere is "
        "missed. Measured from the point of the ray nearest to the centre nothing large is left to cancel.",
    ),
)

"""Optics with 50 digits, for the exact answers of rays through glass and mirrors. Floats are taken as exact."""

from collections.abc import Iterable, Sequence
from decimal import Decimal
from typing import NamedTuple

from tracer.measure.check.case import decimal, root

Number = Decimal | float
Point = list[Decimal]


class Bend(NamedTuple):
    """Sines and cosines of incidence and refraction, and reflectance and transmittance for unpolarised light."""

    s1: Decimal
    c1: Decimal
    s2: Decimal
    c2: Decimal
    r: Decimal
    t: Decimal


def point(values: Iterable[Number]) -> Point:
    return [decimal(value) for value in values]


def dot(a: Sequence[Decimal], b: Sequence[Decimal]) -> Decimal:
    return sum((x * y for x, y in zip(a, b, strict=True)), Decimal(0))


def unit(a: Iterable[Number]) -> Point:
    a = point(a)
    size = root(dot(a, a))
    return [x / size for x in a]


def along(p: Sequence[Decimal], d: Sequence[Decimal], t: Number) -> Point:
    return [x + decimal(t) * y for x, y in zip(p, d, strict=True)]


def bend(s1: Number, n1: float, n2: float) -> Bend:
    """The angles and shares at a sine of incidence, which must be below the critical angle's."""
    s1, a, b = decimal(s1), decimal(n1), decimal(n2)
    c1, s2 = root(1 - s1 * s1), a * s1 / b
    c2 = root(1 - s2 * s2)
    rs, rp = (a * c1 - b * c2) / (a * c1 + b * c2), (b * c1 - a * c2) / (b * c1 + a * c2)
    r = (rs * rs + rp * rp) / 2
    return Bend(s1, c1, s2, c2, r, 1 - r)


def across(direction: Iterable[Number], axis: int = 1) -> Decimal:
    """The sine of the angle between a direction and a coordinate axis."""
    d = unit(direction)
    return root(sum((x * x for i, x in enumerate(d) if i != axis), Decimal(0)))


def arctan(x: Number) -> Decimal:
    """The arc tangent. The argument is halved until the series is short."""
    x, halvings = decimal(x), 0
    while abs(x) > Decimal("0.01"):
        x, halvings = x / (1 + root(1 + x * x)), halvings + 1
    total, power, k = Decimal(0), x, 1
    while power and abs(power) > abs(x) * Decimal("1e-55"):
        total, power, k = total + power / k, -power * x * x, k + 2
    return total * 2**halvings


def arcsin(x: Number) -> Decimal:
    x = decimal(x)
    return arctan(x / root(1 - x * x))


def pi() -> Decimal:
    return 4 * arctan(Decimal(1))


def chord(p: Sequence[Number], d: Sequence[Number]) -> tuple[Point, Point]:
    """The points at which a line enters and leaves the unit circle."""
    p, d = point(p), unit(d)
    middle, b = dot(p, p), dot(p, d)
    half = root(b * b - middle + 1)
    return along(p, d, -b - half), along(p, d, -b + half)


def round_and_round(p: Sequence[Number], d: Sequence[Number], bounces: int) -> Point:
    """The point that a ray inside a mirrored unit circle reaches after some bounces: each turns the chord by the same
    angle.
    """
    (ax, ay), (bx, by) = chord(p, d)
    turn = (ax * bx + ay * by, ax * by - ay * bx)
    x, y = bx, by
    while bounces:
        if bounces % 2:
            x, y = x * turn[0] - y * turn[1], x * turn[1] + y * turn[0]
        turn, bounces = (turn[0] ** 2 - turn[1] ** 2, 2 * turn[0] * turn[1]), bounces // 2
    return [x, y]


def to_and_fro(p: Sequence[Number], d: Sequence[Number], centers: Sequence[Sequence[float]], count: int) -> list[Point]:
    """The points that a ray meets alternately on two mirrored unit balls. The first of them is last in `centers`."""
    p, d, points = point(p), unit(d), []
    for k in range(count):
        center = point(centers[(k + 1) % 2])
        f = [x - c for x, c in zip(p, center, strict=True)]
        b = dot(f, d)
        square = b * b - dot(f, f) + 1
        if square < 0:
            break
        p = along(p, d, -b - root(square))
        n = [x - c for x, c in zip(p, center, strict=True)]
        d = along(d, n, -2 * dot(n, d))
        points.append(p)
    return points

"""Ball arithmetic: numbers with a radius that surely contains the exact value (F. Johansson's Arb, by python-flint).

A ball is a `flint.arb`. A comparison of balls is true only if it holds for all their values, so of `a < b` and
`a >= b` both may be false. Square roots, quotients and powers through 0 give nan: callers decide the sign first.
"""

import math
from collections.abc import Iterable, Sequence
from contextlib import AbstractContextManager
from typing import Any

from tracer.extras import MissingExtra, missing_extra
from tracer.tree.margins.surfaces import PARALLEL_NORMALS

Ball = Any  # flint.arb
BallVector = tuple[Ball, Ball, Ball]

PRECISIONS = (128, 512)  # bits; the next is tried where decisions are left open


def flint() -> Any:
    """The library, loaded when a tree is verified. MissingExtra if it is not installed."""
    try:
        import flint
    except ImportError as error:
        raise MissingExtra(missing_extra("verified trees need", "verify")) from error
    return flint


def precision(bits: int) -> AbstractContextManager[None]:
    """A context in which balls have this many bits."""
    return flint().ctx.workprec(bits)


def ball(x: float) -> Ball:
    """A float without rounding."""
    return flint().arb(x)


def balls(values: Iterable[float]) -> BallVector:
    """Three floats without rounding."""
    arb = flint().arb
    x, y, z = (arb(float(value)) for value in values)
    return (x, y, z)


def add(a: BallVector, b: BallVector) -> BallVector:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: BallVector, b: BallVector) -> BallVector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(k: Ball, a: BallVector) -> BallVector:
    return (k * a[0], k * a[1], k * a[2])


def dot(a: BallVector, b: BallVector) -> Ball:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: BallVector, b: BallVector) -> BallVector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def square(a: BallVector) -> Ball:
    return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]


def unit(a: BallVector) -> BallVector:
    """nan if the vector may be 0."""
    return scale(1 / square(a).sqrt(), a)


def is_parallel(a: BallVector, n: Sequence[float]) -> bool:
    """Whether two unit vectors, the second of which has rounding errors, are parallel or opposite."""
    return all(max(map(abs, bounds(x))) < PARALLEL_NORMALS for x in cross(a, balls(n)))


def sign(x: Ball) -> int | None:
    """-1, 0 or +1; None if the ball does not tell."""
    if x > 0:
        return 1
    if x < 0:
        return -1
    return 0 if x.is_zero() else None


def anywhere() -> Ball:
    """A ball around all numbers."""
    arb = flint().arb
    return arb.neg_inf().union(arb.pos_inf())


def nowhere() -> BallVector:
    """A vector of which nothing is known."""
    nan = flint().arb.nan()
    return (nan, nan, nan)


def between(low: Ball, high: Ball) -> Ball:
    """A ball around all numbers between two balls."""
    return low.union(high)


def power(base: Ball, exponent: float) -> Ball:
    """max(base, 0) to a positive power, taken at the ends of the base's range."""
    top = base.upper()
    if not top > 0:
        return ball(0.0)
    bottom, p = base.lower(), ball(exponent)
    low = bottom**p if bottom > 0 else ball(0.0)
    return between(low, top**p)


def bounds(x: Ball) -> tuple[float, float]:
    """Floats below and above all values of a ball; (-inf, inf) for nan."""
    if not x.is_finite():
        return (-math.inf, math.inf)
    low, high = float(x.lower()), float(x.upper())
    if x.is_exact() and ball(low) == x:
        return (low, low)
    return (math.nextafter(low, -math.inf), math.nextafter(high, math.inf))


def up_product(a: float, b: float) -> float:
    """a b for numbers >= 0, rounded upwards; 0 times infinity is 0."""
    return math.nextafter(a * b, math.inf) if a > 0.0 and b > 0.0 else 0.0


def up_sum(a: float, b: float) -> float:
    """a + b, rounded upwards."""
    return math.nextafter(a + b, math.inf) if b > 0.0 else a

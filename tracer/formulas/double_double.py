"""Numbers as the unevaluated sum of two floats: twice the digits, for what would cancel in one.

A rounding error of a sum or a product is itself a float, and a few operations find it (Knuth, TAOCP 2, 4.2.2; Dekker,
Numerische Mathematik 18, 1971; Ogita, Rump & Oishi, SIAM J. Sci. Comput. 26(6), 2005). What is kept in pairs here has
an error of some 2^-104 of the largest number met on the way, so the difference of two large numbers keeps its digits.

From Python these functions take arrays as well.
"""

import math

from tracer.compile.intrinsics import product_error
from tracer.compile.jit import compiled
from tracer.formulas.vector import Vector

U = 2.0**-53  # the unit of rounding: no operation is wrong by more than this times its result
SMALLEST = 5e-324  # the number after 0

Pair = tuple[float, float]  # (nearest float, what is missing)


@compiled
def two_sum(a: float, b: float) -> Pair:
    """a + b without an error."""
    total = a + b
    part = total - a
    return (total, (a - (total - part)) + (b - part))


@compiled
def two_product(a: float, b: float) -> Pair:
    """a b without an error."""
    product = a * b
    return (product, product_error(a, b, product))


@compiled
def normal_pair(high: float, low: float) -> Pair:
    """The same sum as a pair, for |low| <= |high|."""
    total = high + low
    return (total, low - (total - high))


@compiled
def plus(a: Pair, b: Pair) -> Pair:
    high, low = two_sum(a[0], b[0])
    return normal_pair(high, low + (a[1] + b[1]))


@compiled
def minus(a: Pair, b: Pair) -> Pair:
    return plus(a, (-b[0], -b[1]))


@compiled
def times(a: Pair, b: Pair) -> Pair:
    high, low = two_product(a[0], b[0])
    return normal_pair(high, low + (a[0] * b[1] + a[1] * b[0]))


@compiled
def over(a: Pair, b: Pair) -> float:
    """a / b as one float."""
    quotient = a[0] / b[0]
    high, low = two_product(quotient, b[0])
    return quotient + ((a[0] - high) - low + (a[1] - quotient * b[1])) / b[0]


@compiled
def root(a: Pair) -> Pair:
    """The square root of a pair >= 0."""
    if a[0] <= 0.0:
        return (0.0, 0.0)
    guess = math.sqrt(a[0])
    high, low = two_product(guess, guess)
    return normal_pair(guess, ((a[0] - high) - low + a[1]) / (2.0 * guess))


PairVector = tuple[Pair, Pair, Pair]


@compiled
def exact_difference(a: Vector, b: Vector) -> PairVector:
    """a - b without an error."""
    return (two_sum(a[0], -b[0]), two_sum(a[1], -b[1]), two_sum(a[2], -b[2]))


@compiled
def pair_vector(a: Vector) -> PairVector:
    return ((a[0], 0.0), (a[1], 0.0), (a[2], 0.0))


@compiled
def pair_dot(a: PairVector, b: PairVector) -> Pair:
    """The three products and their sum without an error, but for what is a rounding of a rounding (Ogita, Rump &
    Oishi, SIAM J. Sci. Comput. 26(6), 2005)."""
    x, y, z = two_product(a[0][0], b[0][0]), two_product(a[1][0], b[1][0]), two_product(a[2][0], b[2][0])
    two = two_sum(x[0], y[0])
    three = two_sum(two[0], z[0])
    across = (
        (a[0][0] * b[0][1] + a[0][1] * b[0][0])
        + (a[1][0] * b[1][1] + a[1][1] * b[1][0])
        + (a[2][0] * b[2][1] + a[2][1] * b[2][0])
    )
    return normal_pair(three[0], (two[1] + three[1]) + ((x[1] + y[1] + z[1]) + across))


@compiled
def pair_cross(a: PairVector, b: PairVector) -> PairVector:
    return (
        minus(times(a[1], b[2]), times(a[2], b[1])),
        minus(times(a[2], b[0]), times(a[0], b[2])),
        minus(times(a[0], b[1]), times(a[1], b[0])),
    )

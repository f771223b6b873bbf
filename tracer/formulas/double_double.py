"""Numbers as the unevaluated sum of two floats: twice the digits, for what would cancel in one.

A rounding error of a sum or a product is itself a float, and a few operations find it (Knuth, TAOCP 2, 4.2.2; Dekker,
Numerische Mathematik 18, 1971; Ogita, Rump & Oishi, SIAM J. Sci. Comput. 26(6), 2005). What is kept in pairs here has
an error of some 2^-104 of the largest number met on the way, so the difference of two large numbers keeps its digits.

From Python these functions take arrays as well.
"""

import math

from tracer.compile.intrinsics import product_error
from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector

U = 2.0**-53  # the unit of rounding: no operation is wrong by more than this times its result
SMALLEST = 5e-324  # the number after 0

DD = tuple[float, float]  # (nearest float, what is missing)


@inlined
def two_sum(a: float, b: float) -> DD:
    """a + b without an error."""
    total = a + b
    part = total - a
    return (total, (a - (total - part)) + (b - part))


@inlined
def two_product(a: float, b: float) -> DD:
    """a b without an error."""
    product = a * b
    return (product, product_error(a, b, product))


@inlined
def quick_two_sum(high: float, low: float) -> DD:
    """The same sum as a pair, for |low| <= |high|."""
    total = high + low
    return (total, low - (total - high))


@inlined
def dd_add(a: DD, b: DD) -> DD:
    high, low = two_sum(a[0], b[0])
    return quick_two_sum(high, low + (a[1] + b[1]))


@inlined
def dd_subtract(a: DD, b: DD) -> DD:
    return dd_add(a, (-b[0], -b[1]))


@inlined
def dd_multiply(a: DD, b: DD) -> DD:
    high, low = two_product(a[0], b[0])
    return quick_two_sum(high, low + (a[0] * b[1] + a[1] * b[0]))


@inlined
def dd_divide(a: DD, b: DD) -> float:
    """a / b as one float."""
    quotient = a[0] / b[0]
    high, low = two_product(quotient, b[0])
    return quotient + ((a[0] - high) - low + (a[1] - quotient * b[1])) / b[0]


@inlined
def dd_sqrt(a: DD) -> DD:
    """The square root of a pair >= 0."""
    if a[0] <= 0.0:
        return (0.0, 0.0)
    guess = math.sqrt(a[0])
    high, low = two_product(guess, guess)
    return quick_two_sum(guess, ((a[0] - high) - low + a[1]) / (2.0 * guess))


DDVector = tuple[DD, DD, DD]


@inlined
def exact_difference(a: Vector, b: Vector) -> DDVector:
    """a - b without an error."""
    return (two_sum(a[0], -b[0]), two_sum(a[1], -b[1]), two_sum(a[2], -b[2]))


@inlined
def dd_vector(a: Vector) -> DDVector:
    return ((a[0], 0.0), (a[1], 0.0), (a[2], 0.0))


@inlined
def dd_dot(a: DDVector, b: DDVector) -> DD:
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
    return quick_two_sum(three[0], (two[1] + three[1]) + ((x[1] + y[1] + z[1]) + across))


@inlined
def dd_cross(a: DDVector, b: DDVector) -> DDVector:
    return (
        dd_subtract(dd_multiply(a[1], b[2]), dd_multiply(a[2], b[1])),
        dd_subtract(dd_multiply(a[2], b[0]), dd_multiply(a[0], b[2])),
        dd_subtract(dd_multiply(a[0], b[1]), dd_multiply(a[1], b[0])),
    )

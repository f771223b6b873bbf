"""Double-double arithmetic: a number as the unevaluated sum of two floats, with twice the digits of one.

The rounding error of a sum or a product is itself a float, and a few operations compute it (Knuth, TAOCP 2, 4.2.2;
Dekker, Numerische Mathematik 18, 1971; Ogita, Rump & Oishi, SIAM J. Sci. Comput. 26(6), 2005). Results here are
within about 2^-104 of the largest intermediate number, so the difference of two large numbers keeps its digits.

From Python, these functions also take arrays.
"""

import math

from tracer.compile.intrinsics import product_error
from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector

U = 2.0**-53  # unit roundoff: an operation is off by at most this times its result
SMALLEST = 5e-324  # the smallest float above 0

DD = tuple[float, float]  # (high, low): the nearest float, and the rest


@inlined
def two_sum(a: float, b: float) -> DD:
    """a + b exactly (Knuth's TwoSum)."""
    total = a + b
    part = total - a
    return (total, (a - (total - part)) + (b - part))


@inlined
def two_product(a: float, b: float) -> DD:
    """a b exactly."""
    product = a * b
    return (product, product_error(a, b, product))


@inlined
def quick_two_sum(high: float, low: float) -> DD:
    """high + low exactly, for |low| <= |high| (Dekker's Fast2Sum)."""
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
    """a / b, rounded to one float."""
    return dd_quotient(a, b)[0]


@inlined
def dd_quotient(a: DD, b: DD) -> DD:
    """a / b."""
    quotient = a[0] / b[0]
    high, low = two_product(quotient, b[0])
    rest = ((a[0] - high) - low + (a[1] - quotient * b[1])) / b[0]
    return quick_two_sum(quotient, rest)


@inlined
def dd_sqrt(a: DD) -> DD:
    """The square root of a >= 0."""
    if a[0] <= 0.0:
        return (0.0, 0.0)
    guess = math.sqrt(a[0])
    high, low = two_product(guess, guess)
    return quick_two_sum(guess, ((a[0] - high) - low + a[1]) / (2.0 * guess))


DDVector = tuple[DD, DD, DD]


@inlined
def exact_difference(a: Vector, b: Vector) -> DDVector:
    """a - b exactly."""
    return (two_sum(a[0], -b[0]), two_sum(a[1], -b[1]), two_sum(a[2], -b[2]))


@inlined
def dd_vector(a: Vector) -> DDVector:
    return ((a[0], 0.0), (a[1], 0.0), (a[2], 0.0))


@inlined
def dd_dot(a: DDVector, b: DDVector) -> DD:
    """The dot product. Products and sums are exact; only terms of second order in the rounding error are rounded."""
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


@inlined
def dd_scale(k: DD, a: DDVector) -> DDVector:
    """k a."""
    return (dd_multiply(a[0], k), dd_multiply(a[1], k), dd_multiply(a[2], k))


@inlined
def dd_minus(a: DDVector, b: DDVector) -> DDVector:
    """a - b."""
    return (dd_subtract(a[0], b[0]), dd_subtract(a[1], b[1]), dd_subtract(a[2], b[2]))

"""Double-double arithmetic against fractions: error-free operations have no error, the others 2^-104 relative."""

import math
import random
from collections.abc import Iterator
from fractions import Fraction

from tracer.formulas.double_double import (
    DD,
    dd_add,
    dd_cross,
    dd_divide,
    dd_dot,
    dd_multiply,
    dd_sqrt,
    dd_subtract,
    quick_two_sum,
    two_product,
    two_sum,
)

E = Fraction(1, 2**104)


def exact(a: DD) -> Fraction:
    return Fraction(a[0]) + Fraction(a[1])


def numbers(seed: int) -> Iterator[tuple[float, float]]:
    """Pairs of either sign, often so close that their difference cancels, or of very different size."""
    draw = random.Random(seed)
    for k in range(300):
        a = draw.choice((-1.0, 1.0)) * 2.0 ** draw.uniform(-60, 60)
        near = -a * (1.0 + draw.uniform(-1, 1) * 2.0 ** draw.uniform(-52, -1))
        yield a, near if k % 2 else draw.uniform(-1, 1) * 2.0 ** draw.uniform(-60, 60)


def pairs(seed: int) -> Iterator[tuple[DD, DD]]:
    draw = random.Random(seed)
    for a, b in numbers(seed):
        yield tuple(quick_two_sum(x, x * draw.uniform(-1, 1) * 2.0**-53) for x in (a, b))  # type: ignore[misc]


def test_sum_and_product_of_floats_have_no_error() -> None:
    for a, b in numbers(1):
        for found, true in ((two_sum(a, b), Fraction(a) + Fraction(b)), (two_product(a, b), Fraction(a) * Fraction(b))):
            assert exact(found) == true
            assert found[0] == float(true)


def test_sums_and_products_of_pairs() -> None:
    """The error of a sum is relative to its larger operand, because the sum may cancel."""
    for a, b in pairs(2):
        x, y = exact(a), exact(b)
        most = max(abs(x), abs(y))
        assert abs(exact(dd_add(a, b)) - (x + y)) <= E * most
        assert abs(exact(dd_subtract(a, b)) - (x - y)) <= E * most
        assert abs(exact(dd_multiply(a, b)) - x * y) <= 4 * E * abs(x * y)


def test_quotient_is_the_nearest_float() -> None:
    """Except for quotients within a millionth of the midpoint between two floats."""
    for a, b in pairs(3):
        true = exact(a) / exact(b)
        assert abs(Fraction(dd_divide(a, b)) - true) <= Fraction(math.ulp(float(true))) * (
            Fraction(1, 2) + Fraction(1, 10**6)
        )


def test_root() -> None:
    assert dd_sqrt((0.0, 0.0)) == (0.0, 0.0)
    for a, _ in pairs(4):
        a = a if a[0] > 0.0 else (-a[0], -a[1])
        found = exact(dd_sqrt(a))
        assert abs(found * found - exact(a)) <= 4 * E * exact(a)


def test_products_of_vectors() -> None:
    """Relative to the sum of the absolute products, because each product may be much larger than their sum."""
    found = iter(pairs(5))
    for (ax, bx), (ay, by), (az, bz) in zip(found, found, found, strict=True):
        a, b = [exact(x) for x in (ax, ay, az)], [exact(x) for x in (bx, by, bz)]
        most = max(map(abs, a)) * max(map(abs, b))
        true = sum(x * y for x, y in zip(a, b, strict=True))
        assert abs(exact(dd_dot((ax, ay, az), (bx, by, bz))) - true) <= 16 * E * most
        for k, one in enumerate(dd_cross((ax, ay, az), (bx, by, bz))):
            i, j = (k + 1) % 3, (k + 2) % 3
            assert abs(exact(one) - (a[i] * b[j] - a[j] * b[i])) <= 16 * E * most

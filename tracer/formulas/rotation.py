"""Rotations about the axes, and the placement of points by them, in double-double: a placed point has one rounding.

The rotation's sines and cosines are summed up in exact arithmetic (Taylor's series of the angle less a multiple of 90
degrees), so they have all digits of a double-double.
"""

from fractions import Fraction
from typing import Any

import numpy as np

from tracer.formulas.double_double import DD, two_product, two_sum
from tracer.formulas.vector import Vector

PI = Fraction("3.14159265358979323846264338327950288419716939937510")
BITS = 160  # after the binary point, in the sums

Matrix = list[list[Fraction]]


def cosine_and_sine(degrees: float) -> tuple[Fraction, Fraction]:
    """Of any angle, to about 2^-BITS. Exact for multiples of 90 degrees."""
    quarters = round(Fraction(degrees) / 90)
    one = 1 << BITS
    x = int((Fraction(degrees) - 90 * quarters) * PI / 180 * one)
    sums, term, k = [0, 0], one, 0
    while term:
        sums[k % 2] += term if k % 4 < 2 else -term
        k += 1
        term = term * x // one // k if term * x >= 0 else -(-term * x // one // k)
    c, s = Fraction(sums[0], one), Fraction(sums[1], one)
    for _ in range(quarters % 4):
        c, s = -s, c
    return c, s


def rotation(degrees: Vector) -> Matrix:
    """The matrix that rotates about x, then y, then z."""
    turn = [[Fraction(int(i == j)) for j in range(3)] for i in range(3)]
    for axis, angle in enumerate(degrees):
        c, s = cosine_and_sine(angle)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        row_i = [c * a - s * b for a, b in zip(turn[i], turn[j], strict=True)]
        row_j = [s * a + c * b for a, b in zip(turn[i], turn[j], strict=True)]
        turn[i], turn[j] = row_i, row_j
    return turn


def rotation_matrix(degrees: Vector) -> np.ndarray:
    """`rotation` (3, 3), each number rounded once."""
    return np.array([[float(x) for x in row] for row in rotation(degrees)])


def placed(points: np.ndarray, factor: float, degrees: Vector, move: Vector) -> np.ndarray:
    """Points (n, 3) that are scaled, rotated and moved: each coordinate is rounded once."""
    columns = points.T
    result = np.empty(points.shape)
    for k, row in enumerate(rotation(degrees)):
        terms = [(as_dd(Fraction(factor) * x), column) for x, column in zip(row, columns, strict=True) if x]
        exact: list[Any] = [move[k]]
        low: Any = 0.0
        for (high_part, low_part), column in terms:
            product, error = two_product(high_part, column)
            exact.append(product)
            low = low + (error + low_part * column)
        total = exact[0]
        for number in exact[1:]:
            total, error = two_sum(total, number)
            low = low + error
        result[:, k] = total + low
    return result


def as_dd(x: Fraction) -> DD:
    """A fraction as a double-double."""
    high = float(x)
    return high, float(x - Fraction(high))

"""Vectors as tuples of three numbers: points, directions and linear RGB colours.

Tuples live in registers once compiled, cost no allocation, and cannot be changed behind a reader's back.
Sums are written out so that turning every sign of one axis turns just that sign of the result:
a mirrored scene is traced into the mirrored tree, bit for bit.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tracer.compile.jit import inlined

Vector = tuple[float, float, float]
VectorLike = Sequence[float] | np.ndarray  # three numbers, as a person may hand them over


@inlined
def vector(row: Any) -> Vector:
    """The three numbers of a row of an array, a list or a tuple."""
    return (row[0], row[1], row[2])


def as_floats(a: VectorLike) -> Vector:
    """Three numbers of any kind as Python's own."""
    return (float(a[0]), float(a[1]), float(a[2]))


@inlined
def store(row: Any, a: Vector) -> None:
    """Write a vector into a row of an array."""
    row[0] = a[0]
    row[1] = a[1]
    row[2] = a[2]


@inlined
def add(a: Vector, b: Vector) -> Vector:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@inlined
def subtract(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@inlined
def scale(s: float, a: Vector) -> Vector:
    return (s * a[0], s * a[1], s * a[2])


@inlined
def multiply(a: Vector, b: Vector) -> Vector:
    """Component by component: light filtered by a colour."""
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


@inlined
def negate(a: Vector) -> Vector:
    return (-a[0], -a[1], -a[2])


@inlined
def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@inlined
def length(a: Vector) -> float:
    return math.sqrt(dot(a, a))


@inlined
def unit(a: Vector) -> Vector:
    """The vector of length 1 in the direction of `a`, whose length must be above 0."""
    size = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / size, a[1] / size, a[2] / size)


@inlined
def renormalize(a: Vector) -> Vector:
    """A vector whose length is 1 but for rounding, with less of it: a step of Newton's for 1/sqrt, which needs no root.

    What has length 1 to the last digit stays as it is, so a direction that only changes signs keeps its digits.
    """
    return scale(1.5 - 0.5 * dot(a, a), a)


def rescale(a: VectorLike) -> Vector:
    """A vector of any size but 0 times a power of two that makes its largest component about 1.

    So no square of it overflows or vanishes, and not a digit changes.
    """
    _, exponent = math.frexp(max(abs(float(component)) for component in a))
    x, y, z = (math.ldexp(float(component), -exponent) for component in a)
    return (x, y, z)


@inlined
def max_component(a: Vector) -> float:
    """The largest component: how much a colour can matter at most."""
    return max(a[0], max(a[1], a[2]))

"""Vectors as tuples of three floats: points, directions and linear RGB colours.

Compiled, tuples live in registers and cost no allocation; they are immutable. Sums are written out so that flipping
the sign of one axis flips just that component of the result: a mirrored scene is traced into the mirrored tree, bit
for bit.
"""

import math
from collections.abc import Sequence

import numpy as np

from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Numbers

Vector = tuple[float, float, float]
# Squares of lengths between these neither underflow nor overflow.
SHORTEST, LONGEST = 1e-140, 1e140

VectorLike = Sequence[float] | np.ndarray  # three numbers, as users pass them


@inlined
def vector(row: VectorLike) -> Vector:
    """The three numbers of an array row, a list or a tuple, as a vector."""
    return (row[0], row[1], row[2])


def as_floats(a: VectorLike) -> Vector:
    """Three numbers of any type as Python floats."""
    return (float(a[0]), float(a[1]), float(a[2]))


@inlined
def store(row: Numbers, a: Vector) -> None:
    """Write a vector into an array row."""
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
    """Component-wise product: light filtered by a colour."""
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
    """The unit vector in the direction of `a`, which must not be 0."""
    size = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / size, a[1] / size, a[2] / size)


@compiled
def near_one(a: Vector) -> tuple[Vector, int]:
    """(vector, exponent): a is the vector times 2^exponent, and its largest component is about 1.

    No square of it overflows or underflows, and no digit changes. 0 stays 0.
    """
    noinline()
    _, exponent = math.frexp(max(abs(a[0]), max(abs(a[1]), abs(a[2]))))
    return ((math.ldexp(a[0], -exponent), math.ldexp(a[1], -exponent), math.ldexp(a[2], -exponent)), exponent)


@inlined
def renormalize(a: Vector) -> Vector:
    """One Newton step towards length 1, for a vector that is a unit vector up to rounding. Needs no square root.

    A vector whose length is exactly 1 stays as it is, so a direction whose signs were flipped keeps its digits.
    """
    return scale(1.5 - 0.5 * dot(a, a), a)


def rescale(a: VectorLike) -> Vector:
    """A vector other than 0, times the power of two that brings its largest component to about 1.

    No square of it overflows or underflows, and no digit changes.
    """
    _, exponent = math.frexp(max(abs(float(component)) for component in a))
    x, y, z = (math.ldexp(float(component), -exponent) for component in a)
    return (x, y, z)


@inlined
def max_component(a: Vector) -> float:
    """The largest component. Rays are cut and ordered by that of their weight."""
    return max(a[0], max(a[1], a[2]))

"""Random numbers for the families: sizes over many decades, directions, rotations, and eyes around them."""

import math
import random
from collections.abc import Sequence

from tracer.formulas.vector import Vector, cross, scale


class Draws(random.Random):
    """A generator with a fixed seed, so that a family has the same draws on every machine."""

    def size(self, low: float, high: float) -> float:
        """A number between 10^low and 10^high, each decade equally likely."""
        return 10.0 ** self.uniform(low, high)

    def direction(self) -> Vector:
        x, y, z = (self.gauss(0.0, 1.0) for _ in range(3))
        size = math.hypot(x, y, z)
        return (x / size, y / size, z / size)

    def frame(self) -> tuple[Vector, Vector, Vector]:
        """A random rotation: three orthonormal vectors, right up to rounding."""
        u = self.direction()
        v = perpendicular(u, self.direction())
        return (u, v, cross(u, v))

    def place(self, size: float) -> Vector:
        """A point in a random direction, at a distance of the given size."""
        return scale(size, self.direction())


def plus(*all: Sequence[float]) -> Vector:
    x, y, z = (math.fsum(column) for column in zip(*all, strict=True))
    return (x, y, z)


def perpendicular(u: Sequence[float], v: Sequence[float]) -> Vector:
    """The unit vector along the part of v that is perpendicular to the unit vector u."""
    k = math.fsum(x * y for x, y in zip(u, v, strict=True))
    x, y, z = (b - k * a for a, b in zip(u, v, strict=True))
    size = math.hypot(x, y, z)
    return (x / size, y / size, z / size)

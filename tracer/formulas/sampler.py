"""Where inside a pixel its samples lie.

By default evenly, at any number of them: Sobol's first two dimensions, a (0,2)-sequence: of the first 4, 16, 64 ...
points each cell of the 2x2, 4x4, 8x8 ... grid holds one (Kollig & Keller, "Efficient Multidimensional Sampling",
Eurographics 2002). Each pixel turns over its own random bits of all points, so that neighbouring pixels do not repeat a
pattern. For comparison also at random, and jittered: one at random in each cell of a grid (Cook, ACM Trans. Graph.
5(1), 1986). Of N points the mean of something smooth is off by N^-1/2 at random, by N^-1 jittered, that of an edge by
N^-3/4 (Mitchell, SIGGRAPH 1996). Whole numbers only: the same everywhere.
"""

import math
from typing import NamedTuple

import numpy as np

from tracer.compile.jit import inlined

UNIT = 2.0**-32
LOW = np.uint64(0xFFFFFFFF)
GOLDEN = np.uint64(0x9E3779B97F4A7C15)

SAMPLERS = ("sobol", "random", "jittered")
SOBOL, RANDOM, JITTERED = range(3)


class Samples(NamedTuple):
    """Points inside each pixel: `count` from number `first` on; first = -1 is the pixel's centre alone."""

    first: int
    count: int
    sampler: int = SOBOL
    side: int = 1  # of the grid that jittered points stand in


CENTER = Samples(-1, 1)


def make_samples(count: int, sampler: str = SAMPLERS[SOBOL]) -> Samples:
    """The first `count` points of a sampler; one of Sobol's is the pixel's centre. ValueError for what can be none."""
    if sampler not in SAMPLERS:
        raise ValueError(f"sampler must be one of {', '.join(SAMPLERS)}, got {sampler!r}")
    if count < 1:
        raise ValueError(f"samples must be >= 1, got {count}")
    side = math.isqrt(count)
    if sampler == SAMPLERS[JITTERED] and side * side != count:
        raise ValueError(f"jittered samples must be a square number like {side * side or 1}, got {count}")
    if count == 1 and sampler == SAMPLERS[SOBOL]:
        return CENTER
    return Samples(0, count, SAMPLERS.index(sampler), side)


@inlined
def pixel_hash(x: int, y: int) -> np.uint64:
    """64 mixed bits of a pixel (Steele, Lea & Flood, "Fast Splittable Pseudorandom Number Generators", 2014)."""
    return mix64(((np.uint64(x) << np.uint64(32)) ^ np.uint64(y)) + GOLDEN)


@inlined
def mix64(z: np.uint64) -> np.uint64:
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


@inlined
def sobol(x: int, y: int, k: int) -> tuple[float, float]:
    """The k-th point of pixel (x, y) that fills the square evenly."""
    first, second = np.uint64(0), np.uint64(0)
    turn = np.uint64(1) << np.uint64(31)
    bit = np.uint64(1) << np.uint64(31)
    rest = np.uint64(k)
    while rest != np.uint64(0):
        if rest & np.uint64(1) != np.uint64(0):
            first ^= bit
            second ^= turn
        bit >>= np.uint64(1)
        turn ^= turn >> np.uint64(1)
        rest >>= np.uint64(1)
    mixed = pixel_hash(x, y)
    return (np.float64(first ^ (mixed & LOW)) * UNIT, np.float64(second ^ (mixed >> np.uint64(32))) * UNIT)


@inlined
def random_point(x: int, y: int, k: int) -> tuple[float, float]:
    """The k-th point of pixel (x, y), anywhere in the square."""
    mixed = mix64(pixel_hash(x, y) + np.uint64(k) * GOLDEN)
    return (np.float64(mixed & LOW) * UNIT, np.float64(mixed >> np.uint64(32)) * UNIT)


@inlined
def jittered(x: int, y: int, k: int, side: int) -> tuple[float, float]:
    """The k-th point of pixel (x, y): anywhere in the k-th cell of a grid of `side` by `side`, row by row."""
    u, v = random_point(x, y, k)
    return ((k % side + u) / side, (k // side + v) / side)


@inlined
def sample_offset(x: int, y: int, k: int, sampler: int, side: int) -> tuple[float, float]:
    """The k-th point of pixel (x, y), both coordinates in [0, 1). `side` counts for jittered points only."""
    if sampler == RANDOM:
        return random_point(x, y, k)
    if sampler == JITTERED:
        return jittered(x, y, k, side)
    return sobol(x, y, k)

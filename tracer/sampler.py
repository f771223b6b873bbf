"""Where inside a pixel its samples lie: points that fill the square evenly, at any number of them.

Sobol's first two dimensions, a (0,2)-sequence: of the first 4, 16, 64 ... points each cell of the 2x2, 4x4, 8x8 ...
grid holds one (Kollig & Keller, "Efficient Multidimensional Sampling", Eurographics 2002). Each pixel turns over its
own random bits of all points, so that neighbouring pixels do not repeat a pattern. Whole numbers only: the same
everywhere.
"""

import numpy as np

from tracer.jit import compiled

UNIT = 2.0**-32


@compiled
def hashed(x: int, y: int) -> np.uint64:
    """64 mixed bits of a pixel (Steele, Lea & Flood, "Fast Splittable Pseudorandom Number Generators", 2014)."""
    z = (np.uint64(x) << np.uint64(32)) ^ np.uint64(y)
    z = (z + np.uint64(0x9E3779B97F4A7C15)) & np.uint64(0xFFFFFFFFFFFFFFFF)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


@compiled
def sample_offset(x: int, y: int, k: int) -> tuple[float, float]:
    """The k-th point of pixel (x, y), both coordinates in [0, 1)."""
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
    mixed = hashed(x, y)
    low = np.uint64(0xFFFFFFFF)
    return (np.float64(first ^ (mixed & low)) * UNIT, np.float64(second ^ (mixed >> np.uint64(32))) * UNIT)

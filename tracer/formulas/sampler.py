"""Sample points inside a pixel.

The default is Sobol's sequence in its first two dimensions, a (0,2)-sequence: of the first 4, 16, 64 ... points,
each cell of a 2x2, 4x4, 8x8 ... grid holds exactly one (Kollig & Keller, "Efficient Multidimensional Sampling",
Eurographics 2002). Each pixel scrambles it by an XOR with its own random bits, so that neighbouring pixels do not
repeat a pattern.

For comparison there are independent random points, and jittered ones: one random point in each cell of a grid (Cook,
ACM Trans. Graph. 5(1), 1986). The error of a mean of N samples falls as N^-1/2 for random points, as N^-1 for
jittered ones on smooth pixels, and as N^-3/4 for both Sobol and jittered points at edges (Mitchell, SIGGRAPH 1996).

All points come from integer arithmetic, so they are the same on every machine.
"""

import math
from typing import NamedTuple

import numpy as np

from tracer.choices import JITTERED, RANDOM, SAMPLERS, SOBOL
from tracer.compile.jit import inlined

UNIT = 2.0**-32
LOW = np.uint64(0xFFFFFFFF)
GOLDEN = np.uint64(0x9E3779B97F4A7C15)


class Sampler(NamedTuple):
    """The placement of a pixel's sample points."""

    kind: int  # as SAMPLERS numbers them, or CENTER
    side: int = 1  # cells along a side of the jittered grid


class Samples(NamedTuple):
    """Sample points of a pixel: `count` of them, from number `first` on."""

    first: int
    count: int
    sampler: Sampler


CENTER = -1  # a `kind`: the pixel's centre only
PIXEL_CENTER = Samples(0, 1, Sampler(CENTER))


def make_sampler(name: str, count: int) -> Sampler:
    """The sampler of this name, for `count` points of a pixel.

    ValueError for an unknown name, a count below 1, or a count of jittered points that is not a square number.
    """
    if name not in SAMPLERS:
        raise ValueError(f"sampler must be one of {', '.join(SAMPLERS)}, got {name!r}")
    if count < 1:
        raise ValueError(f"samples must be >= 1, got {count}")
    side = math.isqrt(count)
    if name == SAMPLERS[JITTERED] and side * side != count:
        raise ValueError(f"jittered samples must be a square number like {side * side or 1}, got {count}")
    return Sampler(SAMPLERS.index(name), side)


def make_samples(count: int, name: str = SAMPLERS[SOBOL]) -> Samples:
    """The first `count` points of a sampler. One Sobol point is the pixel's centre. ValueError as in `make_sampler`."""
    sampler = make_sampler(name, count)
    return PIXEL_CENTER if count == 1 and sampler.kind == SOBOL else Samples(0, count, sampler)


def sample_number(count: int, asked: int | None = None) -> int | None:
    """The `sample` of `tracer.trace` for sample `asked`, by default the first, of a pixel with `count` samples: None,
    the pixel's centre, if there is one. ValueError if there is no such sample.
    """
    if asked is not None and not 0 <= asked < count:
        raise ValueError(f"sample must be within 0 .. {count - 1} (the scene has samples = {count}), got {asked}")
    return None if count == 1 else asked or 0


def image_point(x: int, y: int, k: int, sampler: Sampler) -> tuple[float, float]:
    """The k-th sample point of pixel (x, y), in pixels from the top left corner of the image."""
    if sampler.kind == CENTER:
        return (x + 0.5, y + 0.5)
    with np.errstate(over="ignore"):  # random bits: products wrap
        dx, dy = sample_offset(x, y, k, sampler)
    return (x + float(dx), y + float(dy))


def image_points(x: int, y: int, samples: Samples) -> list[tuple[float, float]]:
    """All sample points of pixel (x, y), in pixels from the top left corner of the image."""
    numbers = range(samples.first, samples.first + samples.count)
    return [image_point(x, y, k, samples.sampler) for k in numbers]


@inlined
def pixel_hash(x: int, y: int) -> np.uint64:
    """64 random bits for a pixel (Steele, Lea & Flood, "Fast Splittable Pseudorandom Number Generators", 2014)."""
    return mix64(((np.uint64(x) << np.uint64(32)) ^ np.uint64(y)) + GOLDEN)


@inlined
def mix64(z: np.uint64) -> np.uint64:
    """Mix the bits of a number (the finalizer of SplitMix64)."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


@inlined
def sobol(x: int, y: int, k: int) -> tuple[float, float]:
    """The k-th point of the scrambled Sobol sequence of pixel (x, y)."""
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
    """The k-th independent random point of pixel (x, y)."""
    mixed = mix64(pixel_hash(x, y) + np.uint64(k) * GOLDEN)
    return (np.float64(mixed & LOW) * UNIT, np.float64(mixed >> np.uint64(32)) * UNIT)


@inlined
def jittered(x: int, y: int, k: int, side: int) -> tuple[float, float]:
    """The k-th jittered point of pixel (x, y): a random point in cell k of a `side` by `side` grid, row by row."""
    u, v = random_point(x, y, k)
    return ((k % side + u) / side, (k // side + v) / side)


@inlined
def sample_offset(x: int, y: int, k: int, sampler: Sampler) -> tuple[float, float]:
    """The k-th sample point of pixel (x, y), from the pixel's top left corner; coordinates in [0, 1)."""
    if sampler.kind == RANDOM:
        return random_point(x, y, k)
    if sampler.kind == JITTERED:
        return jittered(x, y, k, sampler.side)
    return sobol(x, y, k)

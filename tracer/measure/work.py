"""The work of an image, counted in rays and intersection tests.

Sizes of images and numbers of runs follow from it. So they are the same on every machine and under every load.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from tracer.image.render import Image
from tracer.measure.timing import clocked

Size = tuple[int, int]

TESTS_PER_RAY = 8  # intersection tests that count as one ray
PROBE = 100  # pixels of the first image that is counted
ENOUGH = 100_000  # work from which on a count stands for a whole image


def work_of(image: Image) -> int:
    """Its rays, and an eighth of its intersection tests. One thread takes about 0.1 µs for each of them."""
    return sum(image.rays.values()) + image.tests // TESTS_PER_RAY


class Probe(NamedTuple):
    """A small image of a scene."""

    pixels: int
    work: int
    seconds: float  # processor time


def probed(make: Callable[[Size], Image], size: Size) -> Probe:
    """The first of images of growing size that is work enough, or has this size."""
    pixels = PROBE
    while True:
        probe = shrunk(size, pixels / (size[0] * size[1]))
        image, run = clocked(lambda probe=probe: make(probe))
        work = work_of(image)
        if work >= ENOUGH or probe == size:
            return Probe(probe[0] * probe[1], work, run.cpu)
        pixels *= 4


def affordable(make: Callable[[Size], Image], size: Size, work: float) -> Size:
    """This size, or a smaller one of the same proportions at which an image takes no more than about this work."""
    probe = probed(make, size)
    return shrunk(size, work * probe.pixels / (probe.work * size[0] * size[1]))


def shrunk(size: Size, share: float) -> Size:
    """A size with this share of the pixels, if the share is below 1."""
    factor = math.sqrt(min(1.0, share))
    return max(1, round(size[0] * factor)), max(1, round(size[1] * factor))

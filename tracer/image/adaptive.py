"""Adaptive sampling: each pixel gets as many samples as its estimated error asks for.

The samples of a pixel are doubled, again and again. The change of its mean when they are doubled estimates the error
of the mean: if the samples are independent, the root mean square of the change equals the error, since the errors of
both halves are independent. If the error falls as N^-3/4, as for low-discrepancy points at edges, the change is 1.35
times the error; if it falls as 1/N, 1.7 times. So the mean over many pixels is a conservative estimate; for one
pixel it is a single random value.

The pixels that gain most per sample are doubled next. The squared error of an edge falls as N^-3/2, so the gain is
the squared error over N. A single estimate may be small by chance, so the estimates of all doublings of a pixel are
averaged, with a weight of 0.2 for its neighbours, and at first with its contrast to them. Otherwise an edge between
two samples could be missed. (Mitchell, SIGGRAPH 1987, refines by contrast; Kirk & Arvo, SIGGRAPH 1991, show the bias
of stopping where samples agree.) A pixel with N samples equals, bit for bit, that of an image with N samples per
pixel.
"""

import math
from typing import Any

import numpy as np

from tracer.choices import JITTERED, RANDOM
from tracer.compile.jit import inlined, kernel
from tracer.compile.rows import Numbers, Rows
from tracer.formulas.vector import Vector, scale, vector
from tracer.image.task import Work
from tracer.image.tiles import Tile, pixel_list
from tracer.kernel.entry import PixelRow

OWN_SHARE = 0.8  # weight of a pixel's own error in its pooled error; the rest is its neighbours'
CONTRAST_WEIGHT = 0.25  # weight of the contrast to the neighbours; a doubling has the weight 1
GROWTH = 0.2  # smallest number of samples that a round adds, relative to all samples so far
RESTART_FACTOR = 5.0  # if 4 N new samples replace N: lower bound of the squared change over the new squared error
RANKS = 4 * 2400  # ranks of gains, a quarter of an octave each: the whole range of a double
QUARTERS = (2.0**-0.75, 2.0**-0.5, 2.0**-0.25)


class PixelStatistics:
    """The sums and estimated errors of the pixels of an image in progress. Arrays are (height, width, ...)."""

    def __init__(self, width: int, height: int, sampler: int, adaptive: bool) -> None:
        self.sums = np.zeros((height, width, 4))  # over the samples: red, green, blue, the weight that was cut
        self.counts = np.zeros((height, width), np.int32)
        self.wanted = self.counts.copy()  # the counts after the round in progress
        self.moved = np.full((height, width), np.nan)  # squared error, as estimated by the last doubling
        self.pooled = np.zeros((height, width, 2))  # (sum over doublings of squared error * N^power, their number)
        self.power = 1.0 if sampler == RANDOM else 1.5
        self.adaptive = adaptive
        self.restarts = sampler == JITTERED  # a finer grid shares no points with a coarser one

    def means(self) -> np.ndarray:
        """The colours, linear RGB. Every pixel must have a sample."""
        return self.sums[..., :3] / self.counts[..., None]

    @property
    def error(self) -> float:
        """Estimated root mean square error over pixels and components; NaN until every pixel has been doubled.

        With random samples, stopping where the last estimate is small by chance would bias the result, so all
        estimates are used.
        """
        if self.adaptive and self.power == 1.0 and self.counts.min() > 1:
            return math.sqrt(float((self.errors() ** 2).mean()))
        return math.sqrt(float(self.moved.mean()))

    def errors(self, part: Any = ...) -> Any:
        """The estimated error of each pixel, or of a part of them, from all doublings; NaN before the first."""
        pooled, counts = self.pooled[part], self.counts[part].astype(float)
        with np.errstate(invalid="ignore"):
            return np.sqrt(pooled[..., 0] / pooled[..., 1] / counts**self.power)

    def plan_round(self, most: int) -> bool:
        """Set `wanted` for another round, with at most `most` samples of a pixel. False if there is nothing to gain."""
        have = self.counts
        if have.min() == 0:
            wanted = np.maximum(have, 1)
        elif self.adaptive and have.min() > 1:
            wanted = np.where(self._worthwhile(most), 2 * have, have)
        else:
            wanted = np.where(have == have.min(), (4 if self.restarts else 2) * have, have)
            wanted = np.where(wanted > most, have, wanted)
        self.wanted = wanted.astype(np.int32)
        return bool((wanted != have).any())

    def works(self, tiles: list[Tile]) -> list[Work]:
        """The tiles in which some pixel gets more samples in this round."""
        return [self._work(tile) for tile in tiles if (self.wanted[tile.part] > self.counts[tile.part]).any()]

    def _work(self, tile: Tile) -> Work:
        have, wanted, before = self.counts[tile.part], self.wanted[tile.part], self.sums[tile.part]
        if self.restarts:
            have, before = np.where(wanted > have, 0, have), np.zeros_like(before)
        return Work(tile, have, wanted, before)

    def update(self, tile: Tile, sums: np.ndarray) -> None:
        """Store the new sums (n, 4) of a tile's pixels, in the order of its list."""
        work = self._work(tile)
        pixels = pixel_list(tile, work.first, work.end)
        factor = RESTART_FACTOR if self.restarts else 1.0
        update_statistics(pixels, sums, factor, self.power, self.sums, self.counts, self.moved, self.pooled)

    def _worthwhile(self, most: int) -> np.ndarray:
        """The pixels that gain most per sample, so many that they add GROWTH to the samples so far."""
        if self.pooled[..., 1].max() == 1.0:
            add_contrast(self.sums, self.counts, self.power, self.pooled)
        ranks = np.zeros(self.counts.shape, np.int32)
        spent = np.zeros(RANKS, np.int64)
        rank_gains(self.counts, self.pooled, self.power, most, ranks, spent)
        adds = spent[::-1].cumsum()
        last = int(np.searchsorted(adds, min(GROWTH * self.counts.sum(), adds[-1])))
        return ranks >= max(RANKS - 1 - last, 1)


@kernel
def update_statistics(
    pixels: Rows[PixelRow],
    new: Numbers,
    factor: float,
    power: float,
    sums: Numbers,
    counts: Numbers,
    moved: Numbers,
    pooled: Numbers,
) -> None:
    """`PixelStatistics.update`: update each pixel's sums and the squared change of its mean."""
    for k in range(len(pixels)):
        x, y, count, have = pixels[k].x, pixels[k].y, pixels[k].end, counts[pixels[k].y, pixels[k].x]
        if have > 0:
            square = mean_square_difference(mean_color(new[k], count), mean_color(sums[y, x], have)) / factor
            moved[y, x] = square
            pooled[y, x, 0] += square * count_power(count, power)
            pooled[y, x, 1] += 1.0
        for part in range(4):
            sums[y, x, part] = new[k, part]
        counts[y, x] = count


@kernel
def add_contrast(sums: Numbers, counts: Numbers, power: float, pooled: Numbers) -> None:
    """Add half the mean squared difference from the eight neighbours to the pooled error. It is the variance if all
    have the same distribution.
    """
    height, width = counts.shape
    for y in range(height):
        for x in range(width):
            here, total = mean_color(sums[y, x], counts[y, x]), 0.0
            for j in range(max(y - 1, 0), min(y + 2, height)):
                for i in range(max(x - 1, 0), min(x + 2, width)):
                    total += mean_square_difference(mean_color(sums[j, i], counts[j, i]), here)
            pooled[y, x, 0] += CONTRAST_WEIGHT * (total / 16.0) * count_power(counts[y, x], power)
            pooled[y, x, 1] += CONTRAST_WEIGHT


@kernel
def rank_gains(counts: Numbers, pooled: Numbers, power: float, most: int, ranks: Numbers, spent: Numbers) -> None:
    """Rank each pixel by its gain per sample, 0 for none. `spent` counts the samples that double the pixels of a rank.

    The gain is the squared error, the pixel's own and its neighbours', over N.
    """
    height, width = counts.shape
    for y in range(height):
        for x in range(width):
            count = counts[y, x]
            if 2 * count > most:
                continue
            own, around, some = pooled[y, x, 0] / pooled[y, x, 1], 0.0, -1
            for j in range(max(y - 1, 0), min(y + 2, height)):
                for i in range(max(x - 1, 0), min(x + 2, width)):
                    around += pooled[j, i, 0] / pooled[j, i, 1]
                    some += 1
            around = (around - own) / some if some > 0 else own
            gain = (OWN_SHARE * own + (1.0 - OWN_SHARE) * max(around, 0.0)) / (count_power(count, power) * count)
            if 0.0 < gain < math.inf:
                part, octave = math.frexp(gain)
                quarter = (1 if part >= QUARTERS[0] else 0) + (1 if part >= QUARTERS[1] else 0)
                quarter += 1 if part >= QUARTERS[2] else 0
                ranks[y, x] = 4 * (octave + 1200) + quarter
                spent[ranks[y, x]] += count


@inlined
def count_power(count: int, power: float) -> float:
    """N or N^3/2: squared errors fall as one over this."""
    return count * math.sqrt(count) if power > 1.0 else 1.0 * count


@inlined
def mean_color(sums: Numbers, count: int) -> Vector:
    """The mean colour of `count` samples with these sums."""
    return scale(1.0 / count, vector(sums))


@inlined
def mean_square_difference(a: Vector, b: Vector) -> float:
    """The mean over the components of the squared difference."""
    return ((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2) / 3.0

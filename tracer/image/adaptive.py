"""Samples where they are worth their time: each pixel gets as many as its own error asks for.

A pixel's samples are doubled, again and again. How far its mean moves the last time says how far it still is from the
truth: as far, in the root of the mean square, if the samples lie at random, for then both halves are off independently;
1.35 times as far if the error falls as N^-3/4, as even points have it at edges; 1.7 times if it falls as 1/N. So the
estimate is on the safe side as a mean over many pixels; of one pixel it is a single draw.

The next to be doubled are those that gain most by a sample. An edge's square error falls as N^-3/2, so that is its
square error over N. One draw would do as a measure of it only until one is small by chance: it is pooled over all
doublings of the pixel, with a fifth of its neighbours' in it, and at first with its contrast to them, lest an edge pass
unseen between two samples (Mitchell, SIGGRAPH 1987, refines by contrast; Kirk & Arvo, SIGGRAPH 1991, on the bias of
stopping where samples agree). A pixel that has N samples has the very bits of an image of N samples a pixel.
"""

import math
from typing import Any

import numpy as np

from tracer.compile.jit import inlined, kernel
from tracer.formulas.sampler import JITTERED, RANDOM
from tracer.formulas.vector import Vector, scale, vector
from tracer.kernel.entry import Area, Begun

OWN_SHARE = 0.8  # of a pixel's measure that is its own; the rest is its neighbours'
CONTRAST_WEIGHT = 0.25  # of a doubling, that the contrast to its neighbours counts as
GROWTH = 0.2  # of all samples so far, that a round adds at least where there is a choice
RESTART_FACTOR = (
    5.0  # by how much more than its own square error a mean of 4 N new samples differs from that of N, at least
)
RANKS = 4 * 2400  # steps of a quarter of an octave, which gains are told apart by: all that a double can be
FLAT, MIDDLE, STEEP = 2.0**-0.75, 2.0**-0.5, 2.0**-0.25


class PixelStatistics:
    """The pixels of an image in the making, and what is known of their errors. Arrays are (height, width, ...)."""

    def __init__(self, width: int, height: int, sampler: int, adaptive: bool) -> None:
        self.sums = np.zeros((height, width, 4))  # over the samples: red, green, blue, the weight that was cut
        self.counts = np.zeros((height, width), np.int32)
        self.moved = np.full((height, width), np.nan)  # the square error as the last doubling has it
        self.spread = np.zeros((height, width, 2))  # that times N^power, summed over doublings; and how many these are
        self.power = 1.0 if sampler == RANDOM else 1.5
        self.adaptive = adaptive
        self.renews = sampler == JITTERED  # points on a finer grid are all new ones
        self.nothing = np.zeros_like(self.sums) if self.renews else self.sums

    def means(self) -> np.ndarray:
        """Red, green, blue; every pixel must have a sample."""
        return self.sums[..., :3] / self.counts[..., None]

    @property
    def error(self) -> float:
        """Root mean square over pixels and components; NaN where some pixel has not been doubled yet.

        Random samples leave no margin for stopping where the last draw was small by chance: all draws count then.
        """
        if self.adaptive and self.power == 1.0 and self.counts.min() > 1:
            return math.sqrt(float((self.errors() ** 2).mean()))
        return math.sqrt(float(self.moved.mean()))

    def errors(self, part: Any = ...) -> Any:
        """Each pixel's, or those of a part, estimated from all its doublings; NaN before the first."""
        spread, counts = self.spread[part], self.counts[part].astype(float)
        with np.errstate(invalid="ignore"):
            return np.sqrt(spread[..., 0] / spread[..., 1] / counts**self.power)

    def next(self, most: int) -> Begun | None:
        """What each pixel is to have after another round, no more than `most`; None where nothing is to be gained."""
        have = self.counts
        if have.min() == 0:
            want = np.maximum(have, 1)
        elif self.adaptive and have.min() > 1:
            want = np.where(self._worthwhile(most), 2 * have, have)
        else:
            want = np.where(have == have.min(), (4 if self.renews else 2) * have, have)
            want = np.where(want > most, have, want)
        if (want == have).all():
            return None
        begin = np.where(want > have, 0, have) if self.renews else have
        return Begun(self.nothing, np.stack((begin, want), -1).astype(np.int32))

    def take_in(self, area: Area, plan: np.ndarray, sums: np.ndarray) -> None:
        """The new sums of an area whose samples went by this plan."""
        again = RESTART_FACTOR if self.renews else 1.0
        update_statistics(area, plan, sums, again, self.power, self.sums, self.counts, self.moved, self.spread)

    def _worthwhile(self, most: int) -> np.ndarray:
        """Pixels that gain most by a sample, as many as add GROWTH to the samples so far."""
        if self.spread[..., 1].max() == 1.0:
            add_contrast(self.sums, self.counts, self.power, self.spread)
        ranks = np.zeros(self.counts.shape, np.int32)
        spent = np.zeros(RANKS, np.int64)
        rank_gains(self.counts, self.spread, self.power, most, ranks, spent)
        adds = spent[::-1].cumsum()
        last = int(np.searchsorted(adds, min(GROWTH * self.counts.sum(), adds[-1])))
        return ranks >= max(RANKS - 1 - last, 1)


@kernel
def update_statistics(
    area: Area, plan: Any, new: Any, again: float, power: float, sums: Any, counts: Any, moved: Any, spread: Any
) -> None:
    """`Sampled.take_in`: each pixel's sums and how far its mean has moved."""
    for y in range(area.top, area.bottom):
        for x in range(area.left, area.right):
            want, have = plan[y, x, 1], counts[y, x]
            if want <= plan[y, x, 0]:
                continue
            if have > 0:
                square = mean_square_difference(mean_color(new[y, x], want), mean_color(sums[y, x], have)) / again
                moved[y, x] = square
                spread[y, x, 0] += square * count_power(want, power)
                spread[y, x, 1] += 1.0
            for k in range(4):
                sums[y, x, k] = new[y, x, k]
            counts[y, x] = want


@kernel
def add_contrast(sums: Any, counts: Any, power: float, spread: Any) -> None:
    """Half the mean square difference from the eight neighbours: their variance, were all alike."""
    height, width = counts.shape
    for y in range(height):
        for x in range(width):
            here, total = mean_color(sums[y, x], counts[y, x]), 0.0
            for j in range(max(y - 1, 0), min(y + 2, height)):
                for i in range(max(x - 1, 0), min(x + 2, width)):
                    total += mean_square_difference(mean_color(sums[j, i], counts[j, i]), here)
            spread[y, x, 0] += CONTRAST_WEIGHT * (total / 16.0) * count_power(counts[y, x], power)
            spread[y, x, 1] += CONTRAST_WEIGHT


@kernel
def rank_gains(counts: Any, spread: Any, power: float, most: int, ranks: Any, spent: Any) -> None:
    """Each pixel's gain by a sample on a scale of octaves, 0 for none; of each rank, the samples to double its pixels.

    Square error over N, where the error is the pixel's own and its neighbours'.
    """
    height, width = counts.shape
    for y in range(height):
        for x in range(width):
            count = counts[y, x]
            if 2 * count > most:
                continue
            own, around, some = spread[y, x, 0] / spread[y, x, 1], 0.0, -1
            for j in range(max(y - 1, 0), min(y + 2, height)):
                for i in range(max(x - 1, 0), min(x + 2, width)):
                    around += spread[j, i, 0] / spread[j, i, 1]
                    some += 1
            around = (around - own) / some if some > 0 else own
            gain = (OWN_SHARE * own + (1.0 - OWN_SHARE) * max(around, 0.0)) / (count_power(count, power) * count)
            if 0.0 < gain < math.inf:
                part, octave = math.frexp(gain)
                step = (1 if part >= FLAT else 0) + (1 if part >= MIDDLE else 0) + (1 if part >= STEEP else 0)
                ranks[y, x] = 4 * (octave + 1200) + step
                spent[ranks[y, x]] += count


@inlined
def count_power(count: int, power: float) -> float:
    """N or N^3/2: what square errors fall with."""
    return count * math.sqrt(count) if power > 1.0 else 1.0 * count


@inlined
def mean_color(sums: Any, count: int) -> Vector:
    return scale(1.0 / count, vector(sums))


@inlined
def mean_square_difference(a: Vector, b: Vector) -> float:
    """Mean square over the components."""
    return ((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2) / 3.0


def unfinished_tiles(areas: list[Area], plan: np.ndarray) -> list[Area]:
    """Those in which some pixel is to have more samples."""
    more = plan[..., 1] > plan[..., 0]
    return [area for area in areas if more[area.top : area.bottom, area.left : area.right].any()]

"""Paired timing: two ways to do a thing, run in turn, so that other load on the machine falls on both.

The result is the median of the pairs' differences. Its uncertainty is half their interquartile range. Both are
robust against a few slow runs on a busy machine.
"""

import math
import statistics
from collections.abc import Callable
from dataclasses import dataclass

from tracer.measure.timing import quartiles
from tracer.progress import Progress, ignore


@dataclass(frozen=True)
class PairedTimes:
    """Medians, in seconds."""

    without: float
    extra: float  # additional time of the other variant
    uncertainty: float  # of `extra`
    pairs: int

    @property
    def ratio(self) -> float:
        """The time with it over the time without."""
        return 1.0 + self.extra / self.without if self.without > 0.0 else math.inf

    @property
    def is_significant(self) -> bool:
        """Whether the difference is larger than its uncertainty."""
        return abs(self.extra) > self.uncertainty


def paired(
    without: Callable[[], float], with_it: Callable[[], float], pairs: int, progress: Progress = ignore
) -> PairedTimes:
    """Run both in turn, so many times each, and swap their order from pair to pair. Each returns its seconds."""
    first: list[float] = []
    more: list[float] = []
    for pair in range(pairs):
        if pair % 2:
            b, a = with_it(), without()
        else:
            a, b = without(), with_it()
        first.append(a)
        more.append(b - a)
        progress((pair + 1) / pairs)
    low, middle, high = quartiles(more)
    return PairedTimes(statistics.median(first), middle, 0.5 * (high - low), pairs)

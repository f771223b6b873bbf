"""Paired timing: two ways to do a thing, run in turn, so that other load on the machine falls on both.

The result is the median of the pairs' differences. Its uncertainty is half their interquartile range. Both are
robust against a few slow runs on a busy machine.
"""

import math
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

FEWEST, MOST = 3, 25  # pairs


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


def paired(without: Callable[[], float], with_it: Callable[[], float], budget: float) -> PairedTimes:
    """Run both in turn for about `budget` seconds, and swap their order from pair to pair. Each returns its seconds."""
    began = time.perf_counter()
    first: list[float] = []
    more: list[float] = []
    while len(first) < FEWEST or (len(first) < MOST and time.perf_counter() - began < budget):
        if len(first) % 2:
            b, a = with_it(), without()
        else:
            a, b = without(), with_it()
        first.append(a)
        more.append(b - a)
    low, middle, high = statistics.quantiles(more, n=4)
    return PairedTimes(statistics.median(first), middle, 0.5 * (high - low), len(first))


def cpu_seconds(act: Callable[[], object]) -> float:
    """The processor time of a call, without that of other programs."""
    began = time.process_time()
    act()
    return time.process_time() - began

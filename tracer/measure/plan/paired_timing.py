"""Two ways to do a thing, timed in turn: whatever else the machine does meanwhile falls on both.

The difference is the median of the pairs' differences, and its doubt half the width of the middle half of them: what
a busy machine adds to some runs moves neither.
"""

import math
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

FEWEST, MOST = 3, 25  # pairs


@dataclass(frozen=True)
class PairedTimes:
    """Seconds, medians."""

    without: float
    extra: float  # what the other way takes more
    doubt: float  # of `extra`
    pairs: int

    @property
    def ratio(self) -> float:
        """How many times as long it takes with it."""
        return 1.0 + self.extra / self.without if self.without > 0.0 else math.inf

    @property
    def tells(self) -> bool:
        """Whether the difference is more than its doubt."""
        return abs(self.extra) > self.doubt


def paired(without: Callable[[], float], with_it: Callable[[], float], budget: float) -> PairedTimes:
    """Run both in turn, the first one first in every other pair, for some `budget` seconds. Each tells its seconds."""
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
    """Seconds of processor time: what other programs take meanwhile is none of it."""
    began = time.process_time()
    act()
    return time.process_time() - began


def wall_seconds(act: Callable[[], object]) -> float:
    """Seconds by the clock: where something else than this processor works, too."""
    began = time.perf_counter()
    act()
    return time.perf_counter() - began

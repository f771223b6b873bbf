"""Timing: the runs of several calls take turns, and each call's time is the median of its runs, with its quartiles.

Wall time is what a user waits for. Processor time is what the call needed. A call that computes on one thread needs as
much of one as of the other, unless other programs had the processor: then its wall time says little about the call.
"""

import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

T = TypeVar("T")

NOTABLE = 0.1  # share of the wall time without a processor from which on a machine is called busy
WAKING = 2.5e-4  # seconds that a thread may take to wake up on an idle machine
RESOLUTION = time.get_clock_info("process_time").resolution  # seconds


@dataclass(frozen=True)
class Run:
    """One run of a call, in seconds."""

    wall: float
    cpu: float  # processor time of all threads of this process


def clocked(act: Callable[[], T]) -> tuple[T, Run]:
    """What a call returns, and its times."""
    began, used = time.perf_counter(), time.process_time()
    result = act()
    return result, Run(time.perf_counter() - began, time.process_time() - used)


@dataclass(frozen=True)
class Times:
    """The times of several runs of a call on one thread, in seconds."""

    runs: int
    seconds: float  # wall time: the median
    lower: float  # wall time: the quartiles
    upper: float
    cpu_seconds: float  # processor time: the median

    @staticmethod
    def of(runs: Sequence[Run]) -> "Times":
        lower, middle, upper = quartiles([run.wall for run in runs])
        return Times(len(runs), middle, lower, upper, statistics.median(run.cpu for run in runs))

    @property
    def waited(self) -> float:
        """The share of the wall time in which the thread had no processor."""
        return max(0.0, 1.0 - self.cpu_seconds / self.seconds) if self.seconds > 0.0 else 0.0

    @property
    def is_busy(self) -> bool:
        """Whether wall time and processor time differ by more than on an idle machine."""
        allowed = NOTABLE * self.seconds + max(WAKING, RESOLUTION)
        return self.seconds - self.cpu_seconds > allowed


def quartiles(values: Sequence[float]) -> tuple[float, float, float]:
    """The lower quartile, the median and the upper quartile, interpolated between the values."""
    if len(values) == 1:
        return values[0], values[0], values[0]
    lower, middle, upper = statistics.quantiles(values, n=4, method="inclusive")
    return lower, middle, upper


def turns(counts: Sequence[int]) -> Iterator[int]:
    """The order in which calls run that are to run `counts` times: their indices, in rounds of all calls.

    A call with fewer runs is left out of some rounds, evenly. So all calls run over the same period, and a load that
    comes and goes falls on all of them.
    """
    rounds = max(counts, default=0)
    for k in range(rounds):
        for call, count in enumerate(counts):
            if (k + 1) * count // rounds > k * count // rounds:
                yield call

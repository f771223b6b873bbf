"""The share of a work that is done, as a function that is called with it; and how a work is divided into parts."""

from collections.abc import Callable, Sequence
from itertools import accumulate

Progress = Callable[[float], None]  # called with the share of the expected time, from 0 to 1


def ignore(share: float) -> None:
    """The progress that nobody wants to know."""


def divided(progress: Progress, costs: Sequence[float]) -> list[Progress]:
    """The progress of each part of a work, to be done in this order.

    `costs` are the expected times of the parts, in any unit: the time left is right only if these are. If all are 0,
    the parts count as equal. After the last part `progress` is at exactly 1.
    """
    ends = list(accumulate(costs if any(costs) else [1.0] * len(costs)))
    starts = [0.0, *ends[:-1]]

    def part(start: float, end: float) -> Progress:
        return lambda share: progress((start + share * (end - start) if share < 1.0 else end) / ends[-1])

    return [part(start, end) for start, end in zip(starts, ends, strict=True)]

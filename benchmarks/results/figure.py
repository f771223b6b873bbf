"""A measured figure: the median with the lowest and the highest run, and its target."""

import dataclasses
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Spread:
    """Several runs of one measurement."""

    median: float
    low: float
    high: float
    runs: int = 1

    @staticmethod
    def of(values: Sequence[float]) -> "Spread":
        return Spread(statistics.median(values), min(values), max(values), len(values))


@dataclass(frozen=True)
class Figure:
    """One row of the table. The target is one for the ratio if there is one, else for our own value."""

    part: str
    what: str
    unit: str  # of ours and theirs
    ours: Spread
    than: str = ""  # name of theirs
    theirs: Spread | None = None
    ratio: Spread | None = None
    wanted: float | None = None
    at_least: bool = True  # more is better; otherwise the target is the most allowed

    @property
    def verdict(self) -> Spread:
        return self.ratio or self.ours

    @property
    def met(self) -> bool | None:
        """None without a target."""
        if self.wanted is None:
            return None
        return self.verdict.median >= self.wanted if self.at_least else self.verdict.median <= self.wanted

    def as_dict(self) -> dict[str, Any]:
        return {**dataclasses.asdict(self), "met": self.met}

    @staticmethod
    def from_dict(row: dict[str, Any]) -> "Figure":
        fields = {key: value for key, value in row.items() if key != "met"}
        for name in ("ours", "theirs", "ratio"):
            fields[name] = Spread(**row[name]) if row[name] else None
        return Figure(**fields)


def in_turn(runs: int, *measures: Callable[[], float]) -> list[list[float]]:
    """The values of each measure in `runs` runs. A run takes all measures in turn; an extra run warms up."""
    rounds = [[measure() for measure in measures] for _ in range(runs + 1)]
    return [list(values) for values in zip(*rounds[1:], strict=True)]


def compared(
    part: str,
    what: str,
    unit: str,
    ours: Sequence[float],
    than: str,
    theirs: Sequence[float],
    *,
    faster: bool = False,
    wanted: float | None = None,
    at_least: bool = True,
) -> Figure:
    """A figure of the ratio ours over theirs, run by run; theirs over ours if it states how much `faster` ours is."""
    ratios = [b / a if faster else a / b for a, b in zip(ours, theirs, strict=True)]
    return Figure(part, what, unit, Spread.of(ours), than, Spread.of(theirs), Spread.of(ratios), wanted, at_least)

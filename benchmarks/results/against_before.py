"""Figures that became slower or faster since an earlier report.

A change counts if each median lies outside the spread of the other's runs. This holds on one machine; between
machines ratios are roughly comparable, times are not.
"""

from collections.abc import Iterator, Sequence

from benchmarks.results.figure import Figure
from benchmarks.results.report import short


def changes(before: Sequence[Figure], now: Sequence[Figure]) -> Iterator[str]:
    """A line for each figure that changed, those that became worse first, and one line for all others."""
    known = {(figure.part, figure.what): figure for figure in before}
    pairs = [(known[key], figure) for figure in now if (key := (figure.part, figure.what)) in known]
    changed = [(old, new) for old, new in pairs if is_changed(old, new)]
    for old, new in sorted(changed, key=lambda pair: not is_worse(*pair)):
        word = "worse" if is_worse(old, new) else "better"
        unit = "" if new.ratio else f" {new.unit}"
        spread = f"{short(old.verdict.low)} .. {short(old.verdict.high)}"
        yield (
            f"{word:6}  {new.part}: {new.what}: {short(new.verdict.median)}{unit}, "
            f"was {short(old.verdict.median)}{unit} ({spread})"
        )
    yield f"{len(pairs) - len(changed)} of {len(pairs)} figures are as they were"


def is_changed(old: Figure, new: Figure) -> bool:
    a, b = old.verdict, new.verdict
    return not a.low <= b.median <= a.high and not b.low <= a.median <= b.high


def is_worse(old: Figure, new: Figure) -> bool:
    fell = new.verdict.median < old.verdict.median
    return fell == new.at_least

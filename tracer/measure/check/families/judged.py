"""Readings of families: the worst distance and the honesty of its told error, and the number of wrong decisions."""

import math
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from typing import NamedTuple

from tracer.measure.check.case import Reading, U, exactly, off, worst_of

# In units of u times the distance. The distance is rounded to a double once, which costs at most one unit. All that is
# computed before may cost another.
ROUNDED_ONCE = 2.0


class Hit(NamedTuple):
    exact: Decimal
    t: float  # inf or NaN for a miss
    told: float  # the error told with the hit
    usual: float  # the textbook's distance


class Decision(NamedTuple):
    exact: bool  # it is a hit
    ours: bool
    usual: bool  # the textbook's
    margin: float  # the distance from the edge, relative to the size of what is compared


def distances(what: str, hits: Iterable[Hit]) -> Iterator[Reading]:
    """The worst distance, in units of u times the distance, and the number of hits that are farther off than told."""
    found = list(hits)
    yield worst_of(
        f"{what}: t", [Reading("", one.exact, one.t, U * float(one.exact), ROUNDED_ONCE, one.usual) for one in found]
    )
    beyond = sum(not off(one.t, one.exact) <= one.told for one in found)
    yield exactly(f"{what}: t off by more than told, of {len(found)}", 0, beyond)


def wrong_of(what: str, decisions: Sequence[Decision]) -> Reading:
    """The number of wrong decisions, with the smallest margin."""
    wrong = sum(one.exact != one.ours for one in decisions)
    usual = sum(one.exact != one.usual for one in decisions)
    least = math.log2(min(abs(one.margin) for one in decisions if one.margin))
    return exactly(f"{what}: wrong of {len(decisions)}, margins to 2^{least:.0f}", 0, wrong, usual)

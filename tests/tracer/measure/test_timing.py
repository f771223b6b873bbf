"""Times: medians and quartiles, the order of runs, and when a machine was busy. No test of time."""

from itertools import pairwise

import pytest

from tracer.measure.timing import RESOLUTION, Run, Times, quartiles, turns


@pytest.mark.parametrize("counts", [[1], [3, 3], [20, 5, 7, 20], [5, 20, 6], [4, 1]])
def test_runs_of_every_call_are_spread_over_all_rounds(counts: list[int]) -> None:
    order = list(turns(counts))
    assert [order.count(k) for k in range(len(counts))] == counts
    longest = counts.index(max(counts))
    for k, count in enumerate(counts):
        rounds = [order[:place].count(longest) for place, call in enumerate(order) if call == k]
        gaps = {b - a for a, b in pairwise(rounds)}
        assert max(gaps, default=0) - min(gaps, default=0) <= 1  # as evenly as whole rounds allow
        assert len(set(rounds)) == count  # never twice in a round


def test_quartiles() -> None:
    assert quartiles([3.0]) == (3.0, 3.0, 3.0)
    assert quartiles([5.0, 1.0, 4.0, 2.0, 3.0]) == (2.0, 3.0, 4.0)


def test_a_time_is_busy_if_the_thread_waited_for_a_processor() -> None:
    slack = max(2.5e-4, RESOLUTION)

    def times(wall: float, cpu: float) -> Times:
        return Times.of([Run(wall, cpu)] * 4 + [Run(9.0, 0.1)])  # one slow run changes no median

    assert times(1.0, 0.5).is_busy
    assert times(1.0, 0.5).waited == 0.5
    assert not times(1.0, 0.95).is_busy
    assert not times(2.0 * slack, 1.1 * slack).is_busy  # as long as a thread takes to wake up
    assert not times(1.0, 1.01).is_busy
    assert times(1.0, 1.01).waited == 0.0
    assert (times(1.0, 0.5).runs, times(1.0, 0.5).seconds, times(1.0, 0.5).cpu_seconds) == (5, 1.0, 0.5)

"""Lanes: what the processor does with eight numbers at once is what Python does with them one by one."""

import math
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tracer import lanes
from tracer.jit import kernel

number = st.one_of(st.floats(width=32), st.sampled_from([math.nan, math.inf, -math.inf, 0.0, -0.0]))
row = st.lists(number, min_size=8, max_size=8)


def every_operation(a: Any, b: Any, narrow: Any, x: float, out: Any, bits: Any) -> None:
    p, q = lanes.lanes(a), lanes.lanes(b)
    lanes.keep(lanes.larger(p, q), out[0])
    lanes.keep(lanes.smaller(p, q), out[1])
    lanes.keep(p * x - q, out[2])
    lanes.keep((p - x) * q, out[3])
    lanes.keep(lanes.lanes(narrow) * lanes.alike(x), out[4])
    bits[0] = lanes.below(p, q)
    bits[1] = lanes.no_more(p, q)
    bits[2] = lanes.first_of(bits[1] | 128)


compiled = kernel(every_operation)


@settings(max_examples=60, deadline=None)
@given(row, row, number)
def test_eight_at_once_are_eight_one_by_one(a: list[float], b: list[float], x: float) -> None:
    results = []
    with np.errstate(all="ignore"):
        for function in (every_operation, compiled):
            out, bits = np.zeros((5, 8)), np.zeros(3, np.int64)
            function(np.array(a), np.array(b), np.array(a, np.float32), x, out, bits)
            results.append((out, bits))
    (plain, plain_bits), (quick, quick_bits) = results
    assert np.array_equal(np.isnan(plain), np.isnan(quick))
    known = ~np.isnan(plain)
    assert plain[known].tobytes() == quick[known].tobytes()
    assert plain_bits.tolist() == quick_bits.tolist()


def test_a_comparison_with_what_is_no_number_is_false_and_a_choice_takes_the_second() -> None:
    nothing, one = np.full(8, math.nan), np.ones(8)
    assert lanes.below(nothing, one) == lanes.no_more(one, nothing) == lanes.no_more(nothing, nothing) == 0
    assert (lanes.larger(nothing, one) == 1.0).all()
    assert np.isnan(lanes.larger(one, nothing)).all()

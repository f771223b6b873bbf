"""SIMD operations against the same operations in Python, lane by lane."""

import math
from typing import Any

import numpy as np
from hypothesis import given, settings, strategies as st

from tracer.compile import simd
from tracer.compile.jit import kernel

number = st.one_of(st.floats(width=32), st.sampled_from([math.nan, math.inf, -math.inf, 0.0, -0.0]))
row = st.lists(number, min_size=8, max_size=8)


def every_operation(a: Any, b: Any, narrow: Any, x: float, out: Any, bits: Any) -> None:
    p, q = simd.load_lanes(a), simd.load_lanes(b)
    simd.store_lanes(simd.lanes_max(p, q), out[0])
    simd.store_lanes(simd.lanes_min(p, q), out[1])
    simd.store_lanes(p * x - q, out[2])
    simd.store_lanes((p - x) * q, out[3])
    simd.store_lanes(simd.load_lanes(narrow) * simd.broadcast(x), out[4])
    bits[0] = simd.mask_less(p, q)
    bits[1] = simd.mask_less_equal(p, q)
    bits[2] = simd.lowest_bit(bits[1] | 128)


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
    assert (
        simd.mask_less(nothing, one)
        == simd.mask_less_equal(one, nothing)
        == simd.mask_less_equal(nothing, nothing)
        == 0
    )
    assert (simd.lanes_max(nothing, one) == 1.0).all()
    assert np.isnan(simd.lanes_max(one, nothing)).all()

"""Lanes: what the processor does with eight numbers at once is what Python does with them one by one."""

import math
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tracer.compile import simd
from tracer.compile.jit import kernel

number = st.one_of(st.floats(width=32), st.sampled_from([math.nan, math.inf, -math.inf, 0.0, -0.0]))
row = st.lists(number, min_size=8, max_size=8)


def every_operation(a: Any, b: Any, narrow: Any, x: float, out: Any, bits: Any) -> None:
    p, q = simd.lanes(a), simd.lanes(b)
    simd.keep(simd.larger(p, q), out[0])
    simd.keep(simd.smaller(p, q), out[1])
    simd.keep(p * x - q, out[2])
    simd.keep((p - x) * q, out[3])
    simd.keep(simd.lanes(narrow) * simd.alike(x), out[4])
    bits[0] = simd.below(p, q)
    bits[1] = simd.no_more(p, q)
    bits[2] = simd.first_of(bits[1] | 128)


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
    assert simd.below(nothing, one) == simd.no_more(one, nothing) == simd.no_more(nothing, nothing) == 0
    assert (simd.larger(nothing, one) == 1.0).all()
    assert np.isnan(simd.larger(one, nothing)).all()

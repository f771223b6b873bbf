"""Cases of `raytree check` about rays and surfaces: the tracer passes, exact values are exact, the textbook fails."""

import math
import random
from collections import Counter
from decimal import localcontext
from functools import cache

import pytest
from mpmath import mp, mpf

from tracer.measure.check.case import DIGITS, Case, Got, Reading, Result, exactly, off, run
from tracer.measure.check.cases import spheres
from tracer.measure.check.check import CASES

# Cases that the textbook's formulas must fail. The others test structure, or the textbook does well there.
FAILS = ("A1", "A2", "A3", "A6", "A7", "A8", "A9", "A4", "A5", "A10", "A11")
FAILS += ("A12", "A13", "B11", "B12", "B14", "D14", "K1", "K2", "K3")
FAILS += ("B1", "B3", "B6", "B7", "B8", "B10", "C1", "C2", "C3", "C4", "C5", "C7", "C9", "J4")

# The least loss of the textbook's formulas, as a relative error (absolute at 0).
LOST = {
    "D3": 0.5,
    "D4": 0.5,
    "D5": 0.1,
    "E1": 1e-5,
    "E2": 1e-2,
    "E3": 1e-5,
    "E4": 1e-3,
    "E5": 1e-5,
    "E8": 1e-4,
    "F1": 1e-4,
    "F2": 1e-3,
    "F3": 0.9,
    "F4": 0.5,
    "F6": 1e-3,
    "F7": 0.9,
    "G3": 1e-6,
    "G7": 1e-6,
    "G11": 1e-6,
    "G13": 1e-6,
    "H1": 0.1,
    "H2": 0.5,
    "H3": 0.1,
    "H5": 0.1,
    "I7": 1e-6,
}


@cache
def result(case: Case) -> Result:
    return run(case)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.id)
def test_case_comes_out(case: Case) -> None:
    assert result(case).ok, [reading for reading in result(case).readings if not reading.ok]
    assert len(case.title) <= 90
    assert case.wrong.endswith(".")


@pytest.mark.parametrize("case", [case for case in CASES if case.id in LOST], ids=lambda case: case.id)
def test_textbook_loses_what_is_claimed(case: Case) -> None:
    lost, ours = max((relative(r.textbook, r), relative(r.got, r)) for r in compared(case))
    assert lost >= LOST[case.id]
    assert ours < lost


def test_ids_are_unique() -> None:
    assert [name for name, count in Counter(case.id for case in CASES).items() if count > 1] == []


@pytest.mark.parametrize("case", [case for case in CASES if case.id in FAILS], ids=lambda case: case.id)
def test_textbook_fails_visibly_where_we_do_not(case: Case) -> None:
    ours = max(relative(one.got, one) for one in compared(case))
    assert max(relative(one.textbook, one) for one in compared(case)) > max(1e-12, 1000.0 * ours)


def compared(case: Case) -> list[Reading]:
    """The readings with an answer of the textbook, of a family all draws."""
    every = [draw for reading in result(case).readings for draw in reading.draws or (reading,)]
    return [reading for reading in every if reading.textbook is not None]


def relative(answer: Got | None, reading: Reading) -> float:
    """The error relative to the exact answer, or absolute if that is 0."""
    assert answer is not None
    return off(answer, reading.exact) / (size(reading) or 1.0)


def size(reading: Reading) -> float:
    return 0.0 if isinstance(reading.exact, str) else abs(float(reading.exact))


def test_textbook_does_fail_in_ten_cases_and_more() -> None:
    assert len(FAILS) >= 10
    assert set(FAILS) <= {case.id for case in CASES}


def test_words_and_counts_leave_no_room() -> None:
    assert exactly("", "hit", "hit").ok
    assert exactly("", 4, 4.0).ok
    assert not exactly("", "hit", "miss").ok
    assert not exactly("", 4, 5).ok
    assert exactly("", 4, 5).error == math.inf


def test_roots_have_fifty_digits() -> None:
    chance = random.Random(7)
    with mp.workdps(80), localcontext(DIGITS):
        for _ in range(100):
            radius = 10.0 ** chance.uniform(-3, 9)
            center = [radius * chance.uniform(-1, 1) for _ in range(3)]
            aim = [chance.uniform(-1, 1) for _ in range(3)]
            on = [c + 0.5 * radius * chance.uniform(-1, 1) for c in center]
            far = 10.0 ** chance.uniform(0, 6) * radius
            origin = [p - far * a for p, a in zip(on, aim, strict=True)]
            f = [mpf(o) - mpf(c) for o, c in zip(origin, center, strict=True)]
            d = [mpf(a) for a in aim]
            a, b = mp.fdot(d, d), mp.fdot(d, f)
            half = mp.sqrt(b * b - a * (mp.fdot(f, f) - mpf(radius) ** 2))
            for found, exact in zip(
                spheres.roots(origin, aim, center, radius), ((-b - half) / a, (-b + half) / a), strict=True
            ):
                assert abs(mpf(str(found)) - exact) < mpf(10) ** -24 * abs(exact)


def test_way_through_the_coat_as_snell_has_it() -> None:
    case = next(case for case in CASES if case.id == "C1")
    ways = [float(one.exact) for one in run(case).readings if not isinstance(one.exact, str)]
    with mp.workdps(50):
        for gap, way in zip((1e-3, 4e-5, 1e-6, 1e-9, 1e-12, 1e-15), ways, strict=True):
            radius = mpf(1.0 + gap)
            inside = mp.asin(mpf(0.2) / radius / mpf("1.5"))
            start, beside = radius * mp.cos(inside), radius * mp.sin(inside)
            assert abs(way / float(start - mp.sqrt(1 - beside**2)) - 1.0) < 1e-15

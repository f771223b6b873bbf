"""Every case of bending, chains, plates, lenses and media comes out; the numbers typed in are right to their digits."""

from decimal import localcontext

import pytest
from mpmath import mp, mpf

from tracer.measure.check import exact_optics
from tracer.measure.check.case import DIGITS, Case, Result, run
from tracer.measure.check.cases import bending, chains, lenses, media, plates

CASES = [case for group in (bending, chains, plates, lenses, media) for case in group.CASES]

# Where the textbook's way loses at least this much, as a relative error (absolute about 0).
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

RESULTS: dict[str, Result] = {}


def result(case: Case) -> Result:
    if case.id not in RESULTS:
        RESULTS[case.id] = run(case)
    return RESULTS[case.id]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.id)
def test_case_comes_out(case: Case) -> None:
    wrong = [
        (reading.setting, reading.exact, reading.got, reading.error, reading.allowed)
        for reading in result(case).readings
        if not reading.ok
    ]
    assert result(case).readings and not wrong


@pytest.mark.parametrize("case", [case for case in CASES if case.id in LOST], ids=lambda case: case.id)
def test_textbook_loses_what_is_claimed(case: Case) -> None:
    errors = [(r.textbook_error, r.error * r.unit) for r in result(case).readings if r.textbook_error is not None]
    lost, ours = max(errors)
    assert lost >= LOST[case.id]
    assert ours < lost


def test_case_names_are_unique_and_short() -> None:
    assert len({case.id for case in CASES}) == len(CASES)
    assert all(len(case.title) <= 90 for case in CASES)


def test_impacts_of_the_rainbow() -> None:
    mp.dps = 50
    n = mpf(4) / 3
    for k, b in lenses.RAINBOWS.items():
        exact = mp.sqrt(((k + 1) ** 2 - n**2) / (k * (k + 2)))
        assert abs(b - exact) < mpf(10) ** -15


def test_growth_between_two_balls() -> None:
    """Paraxial rays to and fro between unit mirrors: the larger eigenvalue of one bounce."""
    mp.dps = 50
    distance = mp.sqrt(mpf("1.3") ** 2 + mpf("2.1") ** 2 + mpf("1.7") ** 2) - 2
    half = 1 + distance  # half the trace of to the mirror and back: 1 + L / (R / 2) / 2 with R = 1
    assert abs(half + mp.sqrt(half * half - 1) - mpf("3.728458374")) < mpf("1e-8")


def test_drop_of_3_4_5() -> None:
    """Chord after chord with 50 digits."""
    mp.dps = 50
    n = mpf(4) / 3
    x, y = mpf(-3) / 5, mpf(4) / 5
    for k, (a, b, size) in enumerate(plates.HITS):
        assert abs(x - mpf(a) / size) < mpf(10) ** -45 and abs(y - mpf(b) / size) < mpf(10) ** -45
        if 0 < k <= len(plates.EXITS):
            ex, ey, size = plates.EXITS[k - 1]
            # Outside: the normal turned by the angle of incidence, whose sine is 4/5, clockwise.
            assert abs((x * mpf(3) / 5 + y * mpf(4) / 5) - mpf(ex) / size) < mpf(10) ** -45
            assert abs((y * mpf(3) / 5 - x * mpf(4) / 5) - mpf(ey) / size) < mpf(10) ** -45
        inside = mp.asin(mpf(4) / 5 / n)
        turn = -(mp.pi - 2 * inside)  # each chord turns the hit clockwise about the centre
        x, y = x * mp.cos(turn) - y * mp.sin(turn), x * mp.sin(turn) + y * mp.cos(turn)


@pytest.mark.parametrize("x", ["1e-12", "0.3", "1", "7", "1e6", "-0.4"])
def test_arctan_has_fifty_digits(x: str) -> None:
    mp.dps = 60
    with localcontext(DIGITS):
        ours = mpf(str(exact_optics.arctan(exact_optics.Decimal(x))))
    assert abs(ours / mp.atan(mpf(x)) - 1) < mpf(10) ** -45


def test_exact_bends_agree_with_a_second_library() -> None:
    mp.dps = 50
    for s1, n1, n2 in ((0.1, 1.0, 1.5), (0.6, 1.5, 1.0), (0.999, 1.0, 2.4)):
        with localcontext(DIGITS):
            ours = exact_optics.bend(s1, n1, n2)
        a, b = mp.asin(mpf(s1)), mp.asin(mpf(n1) * mpf(s1) / mpf(n2))
        rs, rp = -mp.sin(a - b) / mp.sin(a + b), mp.tan(a - b) / mp.tan(a + b)
        assert abs(mpf(str(ours.r)) - (rs * rs + rp * rp) / 2) < mpf(10) ** -45
        assert abs(mpf(str(ours.c2)) - mp.cos(b)) < mpf(10) ** -45

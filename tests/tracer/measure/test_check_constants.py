"""The constants in the cases of refraction, plates and lenses are right in every digit."""

from decimal import localcontext

import pytest
from mpmath import mp, mpf

from tracer.measure.check import exact_optics
from tracer.measure.check.case import DIGITS
from tracer.measure.check.cases import lenses, plates


def test_impacts_of_the_rainbow() -> None:
    mp.dps = 50
    n = mpf(4) / 3
    for k, b in lenses.RAINBOWS.items():
        exact = mp.sqrt(((k + 1) ** 2 - n**2) / (k * (k + 2)))
        assert abs(b - exact) < mpf(10) ** -15


def test_growth_between_two_balls() -> None:
    """Paraxial rays to and fro between unit mirrors: the larger eigenvalue of one reflection."""
    mp.dps = 50
    distance = mp.sqrt(mpf("1.3") ** 2 + mpf("2.1") ** 2 + mpf("1.7") ** 2) - 2
    half = 1 + distance  # half the trace of one round trip: 1 + L / (R / 2) / 2 with R = 1
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
            # Outside: the normal rotated clockwise by the angle of incidence, whose sine is 4/5.
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

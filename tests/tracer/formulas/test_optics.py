"""The lecture's formulas against exact values, known to 25 digits."""

import math
import random

import numpy as np
import pytest

from tracer.formulas import optics

U = 2.0**-53


def normal_at(angle: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """(v, n): a ray that arrives at this angle to the normal (0, 1, 0)."""
    return (math.sin(angle), -math.cos(angle), 0.0), (0.0, 1.0, 0.0)


def test_reflection_is_the_slides_formula() -> None:
    assert optics.reflect((1.0, -1.0, 0.0), (0.0, 1.0, 0.0)) == pytest.approx(
        (math.sqrt(0.5), math.sqrt(0.5), 0.0), rel=4 * U, abs=0.0
    )
    assert optics.reflect([3, -4, 0], [0, 1, 0]) == pytest.approx((0.6, 0.8, 0.0), abs=2 * U)
    assert optics.reflect(np.array([0.0, 0.0, -7.0]), (0, 0, 1)) == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("n1", "n2", "degrees"),
    [
        (1.33, 1.0, 48.75346663132723),
        (1.5, 1.0, 41.81031489577859807),
        (1.333, 1.0, 48.60662639169027),
        (2.42, 1.0, 24.40746891798658716),
        (4.0, 2.0, 30.0),
    ],
)
def test_critical_angle(n1: float, n2: float, degrees: float) -> None:
    critical = optics.critical_angle(n1, n2)
    assert critical is not None
    assert math.degrees(critical) == pytest.approx(degrees, rel=4 * U, abs=0.0)
    assert optics.critical_angle(n2, n1) is None
    assert optics.critical_angle(n1, n1) is None


@pytest.mark.parametrize("k", [10, 30, 50])
def test_critical_angle_of_nearly_equal_indices(k: int) -> None:
    """n1 = 1 + 2^-k: the cosine is sqrt((n1 - 1) (n1 + 1)) / n1. From n1^2 - 1 it would keep only 53 - k bits."""
    critical = optics.critical_angle(1.0 + 2.0**-k, 1.0)
    assert critical is not None
    from_level = math.atan(math.sqrt(2.0**-k * (2.0 + 2.0**-k)))
    assert critical == pytest.approx(math.pi / 2 - from_level, rel=2 * U, abs=0.0)


@pytest.mark.parametrize("size", [1e-300, 1e-200, 1e200, 1e300])
def test_length_of_a_vector_is_no_matter(size: float) -> None:
    v, n = (3.0 * size, -4.0 * size, 0.0), (0.0, 5.0 / size, 0.0)
    assert optics.reflect(v, n) == pytest.approx((0.6, 0.8, 0.0), abs=2 * U)
    assert optics.refract(v, n, 1.0, 1.5) == pytest.approx((0.4, -math.sqrt(0.84), 0.0), abs=2 * U)


def test_refraction_of_3_4_5() -> None:
    """From air (sin 0.8) to n = 4/3 (sin 0.6): every number is rational."""
    t = optics.refract((0.8, -0.6, 0.0), (0.0, 1.0, 0.0), 1.0, 4 / 3)
    assert t == pytest.approx((0.6, -0.8, 0.0), abs=2 * U)
    back = optics.refract((0.6, -0.8, 0.0), (0.0, 1.0, 0.0), 4 / 3, 1.0)
    assert back == pytest.approx((0.8, -0.6, 0.0), abs=4 * U)
    assert optics.refract((0.9, -math.sqrt(0.19), 0.0), (0.0, 1.0, 0.0), 4 / 3, 1.0) is None


def test_refraction_needs_no_unit_vector_and_no_tuple() -> None:
    once = optics.refract((0.8, -0.6, 0.0), (0.0, 1.0, 0.0), 1.0, 1.5)
    assert once is not None
    assert optics.refract([8, -6, 0], np.array([0, 1, 0]), 1, 1.5) == pytest.approx(once, abs=2 * U)


@pytest.mark.parametrize(
    ("delta", "cosine", "reflectance"),
    [
        (0.1, 0.468644200413522617, 0.100281990772139534),
        (1e-3, 0.0472844211857515369, 0.763641187835759556),
        (1e-6, 1.49534869771019165e-3, 0.991349586740906396),
    ],
)
def test_approach_to_the_critical_angle(delta: float, cosine: float, reflectance: float) -> None:
    """Glass to air at theta_c - delta: the error may grow as 1/cos^2, and no faster."""
    critical = optics.critical_angle(1.5, 1.0)
    assert critical is not None
    v, n = normal_at(critical - delta)
    t = optics.refract(v, n, 1.5, 1.0)
    assert t is not None
    assert -t[1] == pytest.approx(cosine, rel=8 * U / cosine**2, abs=0.0)
    r, _ = optics.fresnel(math.cos(critical - delta), 1.5, 1.0)
    assert abs(r - reflectance) <= 16 * U / cosine


@pytest.mark.parametrize("k", [3, 10, 25, 30, 40, 52])
def test_radicand_keeps_its_digits_next_to_the_critical_angle(k: int) -> None:
    """s2 = 1 - 2^-k: the radicand is 2^(1-k) - 2^(-2k). One minus a rounded square would keep only 53 - k bits."""
    for n in (1.0, 4.0):
        found = optics.radicand((1.0 - 2.0**-k) / n, n, 1.0)
        assert found == pytest.approx(2.0 ** (1 - k) * (1.0 - 2.0 ** (-k - 1)), rel=2 * U, abs=0.0)


@pytest.mark.parametrize(
    ("angle", "refracted"),
    [
        (1e-2, 6.666604937345675e-3),
        (1e-4, 6.66666666049383e-5),
        (1e-6, 6.6666666666660495e-7),
        (1e-8, 6.6666666666666665e-9),
        (1e-10, 6.6666666666666669e-11),
    ],
)
def test_angle_near_the_normal_keeps_its_digits(angle: float, refracted: float) -> None:
    v, n = normal_at(angle)
    t = optics.refract(v, n, 1.0, 1.5)
    assert t is not None
    assert optics.angle(t, (0.0, -1.0, 0.0)) == pytest.approx(refracted, rel=8 * U, abs=0.0)


@pytest.mark.parametrize(
    ("k", "deviation", "reflectance"),
    [
        (3, 1.7277361987873398e-3, 2.47964266711e-6),
        (6, 1.732046477314957e-6, 2.49997949973e-12),
        (9, 1.7320509465492755e-9, 2.50000039320e-18),
        (12, 1.732204787889983e-12, 2.50044452265e-24),
    ],
)
def test_nearly_matched_indices(k: int, deviation: float, reflectance: float) -> None:
    """n2 = 1 + 10^-k at 60 degrees: the deviation has full relative accuracy; a difference of two angles would not."""
    n2 = 1.0 + 10.0**-k
    v, n = normal_at(math.radians(60))
    t = optics.refract(v, n, 1.0, n2)
    assert t is not None
    # The directions are nearly equal unit vectors: their angle is known to a rounding unit of 1.
    assert abs(optics.angle(v, t) - deviation) <= 4 * U
    r, _ = optics.fresnel(0.5, 1.0, n2)
    assert r == pytest.approx(reflectance, rel=1e-9 if k < 12 else 1e-3, abs=0.0)


@pytest.mark.parametrize(
    ("cosine", "transmitted"),
    [(1e-2, 0.0562474565141717164), (1e-5, 5.81358274658638752e-5), (1e-8, 5.81377654749945842e-8)],
)
def test_transmittance_at_grazing_incidence_is_computed_for_itself(cosine: float, transmitted: float) -> None:
    r, t = optics.fresnel(cosine, 1.0, 1.5)
    assert t == pytest.approx(transmitted, rel=8 * U, abs=0.0)
    assert r + t == pytest.approx(1.0, abs=4 * U)


@pytest.mark.parametrize(
    ("n", "reflectance"),
    [(1.5, 0.04), (1.33, 0.02005931219952476561), (2.42, 0.17239492493416777812), (1e8, 0.9999999600000008)],
)
def test_normal_incidence(n: float, reflectance: float) -> None:
    """e / (n1 c1 + n2 c2)^2 takes 11 roundings, its square twice as many and one more."""
    assert optics.fresnel(1.0, 1.0, n)[0] == pytest.approx(reflectance, rel=23 * U, abs=0.0)
    assert optics.fresnel(1.0, n, 1.0)[0] == pytest.approx(reflectance, rel=23 * U, abs=0.0)


def test_brewster_angle_reflects_one_polarisation_only() -> None:
    """tan theta = 1.5: the parallel polarisation is not reflected, R = 25/338."""
    r, _ = optics.fresnel(math.cos(math.atan(1.5)), 1.0, 1.5)
    assert r == pytest.approx(25 / 338, rel=8 * U, abs=0.0)


def test_total_internal_reflection_reflects_all() -> None:
    assert optics.fresnel(0.1, 1.5, 1.0) == (1.0, 0.0)


def test_energy_and_reciprocity() -> None:
    """R + T = 1, and the reflectance is the same in the opposite direction."""
    draw = random.Random(1)
    for _ in range(2000):
        n1, n2, cos1 = draw.uniform(1, 3), draw.uniform(1, 3), draw.uniform(0.001, 1)
        r, t = optics.fresnel(cos1, n1, n2)
        sin2 = n1 / n2 * math.sqrt((1 - cos1) * (1 + cos1))
        if sin2 >= 1.0:
            assert (r, t) == (1.0, 0.0)
            continue
        cos2 = math.sqrt((1 - sin2) * (1 + sin2))
        assert abs(r + t - 1.0) <= 8 * U / cos2**2
        back, _ = optics.fresnel(cos2, n2, n1)
        assert abs(back - r) <= 16 * U / min(cos1, cos2) ** 2


def test_path_through_a_prism_of_root_two() -> None:
    """A = 60 degrees, n = sqrt 2: in at 45 degrees, a symmetric path, and a deviation of exactly 30 degrees."""
    n = math.sqrt(2)
    first, second = (-math.cos(math.radians(30)), 0.5, 0.0), (math.cos(math.radians(30)), 0.5, 0.0)
    along = math.radians(45 - 30)  # below the horizontal: 45 to the first face's normal
    v = (math.cos(along), math.sin(along), 0.0)
    inside = optics.refract(v, first, 1.0, n)
    assert inside is not None
    assert inside == pytest.approx((1.0, 0.0, 0.0), abs=4 * U)
    out = optics.refract(inside, tuple(-x for x in second), n, 1.0)
    assert out is not None
    assert math.degrees(optics.angle(v, out)) == pytest.approx(30.0, abs=1e-13)

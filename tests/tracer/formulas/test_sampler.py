"""Positions of samples, and the rates at which their means converge, which are known from theory."""

import math
from typing import Any

import numpy as np
import pytest

import tracer
from tracer.choices import JITTERED, RANDOM, SAMPLERS, SOBOL
from tracer.compile.jit import kernel
from tracer.formulas.sampler import Sampler, make_samples, sample_offset

RUNS = 600  # pixels: enough to know the slope of the RMSE to about 0.02


@kernel
def fill(sampler: Sampler, pixel: int, found: Any) -> None:
    for k in range(len(found)):
        found[k, 0], found[k, 1] = sample_offset(pixel, 7, k, sampler)


def points(sampler: int, count: int, pixel: int) -> np.ndarray:
    found = np.zeros((count, 2))
    fill(Sampler(sampler, math.isqrt(count)), pixel, found)
    return found


def slope(sampler: int, error) -> float:
    """Slope of log RMSE over log N, for random pixels."""
    counts = (4, 16, 64, 256)
    spread = [math.sqrt(np.mean([error(points(sampler, n, i), i) ** 2 for i in range(RUNS)])) for n in counts]
    return float(np.polyfit(np.log(counts), np.log(spread), 1)[0])


def smooth(at: np.ndarray, i: int) -> float:
    """exp(a x + b y) over the unit square."""
    a, b = np.random.default_rng(i).uniform(-1.0, 1.0, 2)
    return float(np.exp(at @ (a, b)).mean()) - math.expm1(a) / a * math.expm1(b) / b


def edge(at: np.ndarray, i: int) -> float:
    """The part of the square on one side of a line y = m x + c that runs from its left to its right edge."""
    m, c = np.random.default_rng(i).uniform((-0.4, 0.4), (0.2, 0.6))
    return float((at[:, 1] < m * at[:, 0] + c).mean()) - (0.5 * m + c)


@pytest.mark.parametrize(
    ("sampler", "error", "wanted"),
    ((RANDOM, smooth, -0.5), (RANDOM, edge, -0.5), (JITTERED, smooth, -1.0), (JITTERED, edge, -0.75)),
)
def test_means_come_near_as_theory_says(sampler: int, error, wanted: float) -> None:
    assert slope(sampler, error) == pytest.approx(wanted, abs=0.05)


def test_even_points_are_no_worse_than_jittered_ones() -> None:
    assert slope(SOBOL, edge) < -0.7
    assert slope(SOBOL, smooth) < -0.95


def test_each_cell_has_its_point() -> None:
    for n in (1, 4, 9, 64):
        side = math.isqrt(n)
        cells = (points(JITTERED, n, 3) * side).astype(int)
        assert len(set(map(tuple, cells.tolist()))) == n
        assert (cells >= 0).all()
        assert (cells < side).all()


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_an_image_is_the_mean_of_its_samples(sampler: str, worlds: dict[str, tracer.World]) -> None:
    world = worlds["two-lights"]
    image = tracer.render(world, (8, 6), 4, sampler=sampler)
    for x, y in ((0, 0), (5, 3)):
        terms = [
            tracer.trace(world, (x, y), size=(8, 6), sample=k, sampler=sampler, samples=4).radiance for k in range(4)
        ]
        total = np.zeros(3)
        for term in terms:
            total = total + term
        assert (image.pixels[y, x] == total / 4).all()


def test_what_is_no_number_of_samples() -> None:
    with pytest.raises(ValueError, match="jittered samples must be a square number like 4, got 5"):
        make_samples(5, "jittered")
    with pytest.raises(ValueError, match="samples must be >= 1, got 0"):
        make_samples(0)
    with pytest.raises(ValueError, match="sampler must be one of sobol, random, jittered, got 'halton'"):
        make_samples(4, "halton")

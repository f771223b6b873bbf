"""Adaptive sampling: a pixel of N samples has the bits of a plain image, the estimate is not below the error, rays are
saved.
"""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import tracer
from tests.scenes import ball, world_of
from tests.tracer.measure.test_precision import ACROSS, edge_image, edge_scene
from tracer.choices import JITTERED, RANDOM, SAMPLERS, SOBOL
from tracer.image.adaptive import RESTART_FACTOR, PixelStatistics
from tracer.image.passes import Stopped
from tracer.image.progressive import ProgressiveImage
from tracer.image.tiles import Tile
from tracer.kernel.limits import make_limits
from tracer.measure.precision.errors import rmse

SIZE = (64, 48)
DRAWS = 0.07  # spread of an error estimated from the 100 pixels on the edge: 1 / sqrt(2 * 100)


@pytest.mark.parametrize("sampler", ("sobol", "random"))
def test_pixels_are_those_of_plain_images(worlds: dict[str, tracer.World], sampler: str) -> None:
    """A pixel of N samples has the bits of an image with N samples a pixel, on any number of threads."""
    world = worlds["glass-ball"]
    image = tracer.render(world, SIZE, until_error=0.02, sampler=sampler)
    assert image.counts is not None
    counts = np.unique(image.counts)
    assert len(counts) > 3
    for n in counts.tolist():
        # Sobol with one sample is a special case, the pixel's centre: two samples are the least here.
        plain = tracer.render(world, SIZE, samples=n, sampler=sampler)
        here = image.counts == n
        assert image.pixels[here].tobytes() == plain.pixels[here].tobytes()
    again = tracer.render(world, SIZE, until_error=0.02, sampler=sampler, threads=1)
    assert again.pixels.tobytes() == image.pixels.tobytes()
    assert again.rays == image.rays


def test_what_is_cut_is_counted_as_in_plain_images(worlds: dict[str, tracer.World]) -> None:
    world = worlds["mirror-balls"]
    image = tracer.render(world, SIZE, depth=1, samples=2, until_error=1e-9)
    plain = tracer.render(world, SIZE, depth=1, samples=2)
    assert image.ended == "samples"
    assert image.rays == plain.rays
    assert image.tests == plain.tests > 0
    assert image.residual["max"] == plain.residual["max"] > 0.0
    assert image.residual["mean"] == pytest.approx(plain.residual["mean"], rel=1e-14)
    assert image.bound == plain.bound


def test_the_estimate_of_a_lesson_is_no_lower_than_its_error(worlds: dict[str, tracer.World]) -> None:
    """Some thousand pixels on edges: a few that stop early by a lucky draw must not lower the estimate of the image."""
    world, size = worlds["mirror-balls"], (160, 120)
    true = tracer.render(world, size, samples=512).pixels
    for sampler in ("sobol", "random"):
        for goal in (0.01, 0.005):
            image = tracer.render(world, size, until_error=goal, sampler=sampler)
            assert image.stats
            assert rmse(image.pixels, true) <= 1.05 * image.stats.error <= 1.05 * goal


def test_an_edge_in_closed_form_with_a_quarter_of_the_rays() -> None:
    """One pixel in some hundred has an edge. The others need no more than the two samples that show that they have
    none.
    """
    world, true = edge_scene(), edge_image()
    plain = tracer.render(world, (ACROSS, ACROSS), samples=64)
    wanted = rmse(plain.pixels, true)
    for goal in (2.0 * wanted, 1.4 * wanted, wanted):
        image = tracer.render(world, (ACROSS, ACROSS), until_error=goal)
        assert image.stats
        assert image.stats.error <= goal
        assert rmse(image.pixels, true) < (1.0 + 2.0 * DRAWS) * image.stats.error
    assert image.counts is not None
    assert image.counts.mean() < 64 / 4
    assert image.counts[0, 0] == 2
    edges = (true[..., 0] > 0.0) & (true[..., 0] < 1.0)
    assert image.counts[edges].mean() > 64 / 2


@pytest.mark.parametrize(
    ("sampler", "law"),
    # At an edge the squared error is v(N) = c N^-3/2. Of two halves with error v(N/2) each the mean moves by v(N/2) -
    # v(N), squared; independent halves have v(N/2) = 2 v(N), renewed samples v(N/4) + v(N).
    (("sobol", math.sqrt(2.0**1.5 - 1.0)), ("random", 1.0), ("jittered", math.sqrt((4.0**1.5 + 1.0) / RESTART_FACTOR))),
)
def test_the_estimate_is_theory_s(sampler: str, law: float) -> None:
    world, true = edge_scene(), edge_image()
    view = world.view((ACROSS, ACROSS))
    limits = make_limits(world, records=False)
    made = ProgressiveImage(world, view, limits, SAMPLERS.index(sampler), adaptive=False, most=256)
    with ThreadPoolExecutor(2) as pool:
        found = [(reached, rmse(made.statistics.means(), true)) for reached in made.rounds(pool, 2)]
    counts = [reached.samples for reached, _ in found]
    assert counts == [(4.0 if sampler == "jittered" else 2.0) ** k for k in range(len(counts))]
    assert counts[-1] == 256
    ratios = [math.log(reached.error / error) for reached, error in found if reached.samples >= 4]
    assert math.exp(math.fsum(ratios) / len(ratios)) == pytest.approx(law, rel=2.0 * DRAWS)
    if sampler == "jittered":
        plain = tracer.render(world, (ACROSS, ACROSS), samples=256, sampler="jittered")
        assert made.statistics.means().tobytes() == plain.pixels.tobytes()


def test_time_ends_it(worlds: dict[str, tracer.World]) -> None:
    """Every pixel has two samples, however short the time: fewer give no estimate of their error."""
    image = tracer.render(worlds["mirror-balls"], SIZE, until_seconds=1e-9)
    assert image.ended == "seconds"
    assert image.stats
    assert (image.stats.least, image.stats.most) == (2, 2)
    assert image.stats.error > 0.0
    later = tracer.render(worlds["mirror-balls"], SIZE, until_seconds=0.2)
    assert later.ended == "seconds"
    assert later.stats
    assert later.seconds["trace"] >= 0.2
    assert later.stats.samples > 2.0


def test_a_flat_image_needs_two_samples() -> None:
    """The ball is behind the eye."""
    image = tracer.render(world_of(ball((0, 0, 50), 0.1)), SIZE, until_error=1e-9)
    assert image.stats
    assert image.stats.error == 0.0
    assert image.ended == "error"
    assert image.stats.most == 2


def test_broken_off_and_gone_on_with(worlds: dict[str, tracer.World]) -> None:
    """A round that is stopped between two tiles loses none, and continuing gives the same image."""
    world = worlds["two-lights"]
    limits = make_limits(world, records=False)

    def fresh() -> ProgressiveImage:
        return ProgressiveImage(world, world.view(SIZE), limits, SOBOL, adaptive=False, most=8)

    whole, broken = fresh(), fresh()
    with ThreadPoolExecutor(1) as pool:
        for _ in whole.rounds(pool, 1):
            pass
        seen: list[int] = []
        for _ in range(100):
            try:
                for _ in broken.rounds(pool, 1, lambda *_: seen.append(0), lambda: len(seen) % 2 == 1):
                    pass
                break
            except Stopped:
                seen.append(0)
    assert len(seen) > 8
    assert broken.statistics.sums.tobytes() == whole.statistics.sums.tobytes()
    assert broken.stats._replace(seconds=0.0) == whole.stats._replace(seconds=0.0)


def test_gains_by_hand() -> None:
    """Of three pixels the one whose samples changed most is refined, the others stay."""
    sampled = PixelStatistics(3, 1, RANDOM, adaptive=True)
    tile = Tile(0, 0, 3, 1)
    for count, colors in ((1, (0.5, 0.5, 0.5)), (2, (1.0, 1.1, 3.0))):
        assert sampled.plan_round(64)
        sums = np.zeros((3, 4))
        sums[:, 0] = colors
        sampled.update(tile, sums)
        assert (sampled.counts == count).all()
    # The means changed from 0.5 to 0.5, 0.55 and 1.5 in one component of three.
    assert sampled.moved[0] == pytest.approx([0.0, 0.05**2 / 3, 1.0 / 3], rel=1e-12)
    assert sampled.error == pytest.approx(math.sqrt((0.05**2 + 1.0) / 9), rel=1e-12)
    assert sampled.plan_round(64)
    assert sampled.wanted[0].tolist() == [2, 2, 4]
    assert PixelStatistics(3, 1, JITTERED, adaptive=False).plan_round(64)
    assert RESTART_FACTOR == 5.0


@pytest.mark.parametrize(
    ("options", "fault"),
    (
        ({"until_error": 0.0}, "until_error must be a number > 0, got 0.0"),
        ({"until_seconds": math.inf}, "until_seconds must be a number > 0, got inf"),
        ({"until_error": 1.0, "samples": 1}, "samples must be >= 2 with until_error or until_seconds, got 1"),
        (
            {"until_error": 1.0, "sampler": "jittered"},
            "until_error and until_seconds need sobol or random samples, got jittered",
        ),
    ),
)
def test_faults(options: dict, fault: str, worlds: dict[str, tracer.World]) -> None:
    with pytest.raises(ValueError, match=fault):
        tracer.render(worlds["plates"], SIZE, **options)

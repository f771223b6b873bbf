"""Bounds of images: they contain the exact colours, and what deeper trees add."""

import math
from fractions import Fraction

import numpy as np
import pytest

import tracer
from tests.exact_tracer import Judge, camera_ray
from tests.random_scenes import random_scene
from tests.scenes import OPEN, ball, plane, world_of
from tracer.image.bounds import mean_beyond, render_bounds
from tracer.scene import Camera, Image, Material

SIZE = (8, 6)


def half_mirrors() -> tracer.World:
    """A scene in which each hit passes half of its light on, so the missing light is bounded."""
    shiny = Material("shiny", ambient=0.3, reflect=0.5)
    camera = Camera((0.3, 1.0, 6.0), (0.0, 0.0, 0.0))
    items = (ball((-1.1, 0, 0), 1.0, shiny), ball((1.1, 0, 0), 1.0, shiny), plane((0, -1, 0), (0, 1, 0), shiny))
    return world_of(*items, camera=camera, image=Image(32, 24), background=(0.2, 0.3, 0.4), depth=2)


def test_the_judge_and_the_image_lie_in_the_bounds() -> None:
    for seed in (3, 5, 8):
        world = tracer.prepare(random_scene(seed))
        bounds = render_bounds(world, SIZE)
        assert bounds.certified == bounds.decisions
        judge = Judge(world.scene, world.scene.tracing.depth)
        pixels = tracer.render(world, SIZE).pixels
        for y in range(SIZE[1]):
            for x in range(SIZE[0]):
                error = tracer.trace(world, (x, y), size=SIZE).radiance_error
                exact = judge.tree(*camera_ray(world.scene.camera, SIZE, x + 0.5, y + 0.5)).radiance
                for k in range(3):
                    low, high = bounds.low[y, x, k], bounds.high[y, x, k]
                    assert low <= exact[k] <= high
                    assert low - error <= pixels[y, x, k] <= high + error


def test_what_cut_rays_would_add_lies_in_the_bounds() -> None:
    """Bounds at depth 1 contain the colours at depth 40, which lack 2^-41 of the most that a ray can bring."""
    world = half_mirrors()
    bounds = render_bounds(world, SIZE, depth=1)
    deep = tracer.render(world, SIZE, depth=40).pixels
    assert (bounds.low - 1e-12 <= deep).all()
    assert (deep <= bounds.high + 1e-12).all()
    cut = bounds.high - bounds.low > 1e-9
    assert cut.any()
    # Two hits let a quarter of the light through, of at most 0.6 a ray.
    assert bounds.high[cut].max() <= (0.3 + 0.15 + 0.25 * 0.6) * (1.0 + 1e-9)


def test_samples_and_processes() -> None:
    """The bounds are those of the mean over the samples, whichever process makes them; the sampling error is apart."""
    world = half_mirrors()
    one, two = (render_bounds(world, SIZE, samples=4, processes=processes) for processes in (1, 2))
    assert one.low.tolist() == two.low.tolist()
    assert one.high.tolist() == two.high.tolist()
    mean = tracer.render(world, SIZE, samples=4).pixels
    assert (one.low - 1e-12 <= mean).all()
    assert (mean <= one.high + 1e-12).all()
    assert one.sampling_error > 0.0
    assert math.isnan(render_bounds(world, SIZE).sampling_error)


def test_a_tie_is_as_wide_as_what_it_could_bring() -> None:
    """The middle pixel of an odd image looks along the silhouette of a ball: hit or miss is not certified."""
    world = world_of(ball((0, 0, 0), 1.0, OPEN, "ball"), camera=Camera((1.0, 0.0, 5.0), (1.0, 0.0, 0.0)))
    bounds = render_bounds(world, (3, 3))
    width = (bounds.high - bounds.low)[1, 1]
    assert bounds.certified == bounds.decisions - 1
    assert width == pytest.approx(np.ones(3), rel=1e-9)


def test_the_mean_of_samples_is_rounded_outwards() -> None:
    """The sum and the quotient are both rounded: one float outwards is not always enough."""
    rng = np.random.default_rng(18)
    one_is_too_few = 0
    for _ in range(20_000):
        numbers = rng.uniform(0.0, 2.0 ** rng.integers(-3, 3), rng.integers(1, 40)).tolist()
        exact = sum(map(Fraction, numbers)) / len(numbers)
        low, high = mean_beyond(numbers, -math.inf), mean_beyond(numbers, math.inf)
        assert low <= exact <= high
        one_is_too_few += not math.nextafter(low, math.inf) <= exact <= math.nextafter(high, -math.inf)
    assert one_is_too_few > 0

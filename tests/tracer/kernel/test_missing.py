"""Best-first trees until no more than an amount of light can be missing."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import MIRROR, ball, plane, world_of
from tests.tracer.kernel.test_best_first import WHITE, plates, random_world
from tracer.scene import Light, Material
from tracer.scene.radiance_bound import MissingBoundError, radiance_bound

SIZE = (12, 9)


@pytest.mark.parametrize("seed", range(12))
def test_image_lacks_no_more_light_than_was_allowed(seed: int) -> None:
    """Against an image that is traced much further. Its trees are those of the pixels."""
    world = random_world(seed)
    most = radiance_bound(world.scene).largest
    deep = tracer.render(world, SIZE, missing=1e-4 * most)
    for missing in (0.3 * most, 0.03 * most, 1e-3 * most):
        image = tracer.render(world, SIZE, missing=missing)
        assert image.limited == 0
        assert image.bound <= missing
        assert image.missing_allowed == missing
        lacks = deep.pixels - image.pixels
        assert -1e-12 * most <= lacks.min()
        assert lacks.max() <= missing
        tree = tracer.trace(world, (6, 5), size=SIZE, missing=missing)
        assert tree.radiance.tobytes() == image.pixels[5, 6].tobytes()
        assert tree.bound <= missing


def test_light_counts_not_weight() -> None:
    """A background four times as bright allows a quarter of the weight."""
    dim, bright = plates(3, background=WHITE), plates(3, background=(1.0, 4.0, 2.0))
    for e in (0.5, 0.01, 1e-4):
        ray = ((0.1, 1e3, 0.2), (0, -1, 0))
        far = tracer.trace(bright, ray=ray, missing=e)
        assert far.nodes["id"].tolist() == tracer.trace(dim, ray=ray, missing=0.25 * e).nodes["id"].tolist()
        assert far.tolerance == pytest.approx(0.25 * e, rel=1e-12)
        assert far.tolerance and 0.0 < far.residual <= far.tolerance
        assert f"within the {e:g} that was asked for" in far.to_text()


def test_bound_is_never_above_what_was_asked_for_by_rounding() -> None:
    """Scenes in which tracing stops at the very tolerance, and the bound has any bits."""
    random = np.random.default_rng(5)
    for _ in range(200):
        k, light, depth = random.uniform(0.3, 0.9), random.uniform(0.1, 9.0), int(random.integers(0, 12))
        shell = world_of(ball((0, 0, 0), 1.0, Material("shell", ambient=light, reflect=k)))
        ray = ((0.1, 0.2, -0.3), (1, 2, 3))
        stop = tracer.trace(shell, ray=ray, depth=depth)
        for missing in (stop.bound, math.nextafter(stop.bound, 0.0), stop.bound * (1.0 + 2.0**-40)):
            tree = tracer.trace(shell, ray=ray, missing=missing)
            assert tree.bound <= missing
        assert len(tree) == len(stop)  # a little above the bound, no further ray is traced


def test_scene_without_light_is_known_after_the_first_ray() -> None:
    """No ray can bring light, so nothing can be missing, although all the weight is cut."""
    walls = (plane((0, 0, 0), (1, 0, 0), MIRROR, "left"), plane((1, 0, 0), (-1, 0, 0), MIRROR, "right"))
    for missing in (0.0, 0.1):
        tree = tracer.trace(world_of(*walls), ray=((0.5, 0, 0), (1, 0.1, 0)), missing=missing)
        assert (len(tree), tree.residual, tree.bound) == (1, 1.0, 0.0)
        assert "at most 0 of this pixel's 0 is missing" in tree.to_text()


def test_depth_that_is_given_stops_sooner_and_that_is_said() -> None:
    world = plates(3)
    tree = tracer.trace(world, ray=((0.1, 1e3, 0.2), (0, -1, 0)), missing=1e-6, depth=3)
    assert tree.bound > 1e-6
    text = tree.to_text()
    assert "stopped by depth or weight" in text
    assert "more than the 1e-06 that was asked for" in text


def test_without_a_bound_the_material_is_named() -> None:
    lamp = Light("lamp", position=(0.0, 9.0, 0.0))
    shiny = Material("shiny", specular=0.1, transmit=1.0, ior=1.5)
    world = world_of(ball(material=shiny), plane((0, -2, 0), (0, 1, 0)), lights=[lamp])
    for call in (lambda: tracer.trace(world, (1, 2), missing=0.1), lambda: tracer.render(world, missing=0.1)):
        with pytest.raises(MissingBoundError, match='the material "shiny" has none'):
            call()

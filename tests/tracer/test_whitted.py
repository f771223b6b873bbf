"""The recursion of tracer/whitted.py against the kernel, pixel by pixel."""

from dataclasses import replace

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import GLASS, ball, polygon, world_of
from tracer import whitted
from tracer.choices import MODELS
from tracer.formulas.camera import pixel_direction
from tracer.scene import Light

# Per component: 3 levels, each with a direction and a factor accurate to 16 units (test_against_exact.py), at slopes of
# up to 8 of the light over the angle.
ROUNDINGS = 3 * 16 * 8 * 2.0**-53
# An epsilon must fail if the scene is not much larger than it: all of `scale` is smaller, and so is the gap of `panes`.
FAILS = ("scale", "panes")


def differences(world: tracer.World, model: str) -> np.ndarray:
    """The largest difference of a component on a grid of pixels, relative to the brightest component."""
    world = tracer.prepare(replace(world.scene, tracing=replace(world.scene.tracing, model=model)))
    view = world.view()
    found = []
    for y in range(7, view.height, 71):
        for x in range(5, view.width, 71):
            tree = tracer.trace(world, (x, y), depth=3)
            # of the medium around the eye: it may be under water
            medium = float(np.nan_to_num(tree.nodes["n1"][0], nan=1.0))
            color = whitted.radiance(world, view.eye, pixel_direction(view, x + 0.5, y + 0.5), 3, medium)
            found.append(np.abs(color - tree.radiance).max() / max(tree.radiance.max(), 1e-300))
    return np.array(found)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", EACH_LESSON)
def test_the_page_and_the_kernel_trace_the_same_colours(name: str, model: str, worlds: dict[str, tracer.World]) -> None:
    off = differences(worlds[name], model)
    assert len(off) > 80
    if name in FAILS:
        assert (off > 1e-3).mean() > 0.02
    else:
        assert off.max() <= ROUNDINGS


@pytest.mark.timeout(60)
def test_it_ends_in_a_huge_scene() -> None:
    """A shadow ray through glass at 1e13: a step of EPSILON is less than a rounding of the distance."""
    far = 1e13
    glass, lamp = ball((0, far, 0), 0.1 * far, GLASS), Light("lamp", (0.0, 3.0 * far, 0.0))
    world = world_of(polygon([(-far, 0, -far), (-far, 0, far), (far, 0, far), (far, 0, -far)]), glass, lights=[lamp])
    assert 0.0 < whitted.transmittance(world, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 3.0 * far) <= 1.0

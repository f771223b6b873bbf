"""Rules for every number of a material. A new number is covered here without a change to this file."""

from dataclasses import fields, replace

import pytest

import tracer
from tests.scenes import world_of
from tracer.scene import Light, Material, Object
from tracer.shapes.plane import Plane
from tracer.shapes.sphere import Sphere

U = 2.0**-53
NUMBERS = [item.name for item in fields(Material) if isinstance(item.default, float) and item.name != "roughness"]
MIRROR = Material("mirror", reflect=0.5)
PLAIN = Material("plain", color=(0.5, 0.6, 0.7))


@pytest.mark.parametrize("name", NUMBERS)
def test_the_light_that_a_cut_leaves_out_is_bounded(name: str) -> None:
    """A ball with this number set, seen in a mirror that is not followed: its light is within the bound."""
    ball = replace(PLAIN, **{name: 0.25})
    world = world_of(
        Object(Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), MIRROR, "mirror"),
        Object(Sphere((0.0, 0.0, 4.0), 1.0), ball, "ball"),
        lights=[Light("lamp", position=(1.0, 2.0, 1.0))],
        background=(0.1, 0.1, 0.1),
    )
    ray = ((0.0, 4.0, 4.0), (0.0, -2.0, -4.0))
    whole = tracer.trace(world, ray=ray, depth=8)
    assert "ball" in [whole.object_name(i) for i in range(len(whole))]
    for depth in range(8):
        cut = tracer.trace(world, ray=ray, depth=depth)
        missing = float((whole.radiance - cut.radiance).max())
        assert missing <= cut.bound + 8 * U

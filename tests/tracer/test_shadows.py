"""Shadow rays through much glass: gathered in one pass or crossing by crossing, the same product."""

import random

import pytest

import tracer
from tests.scenes import ball, ends, plane, world_of
from tracer.scene import Light, Material
from tracer.shadows import MOST_CROSSINGS


@pytest.mark.parametrize("balls", [1, 5, MOST_CROSSINGS // 2, MOST_CROSSINGS // 2 + 1, 40])
def test_every_ball_on_the_way_is_crossed_twice(balls: int) -> None:
    kt = [0.9 + 0.002 * k for k in range(balls)]
    glass = [
        ball((0, 3 + 3 * k, 0), 1, Material(f"glass {k}", transmit=kt[k], ior=1.5), f"ball {k}") for k in range(balls)
    ]
    shuffled = random.Random(balls).sample(glass, balls)
    sun = Light("sun", direction=(0.0, -1.0, 0.0))
    world = world_of(plane((0, 0, 0), (0, 1, 0)), *shuffled, lights=[sun])
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    share = 1.0
    for k in range(balls):  # nearest first, as the kernel multiplies
        share = share * kt[k] * kt[k]
    assert ends(tree)[1] == "filtered"
    assert tree.object_name(1) == "ball 0"
    assert tree.nodes["factor"][1][0] == share
    assert tree.radiance[0] == share


def test_occluder_is_the_nearest_opaque_one_behind_any_glass() -> None:
    objects = [
        plane((0, 0, 0), (0, 1, 0)),
        ball((0, 9, 0), 1, name="far"),
        ball((0, 6, 0), 1, name="near"),
        ball((0, 3, 0), 1, Material("glass", transmit=0.5, ior=1.5), "glass"),
    ]
    sun = Light("sun", direction=(0.0, -1.0, 0.0))
    tree = tracer.trace(world_of(*objects, lights=[sun]), ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert (ends(tree)[1], tree.object_name(1), tree.nodes["t"][1]) == ("blocked", "near", 5.0)
    blocking = tracer.trace(world_of(*objects, lights=[sun], shadows="block"), ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert (ends(blocking)[1], blocking.object_name(1), blocking.nodes["t"][1]) == ("blocked", "glass", 2.0)


def test_nothing_behind_the_light_shades() -> None:
    lamp = Light("lamp", position=(0.0, 5.0, 0.0))
    world = world_of(plane((0, 0, 0), (0, 1, 0)), ball((0, 9, 0), 1), lights=[lamp])
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert ends(tree) == ["surface", "lit"]

"""Cones and discs of any size and in the mirror: the same trees, bit for bit."""

import numpy as np
import pytest

import tracer
from tests.scenes import cone, disc, random_cone, world_of
from tests.tracer.test_scale import LENGTHS, scaled
from tracer.scene import Light, Material, Object

GLASS = Material("glass", diffuse=0.2, specular=0.2, shininess=5, reflect=0.3, transmit=0.7, ior=1.5)


def zoo(turn: np.ndarray) -> tuple[list[Object], list[Light]]:
    """Cones of every kind and discs, mirrors and glass, leaning about; `turn`: signs of the axes."""
    random = np.random.default_rng(5)
    objects = []
    for k in range(10):
        shape = random_cone(random, k)
        material = GLASS if k % 2 else Material("m", diffuse=0.5, reflect=0.5)
        objects.append(
            cone(turn * shape.base, shape.base_radius, turn * shape.apex, shape.apex_radius, material, f"{k}")
        )
        center, normal = random.normal(size=(2, 3))
        objects.append(disc(turn * center, turn * normal, random.random(), material, f"disc {k}"))
    return objects, [Light("lamp", position=tuple((turn * (2.0, 5.0, 3.0)).tolist()))]


def zoo_trees(turn: np.ndarray) -> list[tracer.RayTree]:
    objects, lights = zoo(turn)
    world = world_of(*objects, lights=lights)
    random = np.random.default_rng(6)
    trees = []
    for k in range(300):
        aim = world.bounds[k % len(objects)].mean(axis=0)
        origin = turn * random.normal(size=3) * 5.0
        trees.append(tracer.trace(world, ray=(tuple(origin), tuple(aim - origin)), depth=4))
    return trees


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_mirrored_cones_have_the_mirrored_trees(axis: int) -> None:
    turn = np.where(np.arange(3) == axis, -1.0, 1.0)
    met = set()
    for one, other in zip(zoo_trees(np.ones(3)), zoo_trees(turn), strict=True):
        assert len(one) == len(other)
        met |= {one.object_name(i) for i in range(len(one))}
        for field in one.nodes.dtype.names or ():
            sign = turn if field in ("origin", "direction", "point", "normal") else 1
            np.testing.assert_array_equal(other.nodes[field], one.nodes[field] * sign, err_msg=field)
    assert len(met) == 21  # all of them, and the background


@pytest.mark.parametrize("k", [-200, -20, 1, 37, 200])
def test_cones_of_any_size_have_the_same_trees(k: int) -> None:
    s = 2.0**k
    objects, lights = zoo(np.ones(3))
    world = world_of(*objects, lights=lights)
    other = tracer.prepare(scaled(world.scene, s))
    random = np.random.default_rng(8)
    for _ in range(200):
        o, d = random.normal(size=3) * 5.0, random.normal(size=3)
        d = 0.7 * d - 0.3 * o
        one, two = (tracer.trace(w, ray=(tuple(f * o), tuple(d)), depth=4) for w, f in ((world, 1.0), (other, s)))
        assert len(one) == len(two)
        for field in one.nodes.dtype.names or ():
            factor = s if field in LENGTHS else 1
            np.testing.assert_array_equal(two.nodes[field], one.nodes[field] * factor, err_msg=field)

"""The hierarchy against trying all surfaces."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import tracer
from tests.scenes import MATTE, ball, world_of
from tracer.bvh import FLAT, build
from tracer.nodes import BACKGROUND
from tracer.scene import Object
from tracer.shapes.polygon import Polygon

spread = st.floats(-10, 10)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(spread, spread, spread, st.floats(0.01, 3)), min_size=FLAT + 1, max_size=60),
    st.lists(st.tuples(spread, spread, spread, spread, spread, spread), min_size=5, max_size=5),
)
def test_hierarchy_finds_what_trying_all_surfaces_finds(balls: list, rays: list) -> None:
    """The same table with and without it, to the last bit."""
    objects = [ball((x, y, z), r, MATTE, f"ball {k}") for k, (x, y, z, r) in enumerate(balls)]
    world = world_of(*objects)
    assert len(world.arrays.hierarchy) > 1
    for ox, oy, oz, dx, dy, dz in rays:
        if max(abs(dx), abs(dy), abs(dz)) < 1e-6:
            continue
        tree = tracer.trace(world, ray=((ox, oy, oz), (dx, dy, dz)), depth=0)
        best = min((t, k) for k in range(len(balls)) for t in [_alone(objects[k], (ox, oy, oz), (dx, dy, dz))])
        if math.isinf(best[0]):
            assert tree.nodes["end"][0] == BACKGROUND
        else:
            assert (tree.nodes["t"][0], tree.object_name(0)) == (best[0], f"ball {best[1]}")


def test_hierarchy_holds_every_surface_once_inside_its_boxes() -> None:
    random = np.random.default_rng(8)
    low = random.uniform(-5, 5, (3000, 3))
    bounds = np.stack([low, low + random.exponential(0.3, (3000, 3))], axis=1)
    bounds[:200] = bounds[0]  # many at one place
    boxes, order = build(bounds)
    assert sorted(order.tolist()) == list(range(3000))
    seen = []
    waiting = [(0, 0)]
    deepest = 0
    while waiting:
        k, depth = waiting.pop()
        deepest = max(deepest, depth)
        row = boxes[k]
        if row["count"]:
            inside = order[row["second"] : row["second"] + row["count"]]
            seen += inside.tolist()
            assert (bounds[inside, 0] >= row["low"]).all()
            assert (bounds[inside, 1] <= row["high"]).all()
        else:
            for child in (k + 1, row["second"]):
                assert (boxes[child]["low"] >= row["low"]).all()
                assert (boxes[child]["high"] <= row["high"]).all()
                waiting.append((child, depth + 1))
    assert sorted(seen) == list(range(3000))
    assert deepest < 64


def test_of_surfaces_at_one_distance_the_files_first_is_met() -> None:
    """Twelve sheets in one plane, each on its own side of the ray, so that the hierarchy parts them."""
    turn = np.linspace(0.0, 6.0, 12)
    square = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
    sheets = [
        Object(Polygon(tuple((x + math.cos(a), y + math.sin(a), 0.0) for x, y in square)), MATTE, f"sheet {k}")
        for k, a in enumerate(turn)
    ]
    for order in ([*range(12)], [*range(12)][::-1], [5, 9, 0, 11, 3, 7, 1, 10, 2, 8, 4, 6]):
        world = world_of(*(sheets[k] for k in order))
        assert len(world.arrays.hierarchy) > 0
        tree = tracer.trace(world, ray=((0.05, 0.02, 3), (0, 0, -1)), depth=0)
        assert tree.object_name(0) == f"sheet {order[0]}"


def _alone(item: Object, origin: tuple, direction: tuple) -> float:
    t = float(tracer.trace(world_of(item), ray=(origin, direction), depth=0).nodes["t"][0])
    return math.inf if math.isnan(t) else t

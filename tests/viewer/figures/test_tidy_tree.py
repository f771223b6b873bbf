"""Positions of the nodes of a tree: no overlap, reflected left, refracted right, equal subtrees look equal."""

import itertools

import numpy as np
from hypothesis import given, settings, strategies as st

import tracer
from tests.conftest import LESSONS
from tests.scenes import box, world_of
from tracer.kernel.nodes import REFRACTION, SHADOW
from tracer.scene import Light, Material
from tracer.tree.text import heaviest_rows
from viewer.figures.layout.planned_rays import PlannedRays
from viewer.figures.layout.tidy_tree import Place, Spacing, tidy_layout

LEFT, RIGHT, STUB_HALF = 0.5, 0.5, 0.16
ROOM = Spacing(LEFT, RIGHT, 2.0 * STUB_HALF, STUB_HALF, sides=True, passes=0.9)


def plates(count: int, depth: int, lights: int) -> tracer.RayTree:
    glass = Material("glass", diffuse=0.1, reflect=0.2, transmit=0.8, ior=1.5)
    faces = [box((-9, -9, 2.0 * k), (9, 9, 2.0 * k + 1), glass) for k in range(count)]
    lamps = [Light(f"lamp {j}", position=(float(j), 5.0, 30.0)) for j in range(lights)]
    world = world_of(*faces, lights=lamps)
    return tracer.trace(world, ray=((0.3, 0.1, 9), (0.1, 0.05, -1)), depth=depth)


def places_of(tree: tracer.RayTree) -> dict[int, Place]:
    rows = frozenset(range(len(tree)))
    return tidy_layout(PlannedRays([tree], rows), set(rows), ROOM).places


def check(tree: tracer.RayTree, places: dict[int, Place]) -> None:
    kinds = tree.nodes["kind"]
    levels: dict[float, list[tuple[float, int]]] = {}
    for i, place in places.items():
        levels.setdefault(place.y, []).append((place.x, i))
        assert place.y == tree.nodes["depth"][i] + (0.5 if kinds[i] == SHADOW else 0.0)
    for level in levels.values():
        for (x0, i), (x1, j) in itertools.pairwise(sorted(level)):
            room = (STUB_HALF if kinds[i] == SHADOW else RIGHT) + (STUB_HALF if kinds[j] == SHADOW else LEFT)
            assert x1 - x0 >= room - 1e-9, (i, j)
    for i in places:
        rays = [child for child in tree.children[i] if child in places and kinds[child] != SHADOW]
        for child in rays:
            if kinds[child] == REFRACTION:
                assert places[child].x > places[i].x
            else:
                assert places[child].x < places[i].x
        if len(rays) == 2:
            assert abs(places[rays[0]].x + places[rays[1]].x - 2 * places[i].x) < 1e-9


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 3), st.integers(0, 7), st.integers(0, 3))
def test_random_trees(count: int, depth: int, lights: int) -> None:
    tree = plates(count, depth, lights)
    check(tree, places_of(tree))


def test_trees_of_the_lessons(worlds: dict[str, tracer.World]) -> None:
    for name in LESSONS:
        for pixel in ((400, 300), (300, 200), (560, 330), (700, 320)):
            image = worlds[name].scene.image
            inside = (min(pixel[0], image.width - 1), min(pixel[1], image.height - 1))
            tree = tracer.trace(worlds[name], inside, depth=4)
            check(tree, places_of(tree))


def test_same_subtree_looks_the_same_wherever_it_stands() -> None:
    """The subtrees in a pile of plates repeat: positions of their nodes differ by a translation only."""
    tree = plates(2, 7, 2)
    places = places_of(tree)
    seen: dict[tuple, list[tuple[float, float]]] = {}
    for i in range(len(tree)):
        rows = below(tree, i)
        shape = tuple((tree.kind(row), tree.nodes["depth"][row] - tree.nodes["depth"][i]) for row in rows)
        offsets = [(places[row].x - places[i].x, places[row].y - places[i].y) for row in rows]
        expected = seen.setdefault(shape, offsets)
        assert np.allclose(offsets, expected, atol=1e-9)
    assert len(seen) < len(tree) / 2


def below(tree: tracer.RayTree, i: int) -> list[int]:
    rows = [i]
    for child in tree.children[i]:
        rows += below(tree, child)
    return rows


def test_growing_tree_is_laid_out_for_its_full_depth() -> None:
    """Positions of the deepest tree serve all shallower ones, since these are its first rows."""
    deep = plates(2, 6, 1)
    places = places_of(deep)
    for depth in range(6):
        shallow = plates(2, depth, 1)
        assert (deep.nodes["id"][: len(shallow)] == shallow.nodes["id"]).all()
        check(shallow, {i: places[i] for i in range(len(shallow))}) if len(shallow) == len(deep) else None
        assert set(range(len(shallow))) <= set(places)


def test_of_a_large_tree_the_heaviest_rays_are_kept_with_their_parents() -> None:
    tree = plates(3, 12, 2)
    kept = heaviest_rows(tree, 100, set(range(len(tree))))
    assert len(kept) <= 100
    parents = tree.nodes["parent"]
    assert all(i == 0 or int(parents[i]) in kept for i in kept)
    weights = tree.nodes["weight"].max(axis=1)
    rays = [i for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW]
    lightest = min(weights[i] for i in kept if i in set(rays))
    assert all(weights[i] <= lightest for i in rays if i not in kept)
    assert heaviest_rows(tree, len(tree), set(range(len(tree)))) == set(range(len(tree)))

"""Decision margins: every decision that the judge takes otherwise had a margin below 1, and only few others have."""

import math
from collections.abc import Callable

import numpy as np
import pytest

import tracer
from tests.compared_trees import compared, judged_ray
from tests.planted_rays import planted_ray
from tests.random_scenes import random_scene, stiff_scene
from tests.scenes import DARK, GLASS, MATTE, MIRROR, ball, box, disc, plane, polygon, world_of
from tracer.scene import Light, Material, Object, Scene
from tracer.scene.scene import Checker
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Geometry, Mesh


def undetected(scenes: Callable[[int], Scene], seeds: range) -> tuple[int, int, list[tuple[int, int, float]]]:
    """(planted trees, decisions that differ from the judge's, those with a margin of 1 or more) of rays aimed at
    outlines.
    """
    trees, differ, missed = 0, 0, []
    for seed in seeds:
        scene = scenes(seed)
        world = tracer.prepare(scene)
        ray = planted_ray(seed, scene, world)
        if ray is None:
            continue
        trees += 1
        tree = tracer.trace(world, ray=ray, depth=3)
        margin = tree.margins.margin
        above: dict[int, bool] = {}
        for pair in compared(tree, judged_ray(world, tree)):
            parent = int(tree.nodes["parent"][pair.row])
            excused = above.get(parent, False)  # a ray above it could have gone otherwise
            above[pair.row] = excused or margin[pair.row] < 1.0
            if not pair.agrees:
                differ += 1
                if not above[pair.row]:
                    missed.append((seed, pair.row, float(margin[pair.row])))
    return trees, differ, missed


@pytest.mark.parametrize("scenes", [random_scene, pytest.param(stiff_scene, marks=pytest.mark.slow)])
def test_what_the_judge_decides_otherwise_had_a_margin_below_1(scenes: Callable[[int], Scene]) -> None:
    trees, differ, missed = undetected(scenes, range(250))
    assert trees > 200
    assert differ > 5
    assert missed == []


@pytest.mark.slow
@pytest.mark.timeout(1500)
@pytest.mark.parametrize("scenes", [random_scene, stiff_scene])
def test_many_planted_rays(scenes: Callable[[int], Scene]) -> None:
    _, differ, missed = undetected(scenes, range(40_000, 48_000))
    assert differ > 200
    assert missed == []


@pytest.mark.slow
def test_in_random_scenes_few_rows_could_have_gone_otherwise() -> None:
    rows = low = 0
    for seed in range(1500):
        world = tracer.prepare(random_scene(seed))
        random = np.random.default_rng(seed)
        tree = tracer.trace(world, (int(random.integers(32)), int(random.integers(24))))
        rows += len(tree)
        low += len(tree.doubts)
    assert low <= 1e-4 * rows


def decision(tree: tracer.RayTree, row: int = 0) -> str:
    return dict(tree.doubts).get(row, "")


SQUARE = polygon(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)), MATTE, "square")
TRIANGLES = Geometry(np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))


@pytest.mark.parametrize(
    ("item", "aim", "expected"),
    [
        (SQUARE, (1, 0.3), "the edge of square"),
        (SQUARE, (0.7, 0.3), ""),
        (box((-1, -1, -1), (1, 1, 0), MATTE, "block"), (1, 0.3), "the edge of block"),
        (disc((0, 0, 0), (0, 0, 1), 1.0, MATTE, "disc"), (0.6, 0.8), "the edge of disc"),
        (ball((0, 0, 0), 1.0, MATTE, "ball"), (0.6, 0.8), "the silhouette of ball"),
        (Object(Cone((0, -2, 0), 1.0, (0, 2, 0), 1.0), MATTE, "tube"), (1, 0.3), "the silhouette of tube"),
        (Object(Mesh(TRIANGLES), MATTE, "mesh"), (0.3, 0.3), "the edge of mesh"),
    ],
)
def test_a_ray_at_the_outline(item: Object, aim: tuple[float, float], expected: str) -> None:
    """The ray is parallel to the z axis."""
    tree = tracer.trace(world_of(item), ray=((*aim, 5), (0, 0, -1)), depth=0)
    assert decision(tree) == expected


def test_a_ray_along_a_plane() -> None:
    tree = tracer.trace(world_of(plane((0, 0, 0), (0, 1, 0), MATTE, "floor")), ray=((0, 1, 0), (1, 0, 0)), depth=0)
    assert decision(tree) == "whether the ray runs towards floor or away"


def test_two_surfaces_at_one_distance() -> None:
    """A tie where two planes cross is a decision; faces in one plane are one interface, and no decision."""
    slanted = plane((0, 0, 0), (1, 0, 2), MATTE, "slanted")
    tie = tracer.trace(world_of(SQUARE, slanted), ray=((0, 0.3, 5), (0, 0, -1)), depth=0)
    assert decision(tie).startswith("which surface comes first, here or ")
    together = world_of(SQUARE, box((-1, -1, -1), (1, 1, 0), MATTE, "block"), plane((0, 0, 0), (0, 0, 3), MATTE))
    assert decision(tracer.trace(together, ray=((0.2, 0.3, 5), (0, 0, -1)), depth=0)) == ""


def test_a_ray_that_starts_where_another_surface_begins() -> None:
    """In the corner of two mirrors: the reflected ray meets the second one at once, or has met it already."""
    world = world_of(plane((0, 0, 0), (0, 0, 1), MIRROR, "back"), plane((0, 0, 0), (1, 0, 0), MIRROR, "side"))
    tree = tracer.trace(world, ray=((1, 0, 1), (-1, 0, -1)), depth=1)
    assert decision(tree, 0).startswith("which surface comes first, here or ")
    assert decision(tree, 1).startswith(("whether the ray starts before or behind ", "which surface comes first, "))


def test_at_the_critical_angle() -> None:
    """sin = 3/4 for n = 4/3, by a ray whose direction is rounded."""
    water = plane((0, 0, 0), (0, 1, 0), Material("water", transmit=1.0, ior=4.0 / 3.0), "water")
    for aside, expected in ((0.0, "total internal reflection or not"), (1e-9, "")):
        way = (0.75 + aside, math.sqrt(1.0 - (0.75 + aside) ** 2), 0.0)
        assert decision(tracer.trace(world_of(water), ray=((0, -1, 0), way), depth=1)) == expected


def test_at_the_border_of_a_checker() -> None:
    tiles = Material("tiles", diffuse=1.0, ambient=1.0, checker=Checker((0.0, 0.0, 0.0), 0.5))
    world = world_of(plane((0, 0, 0), (0, 1, 0), tiles))
    for x, expected in ((1.5, "the border of two colours of the checker"), (1.4, "")):
        assert decision(tracer.trace(world, ray=((x, 1, 0.2), (0, -1, 0)), depth=0)) == expected


def test_shadow_rays() -> None:
    """At the edge of a shadow, and at a light on the horizon."""
    shade = polygon(((-1, 1, -1), (1, 1, -1), (1, 1, 1), (-1, 1, 1)), DARK, "shade")
    floor = plane((0, 0, 0), (0, 1, 0), MATTE, "floor")
    lights = [Light("lamp", position=(0.0, 2.0, 0.0)), Light("sun", direction=(1.0, 0.0, 0.0))]
    tree = tracer.trace(world_of(floor, shade, lights=lights), ray=((2, 0.5, 0.3), (0, -1, 0)), depth=0)
    assert decision(tree, 0) == ""
    assert decision(tree, 1) == "the edge of shade"
    assert decision(tree, 2) == "whether the surface faces the light"


def test_a_margin_is_the_distance_in_units_of_the_error() -> None:
    """Twice as far from the edge, twice the margin; and it is the same at every depth."""
    margins = []
    for gap in (1e-12, 2e-12):
        tree = tracer.trace(world_of(SQUARE), ray=((1 - gap, 0.3, 5), (0, 0, -1)), depth=0)
        margins.append(float(tree.margins.margin[0]))
    assert margins[1] == pytest.approx(2.0 * margins[0], rel=1e-3)
    world = world_of(ball((0, 0, 0), 1.0, GLASS), plane((0, -1, 0), (0, 1, 0), MIRROR, "floor"))
    deep, shallow = (tracer.trace(world, ray=((0.3, 0.2, 5), (0, 0, -1)), depth=d).margins.margin for d in (4, 2))
    assert deep[: len(shallow)].tolist() == shallow.tolist()


def test_some_rows_have_the_margins_of_all() -> None:
    tree = tracer.trace(tracer.prepare(random_scene(7)), (16, 12))
    rows = np.arange(0, len(tree), 2)
    assert tree.margins_of(rows).margin.tolist() == tree.margins.margin[rows].tolist()

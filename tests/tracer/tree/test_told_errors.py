"""The told error of every number of a tree is never below its true one, which a judge with 50 digits knows."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from mpmath import mp, mpf

import tracer
from tests.compared_trees import compared, judged_pixel, judged_ray
from tests.exact_scene import norm, sub, vec
from tests.random_scenes import random_scene, stiff_scene
from tests.scenes import MATTE, world_of
from tracer.kernel.nodes import SHADOW
from tracer.scene import Camera, Image, Object, Scene
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.sphere import Sphere


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    """The differences from the judge's numbers are computed with as many digits as these have."""
    with mp.workdps(50):
        yield


def ratios(tree: tracer.RayTree, world: tracer.World) -> Iterator[tuple[str, float]]:
    """(name of a number, its true error over the told one) for all rows up to the first decision within rounding."""
    ray = judged_pixel(world, tree) if tree.ray is None else judged_ray(world, tree)
    doubtful = {i for i, _ in tree.doubts}
    for pair in compared(tree, ray):
        if not pair.agrees or pair.row in doubtful:
            return
    for i, one, _, whole in compared(tree, ray):
        row = tree.nodes[i]
        if row["kind"] == SHADOW:
            continue
        yield "direction", over(norm(sub(vec(row["direction"]), one.direction)), row["turn"])
        yield "factor", over(abs(mpf(row["factor"][0]) - one.factor), row["factor_error"])
        yield "weight", over(abs(mpf(row["weight"][0]) - one.weight), row["weight_error"])
        if whole:
            off = max(abs(mpf(a) - b) for a, b in zip(row["radiance"], one.radiance, strict=True))
            yield "radiance", over(off, row["radiance_error"])
        if one.t is not None:
            shape = tree.scene.objects[one.object].shape
            smooth = isinstance(shape, Mesh) and shape.geometry.normals is not None
            yield "smooth mesh" if smooth else shape.name, over(norm(sub(vec(row["point"]), one.point)), row["error"])


def over(true: mpf, told: float) -> float:
    if math.isinf(told):
        return 0.0
    return float(true / told) if told > 0.0 else (0.0 if true == 0 else math.inf)


def worst(scenes: Callable[[int], Scene], seeds: range) -> dict[str, list[float]]:
    found: dict[str, list[float]] = defaultdict(list)
    for seed in seeds:
        world = tracer.prepare(scenes(seed))
        random = np.random.default_rng(seed)
        tree = tracer.trace(world, (int(random.integers(32)), int(random.integers(24))))
        for name, ratio in ratios(tree, world):
            found[name].append(ratio)
    return found


@pytest.mark.parametrize("scenes", [random_scene, stiff_scene])
def test_no_number_is_farther_off_than_told(scenes: Callable[[int], Scene]) -> None:
    found = worst(scenes, range(300))
    assert len(found) == 13
    assert max(max(own) for own in found.values()) <= 1.0


@pytest.mark.slow
@pytest.mark.timeout(1500)
@pytest.mark.parametrize("scenes", [random_scene, stiff_scene])
def test_no_number_of_a_hundred_thousand_is_farther_off_than_told(scenes: Callable[[int], Scene]) -> None:
    """And the median is not told more than some hundred times too large."""
    found = worst(scenes, range(1000, 15000))
    assert sum(map(len, found.values())) > 100_000
    for name, own in found.items():
        assert max(own) <= 1.0, name
        some = [ratio for ratio in own if ratio > 0.0]
        assert np.median(some) > 1e-3, name


@pytest.mark.parametrize("size", [10.0, 1e3, 1e9, 1e15])
@pytest.mark.parametrize("kind", ["cone", "cylinder", "sphere"])
def test_a_large_shape_beside_a_near_eye(kind: str, size: float) -> None:
    shape = {
        "cone": Cone((size, -size, 0.0), size, (size, size, 0.0), 0.5 * size),
        "cylinder": Cone((size, -size, 0.0), size, (size, size, 0.0), size),
        "sphere": Sphere((size, 0.0, 0.0), size),
    }[kind]
    world = world_of(Object(shape, MATTE, kind))
    for aside in (0.1, 0.3, 0.7):
        tree = tracer.trace(world, ray=((-1.0, 0.2, 0.1), (1.0, 0.1, aside)), depth=0)
        assert tree.object_name(0) == kind
        assert all(ratio <= 1.0 for _, ratio in ratios(tree, world))


def test_a_mesh_that_is_moved_back_from_far_away_is_as_exact_as_one_that_is_near() -> None:
    """Its vertices are rounded once, after the placement; that they were near 1e8 costs nothing."""
    corners = np.array([[100000003.0, 0, 0], [100000003.0, 1, 0], [100000003.0, 0, 1]])
    mesh = Mesh(Geometry(corners, np.array([[0, 1, 2]])), "mesh", 0.1, (0.0, 0.0, 0.0), (-1e7, 0.0, 0.0))
    world = world_of(Object(mesh, MATTE, "mesh"))
    tree = tracer.trace(world, ray=((5.0, 0.02, 0.02), (-1.0, 0.0, 0.0)), depth=0)
    x = mpf(100000003) * mpf(0.1) - mpf(1e7)
    assert abs(mpf(tree.nodes["point"][0][0]) - x) <= tree.nodes["error"][0] < 4e-15


@pytest.mark.parametrize("tilt", [1.0, 1e-3, 1e-6, 1e-9])
def test_a_camera_that_looks_nearly_along_its_up(tilt: float) -> None:
    """The turn about the line of sight has the condition number 1 / tilt."""
    camera = Camera((1.0, 5.0, 2.0), (0.3, 0.1, 0.2), (0.7 + tilt, 4.9, 1.8), 50.0)
    world = world_of(Object(Sphere((0.0, -30.0, 0.0), 30.0), MATTE, "ground"), camera=camera, image=Image(64, 48))
    for pixel in ((0, 0), (63, 0), (20, 47)):
        tree = tracer.trace(world, pixel)
        assert all(ratio <= 1.0 for _, ratio in ratios(tree, world))
        assert tree.nodes["turn"][0] < 100.0 * 2.0**-53 * (1.0 + 1.0 / tilt)

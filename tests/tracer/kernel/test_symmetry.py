"""Mirrored scenes have mirrored trees, and a path traced backwards meets the same points."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import tracer
from tests.scenes import cone, disc, random_cone, world_of
from tests.tracer.kernel.test_best_first import random_world
from tests.tracer.kernel.test_scale import LENGTHS, scaled
from tracer.formulas.rotation import rotation_matrix as turn_of
from tracer.formulas.vector import Vector, vector
from tracer.scene import Light, Material, Object, Scene, Shape
from tracer.shapes.box import Box
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere

GLASS = Material("glass", diffuse=0.2, specular=0.2, shininess=5, reflect=0.3, transmit=0.7, ior=1.5)


def zoo(turn: np.ndarray) -> tuple[list[Object], list[Light]]:
    """Cones of every kind and discs, reflecting and transparent, at random tilts. `turn`: signs of the axes."""
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


def mirrored(scene: Scene, turn: np.ndarray) -> Scene:
    """The scene with the signs of some axes negated. Meshes and outlines are reversed to face outwards."""

    flips = turn.prod() < 0.0

    def place(point: Vector | None) -> Vector | None:
        return None if point is None else vector((turn * point).tolist())

    def shape(one: Shape) -> Shape:
        match one:
            case Sphere():
                return replace(one, center=place(one.center))
            case Plane():
                return replace(one, point=place(one.point), normal=place(one.normal))
            case Box():
                low, high = turn * one.min, turn * one.max
                return Box(vector(np.minimum(low, high).tolist()), vector(np.maximum(low, high).tolist()))
            case Polygon():
                first, *others = ((turn * corner).tolist() for corner in one.vertices)
                return Polygon(tuple(map(vector, (first, *(reversed(others) if flips else others)))))
            case Mesh():
                # Keep the first corner of each face, so that the same numbers are computed with.
                geometry = one.geometry
                normals = None if geometry.normals is None else geometry.normals @ turn_of(one.rotate).T * turn
                corners = one.scale * geometry.vertices @ turn_of(one.rotate).T + one.translate
                return Mesh(
                    Geometry(corners * turn, geometry.faces[:, [0, 2, 1]] if flips else geometry.faces, normals),
                    one.file,
                )
        raise TypeError(one)

    lights = tuple(
        replace(light, position=place(light.position), direction=place(light.direction)) for light in scene.lights
    )
    objects = tuple(
        replace(item, shape=shape(item.shape), material=replace(item.material, checker=None)) for item in scene.objects
    )
    return replace(scene, objects=objects, lights=lights)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_mirrored_lesson_has_the_mirrored_trees(world: tracer.World, axis: int) -> None:
    """Checkers are left out: their squares count from 0 upwards and have no mirror image."""
    turn = np.where(np.arange(3) == axis, -1.0, 1.0)
    one, other = (tracer.prepare(mirrored(world.scene, signs)) for signs in (np.ones(3), turn))
    width, height = world.scene.image.width, world.scene.image.height
    for x in range(11, width, 113):
        for y in range(7, height, 101):
            row = tracer.trace(world, (x, y), depth=0).nodes[0]
            ray = (row["origin"], row["direction"])
            trees = [tracer.trace(one, ray=ray), tracer.trace(other, ray=(turn * ray[0], turn * ray[1]))]
            assert len(trees[0]) == len(trees[1])
            for field in trees[0].nodes.dtype.names or ():
                sign = turn if field in ("origin", "direction", "point", "normal") else 1
                expected = trees[0].nodes[field] * sign
                np.testing.assert_array_equal(trees[1].nodes[field], expected, err_msg=f"{field} at {x},{y}")


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.integers(0, 10**9), st.integers(-200, 200))
def test_random_scene_of_any_size_has_the_same_trees(seed: int, k: int) -> None:
    world, s = random_world(seed), 2.0**k
    other = tracer.prepare(scaled(world.scene, s))
    random = np.random.default_rng(seed)
    o, d = random.uniform(-4, 4, 3), random.normal(size=3)
    one, two = (tracer.trace(w, ray=(tuple(f * o), tuple(d)), depth=5) for w, f in ((world, 1.0), (other, s)))
    assert len(one) == len(two)
    for field in one.nodes.dtype.names or ():
        factor = s if field in LENGTHS else 1
        np.testing.assert_array_equal(two.nodes[field], one.nodes[field] * factor, err_msg=field)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, 10**9))
def test_light_finds_its_way_back(seed: int) -> None:
    """A path that is reversed at its end meets the same points in the opposite order, within their own error bounds."""
    world = random_world(seed)
    random = np.random.default_rng(seed)
    tree = tracer.trace(world, ray=(tuple(random.uniform(-4, 4, 3)), tuple(random.normal(size=3))), depth=4)
    leaves = [i for i in range(len(tree)) if tree.end(i) == "background" and tree.nodes["depth"][i] > 0]
    for leaf in leaves[:3]:
        rows = []
        i = int(tree.nodes["parent"][leaf])
        while i >= 0:
            rows.append(tree.nodes[i])
            i = int(tree.nodes["parent"][i])
        last = tree.nodes[leaf]
        start = last["origin"] + 4.0 * last["direction"]
        back = tracer.trace(world, ray=(start, -last["direction"]), depth=len(rows))
        here = [0]
        for row in rows:
            sure = 64 * max(1e-15, float(row["error"]) * (1.0 + float(last["error"]) / float(rows[-1]["error"])))
            here = [
                k
                for k in here
                if np.isfinite(back.nodes["t"][k]) and np.abs(back.nodes["point"][k] - row["point"]).max() <= sure
            ]
            assert here, f"lost at {row['point']}"
            here = [child for k in here for child in back.children[k] if back.kind(child) != "shadow"]

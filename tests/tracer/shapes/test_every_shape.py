"""Rules for every shape, tested on its `example()`. A new shape is covered here without a change to this file."""

import math
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp, mpf

import tracer
from tests.exact import SURFACES, exact, unit
from tests.exact_scene import SHAPES as EXACT_SHAPES
from tests.judge import exact_step, off
from tests.povray import WRITERS
from tests.scenes import DARK, world_of
from tests.tracer.image.test_against_povray import agrees
from tracer.formats import load
from tracer.scene import Background, Camera, Checker, Image, Light, Material, Object, Scene
from tracer.shapes import SHAPE_NAMES, SHAPES
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.shape import Shape

U = 2.0**-53
RAYS = 400
MATTE = Material("matte", color=(0.9, 0.6, 0.3), ambient=0.2, diffuse=0.7, specular=0.2, shininess=20.0)


@pytest.fixture(params=SHAPES, ids=SHAPE_NAMES)
def shape(request: pytest.FixtureRequest) -> Shape:
    return request.param.example()


def aimed(seed: int = 1) -> list[tuple[tuple[float, ...], tuple[float, ...]]]:
    """Rays from a distance of 4, each towards a point near the origin, where the examples stand."""
    random = np.random.default_rng(seed)
    found = []
    for _ in range(RAYS):
        origin = random.normal(size=3)
        origin *= 4.0 / np.linalg.norm(origin)
        found.append((tuple(origin.tolist()), tuple((random.uniform(-1, 1, 3) - origin).tolist())))
    return found


def first_hits(shape: Shape, material: Material = DARK) -> list[tracer.RayTree]:
    world = world_of(Object(shape, material, "it"))
    return [tracer.trace(world, ray=ray, depth=0) for ray in aimed()]


def test_tables_of_the_judge_and_of_the_writer_for_povray_name_every_shape() -> None:
    assert set(SURFACES) == set(EXACT_SHAPES) == set(SHAPE_NAMES)
    assert set(WRITERS) == set(SHAPE_NAMES)


def test_example_is_a_valid_scene(shape: Shape) -> None:
    assert Scene((Object(shape, DARK),)).faults() == []


# The triangles of a mesh come from a file of their own: tests/tracer/formats/test_meshes.py.
@pytest.mark.parametrize("kind", [kind for kind in SHAPES if kind is not Mesh], ids=lambda kind: kind.name)
def test_scene_file_says_the_same(kind: type[Shape], tmp_path: Path) -> None:
    shape = kind.example()
    keys = [f"{item.name} = {as_toml(getattr(shape, item.name))}" for item in fields(shape)]  # type: ignore[arg-type]
    path = tmp_path / "scene.toml"
    path.write_text("\n".join(["format = 1", "[[object]]", f'shape = "{shape.name}"', *keys]))
    assert load(path).objects[0].shape == shape


def as_toml(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else repr(value).replace("(", "[").replace(")", "]")


def test_a_shape_in_one_plane_is_not_curved(shape: Shape) -> None:
    """Flat faces coincide where their planes do; curved shapes only where they are equal."""
    assert not (shape.plane() is not None and shape.curved)


def test_hits_are_exact(shape: Shape) -> None:
    """Point, distance and normal against the judge's, in rounding units times the sizes and the slant."""
    count = 0
    for tree in first_hits(shape):
        row = tree.nodes[0]
        if row["object"] < 0:
            continue
        true = exact_step(tree, 0)
        reach = 32.0 * U * (12.0 + abs(float(true.t))) / abs(math.cos(float(true.theta1)))
        assert off(row["t"], true.t) <= reach
        assert off(row["point"], true.point) <= reach
        assert off(row["normal"], true.normal) <= 64.0 * U
        assert abs(mp.norm(exact(row["normal"])) - 1) <= 4.0 * U
        assert mp.fdot(exact(row["normal"]), unit(exact(row["direction"]))) <= mpf(4.0 * U)
        count += 1
    assert count > RAYS / 20


def test_triangles_of_the_3d_view_are_where_rays_hit_it(shape: Shape) -> None:
    """The triangles of the 3D view, traced as a mesh, are hit where the shape is hit, except near its rim."""
    corners, normals = shape.triangles(np.zeros(3), 2.0)
    assert corners.shape == normals.shape and corners.shape[1:] == (3, 3)
    own = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    solid = (own * own).sum(axis=1) > 0.0  # at the poles of a ball, triangles have no area
    corners, normals, own = corners[solid], normals[solid], own[solid]
    mesh = Mesh(Geometry(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)))
    agreed = hits = 0
    for tree, other in zip(first_hits(shape), first_hits(mesh), strict=True):
        row, near = tree.nodes[0], other.nodes[0]
        hits += row["object"] >= 0
        if row["object"] < 0 or near["object"] < 0:
            agreed += row["object"] == near["object"]
        else:
            agreed += math.dist(row["point"], near["point"]) < 0.05 and row["normal"] @ near["normal"] > 0.95
    assert agreed > 0.97 * RAYS and hits > RAYS / 20
    # The order of their corners and their normals point outwards.
    assert ((own[:, None] * normals).sum(axis=2) > 0.0).all()
    if shape.is_closed() and shape.bounds() is not None:
        assert ((corners.mean(axis=1) * own).sum(axis=1) > 0.0).mean() > 0.9


def test_bounds_plane_and_inside_agree_with_the_hits(shape: Shape) -> None:
    boxes, plane = shape.bounds(), shape.plane()
    world = world_of(Object(shape, Material("glass", transmit=1.0, ior=1.0), "it"))
    for ray in aimed(2):
        nodes = tracer.trace(world, ray=ray, depth=2).nodes
        points = nodes["point"][nodes["object"] >= 0]
        for point in points:
            if boxes is not None:
                assert ((boxes[:, 0] - 8 * U <= point) & (point <= boxes[:, 1] + 8 * U)).all(axis=1).any()
            if plane is not None:
                assert abs(np.dot(np.subtract(point, plane[0]), plane[1])) <= 16 * U
        if shape.is_closed() and boxes is not None and len(points) > 1 and math.dist(points[0], points[1]) > 1e-6:
            assert shape.contains(0.5 * (points[0] + points[1]))
            assert not shape.contains(np.array(ray[0]))


def test_checker_has_two_colours_in_squares_on_its_own_plane(shape: Shape) -> None:
    size = 0.3
    tiles = Material("tiles", (1.0, 1.0, 1.0), ambient=1.0, checker=Checker((0.0, 0.0, 0.0), size))
    axes = world_of(Object(shape, tiles)).arrays.objects[0]
    seen = set()
    for tree in first_hits(shape, tiles):
        point = tree.nodes["point"][0]
        if tree.nodes["object"][0] < 0:
            continue
        places = (axes.u @ point, axes.v @ point) if shape.checker_in_plane else tuple(point)
        if min(abs(place / size - round(place / size)) for place in places) > 1e-9:
            odd = sum(math.floor(place / size) for place in places) % 2
            assert tree.radiance.tolist() == [1.0 - odd] * 3
            seen.add(odd)
    assert seen == {0, 1}
    if shape.checker_in_plane and (plane := shape.plane()):
        assert abs(np.dot(axes.u, plane[1])) <= 4 * U and abs(np.dot(axes.v, plane[1])) <= 4 * U


def test_image_agrees_with_povray(shape: Shape, tmp_path: Path) -> None:
    lights = (Light("lamp", position=(3.0, 6.0, 5.0), color=(0.8, 0.8, 0.8)),)
    camera = Camera((1.5, 2.0, 4.0), (0.0, 0.0, 0.0))
    background = Background((0.2, 0.3, 0.4))
    agrees(Scene((Object(shape, MATTE, "it"),), lights, camera, Image(320, 240), background), tmp_path)


def test_trees_are_verified(shape: Shape) -> None:
    """Rays at the shape are certified, inside and out."""
    glass = Material("glass", transmit=0.8, reflect=0.1, ior=1.3, diffuse=0.1)
    world = world_of(Object(shape, glass, "it"), lights=[Light("lamp", position=(3.0, 4.0, 5.0))])
    met = 0
    for origin, direction in aimed()[:40]:
        tree = tracer.trace(world, ray=(origin, direction), depth=3)
        verified = tracer.verify(world, tree)
        assert verified.certified == verified.decisions
        assert verified.tested > 0 or len(tree) == 1
        met += bool(tree.nodes["object"][0] == 0)
    assert met > 5


def test_rays_at_the_outline_have_small_margins(shape: Shape) -> None:
    """Between a ray that hits and one beside it that misses, bisected to the last bit, the margin is below 1."""
    world = world_of(Object(shape, MATTE, "it"))
    tried = 0
    for origin, direction in aimed()[:60]:
        hit, miss = np.array(direction), np.array(direction) + 3.0 * np.roll(direction, 1)
        if not (meets(world, origin, hit) and not meets(world, origin, miss)):
            continue
        for _ in range(70):
            middle = 0.5 * (hit + miss)
            hit, miss = (middle, miss) if meets(world, origin, middle) else (hit, middle)
        for way in (hit, miss):
            tree = tracer.trace(world, ray=(origin, tuple(way)), depth=0)
            assert tree.margins.margin[0] < 1.0
            tried += 1
    assert tried > 4


def meets(world: tracer.World, origin: tuple[float, ...], way: np.ndarray) -> bool:
    return bool(tracer.trace(world, ray=(origin, tuple(way)), depth=0).nodes["object"][0] == 0)

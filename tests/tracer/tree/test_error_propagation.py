"""The error that every node reports, against the same tree with 50 digits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import tracer
from tests.judge import exact_tree, off
from tests.scenes import MIRROR, ball, box, plane, random_cone, world_of
from tests.tracer.kernel.test_best_first import random_world
from tracer.formulas.vector import vector
from tracer.kernel.nodes import SHADOW
from tracer.rays import Ray, make_ray
from tracer.scene import Light, Material, Object
from tracer.shapes import interaction, intersect, normal_derivative
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.sphere import Sphere

U = 2.0**-53


def two_balls() -> tracer.RayTree:
    """A ray along the line between two mirrors: each reflection multiplies an error by 3.73."""
    a, b = np.zeros(3), np.array([1.3, 2.1, 1.7])
    world = world_of(ball(tuple(a), 1.0, MIRROR, "a"), ball(tuple(b), 1.0, MIRROR, "b"))
    return tracer.trace(world, ray=(tuple(0.5 * (a + b)), tuple(b - a)), depth=60)


def check(tree: tracer.RayTree) -> None:
    exact = exact_tree(tree)
    for i in np.flatnonzero(np.isfinite(tree.nodes["t"]) & (tree.nodes["kind"] != SHADOW)):
        row = tree.nodes[i]
        if row["error"] < 1e-3 * row["t"]:  # beyond, first order only says that the digits are lost
            assert off(row["point"], exact[i].point) <= row["error"]
        if row["turn"] < 1e-3:
            assert off(row["direction"], exact[i].direction) <= row["turn"]


@settings(max_examples=120, deadline=None, derandomize=True)
@given(st.integers(0, 10**9), st.integers(0, 6))
def test_no_point_is_farther_off_than_its_node_says(seed: int, depth: int) -> None:
    random = np.random.default_rng(seed)
    ray = (tuple(random.uniform(-4, 4, 3)), tuple(random.normal(size=3)))
    check(tracer.trace(random_world(seed), ray=ray, depth=depth, max_nodes=200))


def test_shipped_scenes(world: tracer.World) -> None:
    width, height = world.scene.image.width, world.scene.image.height
    for x, y in ((width // 2, height // 2), (width // 3, height // 2), (2 * width // 3, 2 * height // 3)):
        tree = tracer.trace(world, (x, y), depth=4)
        assert (tree.nodes["error"][np.isfinite(tree.nodes["t"])] > 0.0).all()
        assert np.nanmax(tree.nodes["error"]) < 1e-9


def test_unstable_bounce_knows_when_its_digits_are_gone() -> None:
    """True errors: about 1e-16 times 3.73 a reflection. After 28 reflections no digit is left, and the ray leaves."""
    tree = two_balls()
    exact, error = exact_tree(tree), tree.nodes["error"]
    hits = np.flatnonzero(np.isfinite(tree.nodes["t"]))
    assert 27 <= len(hits) <= 31
    for i in hits[:22]:
        assert off(tree.nodes["point"][i], exact[i].point) <= error[i]
    gone = int(np.flatnonzero(error[hits] > 1.0)[0])
    assert 24 <= gone < 29
    assert error[10] == pytest.approx(error[9] * (2 + math.sqrt(3)), rel=0.2, abs=0.0)


@pytest.mark.parametrize("slope", [1.0, 1e-3, 1e-9])
def test_error_of_a_first_hit_is_that_of_its_closed_form(slope: float) -> None:
    """On a floor at angle of incidence with cosine c, distance t, a lamp above it at L; all squares in u^2.

    A rotation by 2 moves the hit by 2 t, projected along the ray onto the floor by 1/c. The hit has 2 of its
    distance as its own error, over c. The direction to the lamp turns by the sideways movement over L, and by 2 of
    its own. The errors, 2 to the hit and 3 more to the lamp, may all add up.
    """
    floor = plane((0, 0, 0), (0, 1, 0), Material("floor", diffuse=1.0))
    world = world_of(floor, lights=[Light("lamp", position=(0.0, 4.0, 0.0))])
    tree = tracer.trace(world, ray=((-1, slope, 0), (1, -slope, 0)), depth=0)
    t, c = math.hypot(1.0, slope), slope / math.hypot(1.0, slope)
    way = 1.0 + slope + t
    moved = 4.0 * (t * t + way * way) / (c * c)
    assert tree.nodes["error"][0] == pytest.approx(U * math.sqrt(2.0 * moved), rel=1e-9, abs=0.0)
    assert tree.nodes["turn"][1] == pytest.approx(U * math.sqrt(5.0 * (moved / 16.0 + 4.0)), rel=1e-9, abs=0.0)


@pytest.mark.parametrize("gap", [1.0, 8.0])
def test_errors_of_a_straight_bounce_are_those_of_its_closed_form(gap: float) -> None:
    """To and fro across a gap L between two mirrors: a ray rotated by e hits its k-th wall k L e aside.

    Squares, in u^2: each ray has a rotation of 2, all but the first 1 more. Each hit is moved by 2 of its distance,
    L and then 2 L, as a wall is L off the origin. The errors, 2 to the first hit and 3 to each other, may all add
    up: their number times the sum of their squares, across the ray.
    """
    world = world_of(plane((0, 0, 0), (1, 0, 0), MIRROR, "left"), plane((gap, 0, 0), (-1, 0, 0), MIRROR, "right"))
    tree = tracer.trace(world, ray=((0.5 * gap, 0, 0), (1, 0, 0)), depth=50)
    for k, row in enumerate(tree.nodes):
        turned = 4.0 * (k + 0.5) ** 2 + 5.0 * sum(float(j) ** 2 for j in range(1, k + 1))
        placed = 4.0 + 16.0 * k
        errors = 2 + 3 * k
        expected = U * gap * math.sqrt(errors * (turned + placed))
        # Two eigenvalues are equal: their formula has half of the digits.
        assert row["error"] == pytest.approx(expected, rel=math.sqrt(U), abs=0.0)
        turn = U * math.sqrt(errors * (4.0 + 5.0 * k))
        assert row["turn"] == pytest.approx(turn, rel=1e-12, abs=0.0)


def test_a_hollow_mirror_keeps_its_digits() -> None:
    """Inside a mirror ball errors grow with the square of the number of reflections, not exponentially."""
    shell = world_of(ball((0, 0, 0), 1.0, MIRROR))
    a = math.radians(50)
    tree = tracer.trace(shell, ray=((0.9, 0.0, 0.0), (-math.cos(a), math.sin(a), 0.0)), depth=10_000)
    error = tree.nodes["error"]
    for n in (10, 100, 1000, 10_000):
        assert 2 * U * n <= error[n] <= 50 * U * n * n


def test_error_is_a_length_of_the_scene() -> None:
    """The error is a length: it scales with the scene, bit for bit, far beyond where its square underflows."""

    def errors(k: int) -> tuple[list[float], list[float]]:
        s = 2.0**k
        glass = Material("glass", reflect=0.1, transmit=0.9, ior=1.5)
        lamp = Light("lamp", position=(2 * s, 5 * s, 3 * s))
        world = world_of(ball((0, s, 0), s, glass), plane((0, 0, 0), (0, 1, 0), MIRROR), lights=[lamp])
        nodes = tracer.trace(world, ray=((0.2 * s, 1.3 * s, 4 * s), (-0.1, -0.2, -1)), depth=5).nodes
        return (nodes["error"] / s).tolist(), nodes["turn"].tolist()

    for k in (-400, -200, 200, 400):
        for found, expected in zip(errors(k), errors(0), strict=True):
            np.testing.assert_array_equal(found, expected)


def test_near_the_critical_angle_the_direction_is_less_sure() -> None:
    """1/c2 of the rounding: the refracted ray lies along the surface, where a small change of angle is a large part of
    it.
    """
    water = world_of(plane((0, 0, 0), (0, 1, 0), Material("water", transmit=1.0, ior=4 / 3)))
    critical = math.asin(0.75)
    turns = []
    for aside in (1e-2, 1e-6, 1e-10):
        a = critical - aside
        tree = tracer.trace(water, ray=((0, -1, 0), (math.sin(a), math.cos(a), 0)), depth=1)
        check(tree)
        turns.append(tree.nodes["turn"][1])
    assert turns[0] < turns[1] < turns[2]
    assert turns[2] == pytest.approx(turns[1] * 1e2, rel=0.1, abs=0.0)


def test_shadow_rays_inherit_what_their_start_is_off() -> None:
    lamp = Light("lamp", position=(0.0, 5.0, 0.0))
    floor = plane((0, 0, 0), (0, 1, 0), Material("floor", diffuse=1.0))
    world = world_of(floor, box((-1, 2, -1), (1, 2.5, 1), Material("lid", diffuse=1.0), "lid"), lights=[lamp])
    tree = tracer.trace(world, ray=((0.3, 1, 0), (0.1, -1, 0.1)), depth=0)
    assert tree.end(1) == "blocked"
    assert 0.0 < tree.nodes["error"][1] < 16 * tree.nodes["error"][0]


def bent_triangle(random: np.random.Generator) -> Mesh:
    """With a normal at each corner that differs from the face's own."""
    corners, aside = random.normal(size=(2, 3, 3))
    normals = np.cross(corners[1] - corners[0], corners[2] - corners[0]) + 0.5 * aside
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Mesh(Geometry(corners, np.array([[0, 1, 2]]), normals))


@pytest.mark.parametrize("kind", ["ball", "cone", "bent"])
def test_normal_turns_as_its_neighbours_differ(kind: str) -> None:
    """Half the difference of the normals a small step v before and behind along the surface, up to the square of v."""
    random = np.random.default_rng(1)
    compared = 0
    for k in range(60):
        shape = {"ball": Sphere((0.5, 0.2, 0.7), 2.0), "cone": random_cone(random, k), "bent": bent_triangle(random)}
        world = world_of(Object(shape[kind], MIRROR, "it")).arrays
        surface = world.surfaces[0]
        start, way = 5.0 * random.normal(size=(2, 3))
        ray = ray_along(start, 0.1 * way - start)
        t = intersect(world, surface, ray, 0.0, math.inf, True)
        if t < math.inf:
            p, n, _ = (np.array(v) for v in interaction(world, surface, ray, t))
            v = 1e-5 * np.cross(n, random.normal(size=3))
            before, behind = (interaction(world, surface, ray_along(p + w + n, -n), 1.0)[2] for w in (-v, v))
            differ = 0.5 * np.subtract(behind, before)
            found = np.array(normal_derivative(world, surface, vector(p.tolist()), vector(v.tolist())))
            assert np.linalg.norm(found - differ) <= 1e-6 * np.linalg.norm(v)
            compared += 1
    assert compared > 5


def ray_along(start: np.ndarray, way: np.ndarray) -> Ray:
    return make_ray(vector(start.tolist()), vector((way / np.linalg.norm(way)).tolist()), -1, 0.0, 9.0)

"""Many rays at once: the same trees as one by one; and a million rays at edges and corners, of which none leaves."""

import math

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import GLASS, MIRROR, ball, box, cube_mesh, world_of
from tests.tracer.shapes.test_closed_cones import place_on, random_cone
from tracer.kernel.nodes import BACKGROUND
from tracer.scene import Object
from tracer.shapes.mesh import Geometry, Mesh


def same(a: tracer.RayTree, b: tracer.RayTree) -> bool:
    fields = all(a.nodes[name].tobytes() == b.nodes[name].tobytes() for name in a.nodes.dtype.names or ())
    return fields and a.residual == b.residual and a.to_json() == b.to_json()


@pytest.mark.parametrize("name", EACH_LESSON)
def test_trees_are_those_of_single_rays(name: str, worlds: dict[str, tracer.World]) -> None:
    world, random = worlds[name], np.random.default_rng(1)
    eye = np.array(world.view().eye)
    origins, directions = eye + 0.5 * random.normal(size=(40, 3)), random.normal(size=(40, 3)) * 3.0 - eye
    trees = tracer.trace_rays(world, origins, directions, depth=3)
    assert len(trees) == 40
    for k in range(40):
        assert same(trees.tree(k), tracer.trace(world, ray=(origins[k], directions[k]), depth=3))
    assert (trees.hits["parent"] == -1).all()


def test_eyes_inside_and_on_surfaces() -> None:
    world = world_of(
        ball((0, 0, 0), 1.0, GLASS), box((-1, -3, -1), (1, -2, 1), GLASS), box((2, 2, 2), (3, 3, 3), MIRROR)
    )
    eyes = np.array([(1, 0, 0), (0, 0, 0), (0, -2, 0), (0, -2.5, 0), (2, 2.5, 2.5), (9, 9, 9), (1, 0, 0)], float)
    ways = np.array([(-1, 0.2, 0), (1, 1, 1), (0, 1, 0.1), (0, 1, 0), (1, 0, 0), (-1, -1, -1), (1, 0, 0)], float)
    trees = tracer.trace_rays(world, eyes, ways, depth=2)
    for k in range(len(eyes)):
        assert same(trees.tree(k), tracer.trace(world, ray=(eyes[k], ways[k]), depth=2))


def test_one_origin_may_stand_for_all() -> None:
    trees = tracer.trace_rays(world_of(ball()), (0.0, 0.0, 5.0), np.array([(0.0, 0.0, -2.0), (0.0, 0.0, 1.0)]))
    assert trees.hits["t"][0] == 4.0
    assert trees.hits["end"].tolist()[1] == BACKGROUND
    assert len(tracer.trace_rays(world_of(ball()), np.zeros((0, 3)), np.zeros((0, 3)))) == 0


@pytest.mark.parametrize(
    ("origins", "directions", "said"),
    [
        ([(0, 0, 0)], [(0, 0, 0)], "none 0,0,0"),
        ([(0, 0, 0)], [(0, 0, math.inf)], "must be finite"),
        ([(0, math.nan, 0)], [(0, 0, 1)], "must be finite"),
        ([(0, 1e160, 0)], [(0, 0, 1)], r"within 1e\+150"),
        ((0, 0, 0), (0, 0, 1), "must have the shape"),
        ([(0, 0)], [(0, 1)], "must have the shape"),
        ([(0, 0, 0)] * 2, [(0, 0, 1)] * 3, r"must have the shape \(n, 3\), got \(2, 3\) and \(3, 3\)"),
    ],
)
def test_bad_rays_are_refused(origins: list, directions: list, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        tracer.trace_rays(world_of(ball()), origins, directions)


def rooms(
    random: np.random.Generator, rays: int, count: int, decades: float = 1.5
) -> list[tuple[tracer.World, np.ndarray, np.ndarray]]:
    """Rooms of mirrors (boxes, turned meshes, closed cylinders) with eyes inside, and targets on edges and corners.

    The sides of boxes and meshes are 10^-decades to 10^decades long.
    """
    found = []
    for k in range(count):
        low = random.uniform(-2, 0, 3) * 10.0 ** random.uniform(-decades, decades, 3)
        high = low + random.uniform(0.5, 3, 3) * 10.0 ** random.uniform(-decades, decades, 3)
        targets = np.where(random.random((rays, 3)) < 0.5, low, high)
        on_edge = random.random(rays) < 0.7
        axis = random.integers(3, size=rays)
        along = low + (high - low) * random.random((rays, 3))
        for j in range(3):
            targets[on_edge & (axis == j), j] = along[on_edge & (axis == j), j]
        eyes = low + (high - low) * random.uniform(0.3, 0.7, (rays, 3))
        eyes[::5] = 0.5 * (low + high)
        turn, move = np.linalg.qr(random.normal(size=(3, 3)))[0], random.normal(size=3)
        straight = cube_mesh(low, high).geometry
        turned = Mesh(Geometry(straight.vertices @ turn.T + move, straight.faces), "cube")
        found.append((world_of(box(tuple(low), tuple(high), MIRROR)), eyes, targets - eyes))
        if np.linalg.det(turn) > 0.0:
            found.append((world_of(Object(turned, MIRROR, "mesh")), eyes @ turn.T + move, (targets - eyes) @ turn.T))
        shape, base, axle = random_cone(random, k)
        places = np.array([place_on(random, shape, base, axle, 1 + n) for n in range(min(rays, 400))])
        places = np.repeat(places, -(-rays // len(places)), axis=0)[:rays]
        room = min(shape.base_radius, shape.apex_radius, float(np.linalg.norm(axle)))
        inner = base + 0.5 * axle + 0.1 * random.uniform(-1, 1, (rays, 3)) * room
        found.append((world_of(Object(shape, MIRROR, "room")), inner, places - inner))
    return found


def leavers(rays: int, count: int, seed: int, decades: float = 1.5) -> int:
    random, left = np.random.default_rng(seed), 0
    for world, eyes, ways in rooms(random, rays, count, decades):
        trees = tracer.trace_rays(world, eyes, ways, depth=12)
        left += int((trees.nodes["end"] == BACKGROUND).sum())
    return left


def test_no_ray_at_an_edge_or_a_corner_leaves_a_room() -> None:
    assert leavers(rays=500, count=10, seed=1) == 0


@pytest.mark.slow
def test_of_a_million_rays_at_edges_and_corners_none_leaves() -> None:
    assert leavers(rays=4000, count=100, seed=2) == 0


def test_no_ray_leaves_a_room_like_a_needle_or_a_sheet() -> None:
    """Of sides up to 10^6 : 1. A ray in a corner then runs far along a wall that it has met before."""
    assert leavers(rays=1000, count=12, seed=5, decades=3.0) == 0


@pytest.mark.slow
def test_of_a_million_rays_none_leaves_a_room_like_a_needle_or_a_sheet() -> None:
    assert leavers(rays=4000, count=100, seed=3, decades=3.0) == 0

"""Faces that a ray sees edge-on: no hit lies outside its face by more than the error told with it."""

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, ball, cube_mesh, world_of
from tracer.scene import Object, Shape
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.polygon import Polygon
from tracer.shapes.triangle import Triangle


def distance_to_triangle(p: np.ndarray, corners: np.ndarray) -> float:
    a, b, c = corners
    n = np.cross(b - a, c - a)
    n /= np.linalg.norm(n)
    height = (p - a) @ n
    q = p - height * n
    if all(np.cross(end - start, q - start) @ n >= 0.0 for start, end in ((a, b), (b, c), (c, a))):
        return abs(height)
    sides = [(a, b), (b, c), (c, a)]
    feet = [x + np.clip((p - x) @ (y - x) / ((y - x) @ (y - x)), 0.0, 1.0) * (y - x) for x, y in sides]
    return min(float(np.linalg.norm(p - foot)) for foot in feet)


@pytest.mark.parametrize("kind", [Triangle, Polygon])
def test_hits_from_within_the_plane_lie_on_the_face(kind: type[Triangle | Polygon]) -> None:
    random = np.random.default_rng(3)
    hits = 0
    for _ in range(60):
        corners = 3.0 * random.normal(size=3) + 0.6 * random.normal(size=(3, 3))
        world = world_of(Object(kind(tuple(map(tuple, corners))), MATTE, "face"))
        u, v, middle = corners[0] - corners[1], corners[2] - corners[1], corners.mean(axis=0)
        eye = middle + random.uniform(-9, 9) * u + random.uniform(-9, 9) * v
        for _ in range(20):
            target = middle + random.uniform(-3, 3) * u + random.uniform(-3, 3) * v
            row = tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=0).nodes[0]
            if np.isfinite(row["t"]):
                hits += 1
                assert distance_to_triangle(row["point"], corners) <= row["error"]
    assert hits > 10


def test_rays_in_the_planes_of_a_turned_cube_hit_the_cube() -> None:
    random = np.random.default_rng(4)
    straight = cube_mesh(np.array([-1, -1, -1]), np.array([1, 1, 1])).geometry
    hits = 0
    for _ in range(60):
        turn, middle = np.linalg.qr(random.normal(size=(3, 3)))[0], random.normal(size=3)
        mesh: Shape = Mesh(Geometry(straight.vertices @ turn.T + middle, straight.faces), "cube")
        world = world_of(Object(mesh, MATTE, "cube"))
        for _ in range(30):
            a, b, c = (straight.vertices @ turn.T + middle)[straight.faces[random.integers(12)]]
            eye = a + random.uniform(-6, 6) * (b - a) + random.uniform(-6, 6) * (c - a)
            target = a + random.uniform(0, 1) * (b - a) + random.uniform(0, 1) * (c - a)
            row = tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=0).nodes[0]
            if np.isfinite(row["t"]):
                hits += 1
                beyond = np.abs((row["point"] - middle) @ turn).max() - 1.0
                assert beyond <= row["error"]
    assert hits > 500


def test_a_hit_that_only_touches_has_no_digits() -> None:
    """The speed towards the surface is 0, so the smallest shift of the ray moves the hit without limit."""
    row = tracer.trace(world_of(ball((0, 0, 0), 1.0)), ray=((1, 0, 5), (0, 0, -1)), depth=0).nodes[0]
    assert (row["t"], row["error"]) == (5.0, np.inf)

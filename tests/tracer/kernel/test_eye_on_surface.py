"""One rule for an eye exactly on a surface, for every shape: which side it is on follows from where it looks."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import tracer
from tests.scenes import GLASS, MATTE, cube_mesh, world_of
from tracer.scene import Camera, Object, Shape
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle

# (shape, a point exactly on it, the outward normal there, distance to its other side along the inward normal)
PLACES: list[tuple[Callable[[], Shape], tuple[float, ...], tuple[float, ...], float]] = [
    (lambda: Sphere((0, 0, 0), 1.0), (1, 0, 0), (1, 0, 0), 2.0),
    (lambda: Sphere((2, 3, 6), 7.0), (0, 0, 0), (-2, -3, -6), 14.0),
    (lambda: Box((-1, -1, -1), (1, 1, 1)), (0.3, 1, 0.2), (0, 1, 0), 2.0),
    (lambda: Box((-1, -1, -1), (1, 1, 1)), (1, 1, 0.25), (1, 1, 0), 8**0.5),
    (lambda: Box((-1, -1, -1), (1, 1, 1)), (-1, 1, 1), (-1, 1, 1), 12**0.5),
    (lambda: Plane((1, 2, 3), (2, 1, 2)), (1.5, 3, 2), (2, 1, 2), np.inf),
    (lambda: cube_mesh(np.array([-1, -1, -1]), np.array([1, 1, 1])), (0.25, 0.5, 1), (0, 0, 1), 2.0),
    (lambda: cube_mesh(np.array([-1, -1, -1]), np.array([1, 1, 1])), (0.5, 0.5, 1), (0, 0, 1), 2.0),
    (lambda: cube_mesh(np.array([-1, -1, -1]), np.array([1, 1, 1])), (1, 0.5, 1), (1, 0, 1), 8**0.5),
]
OPEN: list[tuple[Callable[[], Shape], tuple[float, ...], tuple[float, ...]]] = [
    (lambda: Cone((0, 0, 0), 5.0, (0, 2, 0), 5.0), (3, 1, 4), (3, 0, 4)),
    (lambda: Cone((0, 0, 0), 2.0, (0, 2, 0), 0.0), (1, 1, 0), (1, 1, 0)),
    (lambda: Disc((0, 1, 0), (0, 1, 0), 2.0), (1, 1, 1), (0, 1, 0)),
    (lambda: Polygon(((0, 0, 0), (2, 0, 0), (2, 0, -2), (0, 0, -2))), (1, 0, 0), (0, 1, 0)),
    (lambda: Triangle(((0, 0, 0), (2, 0, 0), (0, 2, 0))), (0.5, 0.25, 0), (0, 0, 1)),
]


def directions(normal: tuple[float, ...], inwards: bool) -> list[tuple[float, ...]]:
    """The normal, and two directions near it."""
    random = np.random.default_rng(1)
    n = np.array(normal) / np.linalg.norm(normal) * (-1.0 if inwards else 1.0)
    return [tuple(n), *(tuple(n + 0.3 * random.uniform(-1, 1, 3)) for _ in range(2))]


@pytest.mark.parametrize(("make", "eye", "normal", "across"), PLACES)
def test_into_glass_it_starts_inside_and_out_of_it_outside(
    make: Callable[[], Shape], eye: tuple[float, ...], normal: tuple[float, ...], across: float
) -> None:
    world = world_of(Object(make(), GLASS, "glass"))
    for k, direction in enumerate(directions(normal, inwards=True)):
        row = tracer.trace(world, ray=(eye, direction), depth=0).nodes[0]
        assert row["n1"] == 1.5
        if k == 0 and np.isfinite(across):
            assert row["t"] == pytest.approx(across, rel=4 * 2.0**-53, abs=0.0)
        assert not row["t"] < 1e-9
    for direction in directions(normal, inwards=False):
        tree = tracer.trace(world, ray=(eye, direction), depth=0)
        assert (tree.nodes["n1"][0], tree.end(0)) == (1.0, "background")


@pytest.mark.parametrize(("make", "eye", "normal"), [place[:3] for place in PLACES] + OPEN)
def test_into_an_opaque_surface_it_hits_at_once_and_out_of_it_does_not(
    make: Callable[[], Shape], eye: tuple[float, ...], normal: tuple[float, ...]
) -> None:
    world = world_of(Object(make(), MATTE, "matte"))
    for direction in directions(normal, inwards=True):
        row = tracer.trace(world, ray=(eye, direction), depth=0).nodes[0]
        assert row["t"] == 0.0
        assert np.abs(row["point"] - eye).max() <= 4 * 2.0**-53 * np.abs(eye).max()
        assert row["normal"] @ np.array(normal) > 0.5 * np.linalg.norm(normal)  # at a corner, that of one face
    for direction in directions(normal, inwards=False):
        assert tracer.trace(world, ray=(eye, direction), depth=0).end(0) == "background"


def test_an_image_from_a_surface_is_the_sum_of_its_trees() -> None:
    world = world_of(
        Object(Sphere((0, 0, 0), 1.0), GLASS, "glass"), Object(Box((-9, -9, -9), (9, -2, 9)), MATTE, "box")
    )
    for eye in ((1.0, 0.0, 0.0), (0.0, -2.0, 3.0)):
        other = tracer.prepare(replace(world.scene, camera=Camera(eye, (0.3, -5.0, 0.2))))
        image = tracer.render(other, size=(16, 12), depth=3)
        for x, y in ((0, 0), (7, 5), (15, 11)):
            tree = tracer.trace(other, pixel=(x, y), size=(16, 12), depth=3)
            assert image.pixels[y, x].tolist() == tree.radiance.tolist()


def test_source_exactly_on_a_lens() -> None:
    """From a public bug report: the ray starts inside and leaves at 2 / sqrt(1.04), or does not hit at all."""
    world = world_of(Object(Sphere((0, 0, 0), 1.0), GLASS, "b"))
    into = tracer.trace(world, ray=((1, 0, 0), (-1, 0.2, 0)), depth=0).nodes[0]
    assert (into["n1"], into["n2"]) == (1.5, 1.0)
    assert into["t"] == pytest.approx(2.0 / 1.04**0.5, rel=4 * 2.0**-53, abs=0.0)
    assert tracer.trace(world, ray=((1, 0, 0), (1, 0.2, 0)), depth=0).end(0) == "background"

"""Discs: their rims, their orientation, and rays that start on them or stop at them, as for polygons."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, MIRROR, OPEN, disc, kinds, plane, polygon, world_of
from tracer.kernel.nodes import BACKGROUND
from tracer.scene import Checker, Light, Material
from tracer.shapes.disc import Disc

U = 2.0**-53


def hits(world: tracer.World, origin: tuple, direction: tuple) -> bool:
    return bool(tracer.trace(world, ray=(origin, direction), depth=0).nodes["end"][0] != BACKGROUND)


def test_disc_ends_at_its_radius_in_every_direction() -> None:
    """Points of the plane with rational distances from the centre: on the rim it is hit, one last digit beyond it is
    not.
    """
    world = world_of(disc((0, 0, 0), (0, 0, 3), 5, OPEN))
    beyond = 1.0 + 4 * U
    for x, y in ((5, 0), (0, -5), (3, 4), (-4, 3), (1.4, 4.8), (-3, -4)):
        assert hits(world, (x * (1 - 4 * U), y * (1 - 4 * U), 7), (0, 0, -1))
        assert not hits(world, (x * beyond, y * beyond, 7), (0, 0, -1))
    assert hits(world, (3, 4, 7), (0, 0, -1))
    assert not hits(world, (-9, 0, 0), (1, 0, 0))  # in its plane


def test_tilted_disc_from_far_away() -> None:
    """Normal (2, 3, 6)/7, in its plane (6, 2, -3)/7 and (-3, 6, -2)/7: hit within the radius, missed outside."""
    n, u, v = (np.array(axis) / 7.0 for axis in ((2, 3, 6), (6, 2, -3), (-3, 6, -2)))
    center = np.array((0.25, -0.5, 1.0))
    world = world_of(disc(center, tuple(1e-200 * n), 2, OPEN))
    random = np.random.default_rng(1)
    for k in range(200):
        angle = random.uniform(0, 2 * math.pi)
        origin = center + 100.0 * n + 60.0 * random.normal(size=3)
        # Rounding of the distance along the ray, which the slope turns into a distance within the disc.
        edge = 64 * U * 300 * np.linalg.norm(origin - center) / abs((origin - center) @ n)
        for r, inside in ((2 - edge, True), (2 + edge, False)):
            target = center + r * (math.cos(angle) * u + math.sin(angle) * v)
            assert hits(world, tuple(origin), tuple(target - origin)) == inside, k


@pytest.mark.parametrize("place", [0.0, 2.0**30, -(2.0**45)])
def test_rim_is_as_sharp_wherever_the_disc_stands(place: float) -> None:
    """3 aside, 4 down: 10^-12 within the radius it is hit, 10^-12 outside it is missed, wherever the disc stands."""
    world = world_of(disc((place, place, place), (0, 0, 1), 3, OPEN))
    for share, hit in ((1.0 - 2.0**-40, True), (1.0 + 2.0**-40, False)):
        for x, y in ((3, 0), (0, 3), (-1.8, 2.4)):
            assert hits(world, (place, place, place + 4.0), (share * x, share * y, -4.0)) == hit


def test_disc_normal_is_the_side_of_empty_space() -> None:
    glass = Material("glass", transmit=1.0, ior=1.5)
    for normal, indices in (((0, 0, 0.5), (1.0, 1.5)), ((0, 0, -2), (1.5, 1.0))):
        tree = tracer.trace(world_of(disc((0, 0, 0), normal, 1, glass)), ray=((0.5, 0.5, 5), (0, 0, -1)), depth=1)
        assert (tree.nodes["n1"][0], tree.nodes["n2"][0]) == indices


def test_reflected_ray_does_not_meet_the_disc_again() -> None:
    """At any tilt, from afar, near its rim: one hit, then the background."""
    random = np.random.default_rng(7)
    for _ in range(300):
        center, normal = 10.0 * random.normal(size=3), random.normal(size=3)
        world = world_of(disc(center, normal, 1, MIRROR))
        aside = np.cross(normal, random.normal(size=3))
        target = center + random.random() * aside / np.linalg.norm(aside)
        origin = target + 10.0 ** random.uniform(-6, 4) * random.normal(size=3)
        assert kinds(tracer.trace(world, ray=(tuple(origin), tuple(target - origin)), depth=9)) == [
            "camera",
            "reflection",
        ]


def test_two_discs_reflect_a_ray_between_them_until_its_depth() -> None:
    world = world_of(disc((0, 0, 0), (0, 0, 1), 1, MIRROR, "low"), disc((0, 0, 1), (0, 0, -1), 1, MIRROR, "high"))
    tree = tracer.trace(world, ray=((0.25, 0, 0.5), (0, 0, 1)), depth=50)
    assert len(tree) == 51
    assert tree.nodes["t"][1:].tolist() == [1.0] * 50
    assert {tree.object_name(i) for i in range(0, 51, 2)} == {"high"}


def test_shadow_of_a_disc_has_its_radius() -> None:
    """A lamp at height 2, a disc of radius 1 at height 1, parallel to the floor: a shadow of radius 2."""
    lamp = Light("lamp", position=(0.0, 2.0, 0.0))
    world = world_of(disc((0, 1, 0), (0, 1, 0), 1, MATTE), plane((0, 0, 0), (0, 1, 0)), lights=[lamp])
    for angle in np.linspace(0, 6, 25):
        for r, lit in ((2 - 1e-14, False), (2 + 1e-14, True)):
            at = np.array((r * math.cos(angle), 0.0, r * math.sin(angle)))
            tree = tracer.trace(world, ray=((at[0], 0.5, at[2]), (0, -1, 0)), depth=0)
            assert (tree.radiance[0] > 0.0) == lit


def test_checker_lies_along_the_disc() -> None:
    """As on a plane: squares along two axes in the disc, none along the height."""
    tiles = Material("tiles", ambient=1.0, checker=Checker((0.0, 0.0, 0.0), 1.0))
    for y in (0.5, 1.5):
        world = world_of(disc((0, y, 0), (0, 1, 0), 9, tiles))
        for x, z in ((0.5, 0.5), (1.5, 0.5), (-0.5, 0.5), (-0.5, 2.5)):
            expected = 1.0 if (math.floor(x) + math.floor(z)) % 2 == 0 else 0.0
            assert tracer.trace(world, ray=((x, 5, z), (0, -1, 0)), depth=0).radiance[0] == expected


def test_disc_behind_a_wall_of_the_same_plane_does_not_stop_what_leaves_the_wall() -> None:
    """A ray reflected by a polygon starts in the plane of the disc behind it, too: it leaves both."""
    wall = [(-2, -2, 1), (2, -2, 1), (2, 2, 1), (-2, 2, 1)]
    turn = np.array([[0.8, 0.0, 0.6], [0.36, 0.8, -0.48], [-0.48, 0.6, 0.64]])
    world = world_of(
        polygon(np.array(wall, float) @ turn.T, MIRROR), disc(turn @ (0, 0, 1), turn @ (0, 0, 1), 1, MIRROR)
    )
    random = np.random.default_rng(3)
    for _ in range(200):
        target = turn @ (*random.uniform(-0.6, 0.6, 2), 1.0)
        origin = target + turn @ (*random.normal(size=2), 3.0)
        tree = tracer.trace(world, ray=(tuple(origin), tuple(target - origin)), depth=5)
        if tree.object_name(0) == "face":
            assert kinds(tree) == ["camera", "reflection"]


@pytest.mark.parametrize(
    ("normal", "reach"),
    [
        ((0, 0, -7), (5, 5, 0)),
        ((1e-200, 0, 0), (0, 5, 5)),
        ((3, 4, 0), (4, 3, 5)),
        ((0, -8, 6), (5, 3, 4)),
        ((1e-9, 0, 1), (5, 5, 5e-9)),
    ],
)
def test_bounds_are_tight(normal: tuple, reach: tuple) -> None:
    low, high = Disc((1.0, 2.0, 3.0), normal, 5.0).bounds()[0]
    np.testing.assert_allclose(low, np.subtract((1, 2, 3), reach), rtol=0.0, atol=16 * U)
    np.testing.assert_allclose(high, np.add((1, 2, 3), reach), rtol=0.0, atol=16 * U)

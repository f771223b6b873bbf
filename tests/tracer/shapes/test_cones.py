"""Cones, frusta and cylinders: closed forms with rational results, tips, rims, and no second hit by rounding."""

import math
from dataclasses import replace

import numpy as np
import pytest

import tracer
from tests.scenes import CLEAR, MIRROR, OPEN, cone, kinds, world_of
from tracer.kernel.nodes import BACKGROUND
from tracer.scene import Material, Object
from tracer.shapes.cone import Cone

U = 2.0**-53

PIPE = cone((0, 0, -100), 1, (0, 0, 100), 1, CLEAR)
HAT = cone((0, 0, 0), 3, (0, 0, 4), 0, OPEN)  # its side falls 4 on 3: cosine 4/5, sine 3/5


def first_hit(item: Object, origin: tuple, direction: tuple) -> np.void:
    return tracer.trace(world_of(item), ray=(origin, direction), depth=0).nodes[0]


def test_chord_of_a_cylinder() -> None:
    """In at (1, 0, 0) along (-2, 1, 2)/3: out after 12/5, rotated by pi - 2 atan(1/2), 8/5 higher."""
    tree = tracer.trace(world_of(PIPE), ray=((3, -1, -2), (-2, 1, 2)), depth=1)
    assert kinds(tree) == ["camera", "refraction"]
    into, out = tree.nodes[0], tree.nodes[1]
    np.testing.assert_allclose(into["point"], (1.0, 0.0, 0.0), rtol=0.0, atol=8 * U)
    np.testing.assert_allclose(out["point"], (-0.6, 0.8, 1.6), rtol=0.0, atol=16 * U)
    assert out["t"] == pytest.approx(2.4, rel=8 * U, abs=0.0)
    assert math.atan2(out["point"][1], out["point"][0]) == pytest.approx(
        math.pi - 2.0 * math.atan(0.5), rel=8 * U, abs=0.0
    )
    np.testing.assert_allclose(out["normal"], (0.6, -0.8, 0.0), rtol=0.0, atol=8 * U)


@pytest.mark.parametrize(
    ("origin", "direction", "t", "normal"),
    [
        ((5, 0, 2), (-1, 0, 0), 3.5, (0.8, 0, 0.6)),  # half way up its radius is 3/2
        ((0, 0, 2), (1, 0, 0), 1.5, (-0.8, 0, -0.6)),  # the same from inside
        ((1, 0, 0), (-3, 0, 4), 10 / 3, (0.8, 0, -0.6)),  # parallel to the opposite side: one root
        ((0, 0, 10), (0, 0, -1), 6.0, (0, 0, 1)),  # down its axis onto the tip
        ((0, 0, 1), (0, 0, 1), 3.0, (0, 0, -1)),  # up its axis into the tip
        ((0, 0, -5), (3, 0, 6), 0.9 * math.sqrt(45), (-0.8, 0, -0.6)),  # in through its open base
        ((2, 0, 10), (0, 0, -1), 26 / 3, (0.8, 0, 0.6)),  # steeper than its side; the other nappe is cut off
    ],
)
def test_cone_of_sides_3_4_5(origin: tuple, direction: tuple, t: float, normal: tuple) -> None:
    hit = first_hit(HAT, origin, direction)
    assert hit["t"] == pytest.approx(t, rel=8 * U, abs=0.0)
    np.testing.assert_allclose(hit["normal"], normal, rtol=0.0, atol=8 * U)


@pytest.mark.parametrize(
    ("origin", "direction"),
    [
        ((0, 0, 5), (1, 0, 0)),  # beyond the tip, where the other nappe would be
        ((5, 0, -0.001), (-1, 0, 0)),  # below the base
        ((4, 0, 0), (-3, 0, 4)),  # parallel to the side, outside
        ((0, 0, 3), (0, 0, -1)),  # out through the base
        ((3.1, -5, 0), (0, 1, 0)),  # past it
    ],
)
def test_what_misses_the_cone(origin: tuple, direction: tuple) -> None:
    assert first_hit(HAT, origin, direction)["end"] == BACKGROUND


@pytest.mark.parametrize("flip", [False, True])
def test_frustum_ends_where_its_ends_are(flip: bool) -> None:
    """Radius 2 at y = 0, 1 at y = 2, given from either end: hit at both rims, missed just beyond."""
    low, high = ((0, 0, 0), 2), ((0, 2, 0), 1)
    frustum = cone(*high, *low, OPEN) if flip else cone(*low, *high, OPEN)
    for y, x in ((0.0, 2.0), (1.0, 1.5), (2.0, 1.0)):
        hit = first_hit(frustum, (8, y, 0), (-1, 0, 0))
        assert hit["t"] == pytest.approx(8 - x, rel=4 * U, abs=0.0)
        np.testing.assert_allclose(hit["normal"], np.array((2, 1, 0)) / math.sqrt(5), rtol=0.0, atol=4 * U)
    for y in (-4 * U, 2 + 4 * U):  # a last digit of the height
        assert first_hit(frustum, (8, y, 0), (-1, 0, 0))["end"] == BACKGROUND


def test_nearer_root_off_the_ends_leaves_the_farther_one() -> None:
    ring = cone((0, 0, 0), 1, (0, 0, 1), 1, OPEN)
    hit = first_hit(ring, (-2, 0, 2), (2, 0, -1))  # over its rim, against the far side from inside
    np.testing.assert_allclose(hit["point"], (1.0, 0.0, 0.5), rtol=0.0, atol=4 * U)
    np.testing.assert_allclose(hit["normal"], (-1.0, 0.0, 0.0), rtol=0.0, atol=4 * U)


@pytest.mark.parametrize("direction", [(0, 0, 1), (1, 2, 2), (-3, 1, 0.5)])
def test_ray_along_the_axis_of_a_cylinder_meets_nothing(direction: tuple) -> None:
    """All terms of the quadratic are rounding errors: on the axis, beside it, and on the side itself."""
    d = np.array(direction) / np.linalg.norm(direction)
    aside = np.cross(d, (0.3, -0.8, 0.1))
    aside /= np.linalg.norm(aside)
    tube = cone(-5 * d, 1, 5 * d, 1, OPEN)
    for away in (0.0, 0.5, 0.999):
        assert first_hit(tube, tuple(away * aside - 20 * d), tuple(d))["end"] == BACKGROUND
    on_the_side = first_hit(tube, tuple(aside - 20 * d), tuple(d))
    assert on_the_side["end"] == BACKGROUND or np.isfinite(on_the_side["point"]).all()


def test_hair_thin_fibre() -> None:
    """Radius and slope 2^-30: A is 2^-60. The side is still hit at z = 3/2, 7/2 and so on, starting half way out."""
    hair = cone((0, 0, 0), 2.0**-30, (0, 0, 1000), 2.0**-30, MIRROR)
    tree = tracer.trace(world_of(hair), ray=((-(2.0**-31), 0, 0), (2.0**-30, 0, 1)), depth=100)
    expected = 1.5 + 2.0 * np.arange(101)
    assert (np.abs(tree.nodes["point"][:, 2] / expected - 1.0) <= 8 * U).all()
    assert (np.abs(tree.nodes["point"][:, 0]) == 2.0**-30).all()


def test_mirrored_pipe_is_a_fibre() -> None:
    """Each reflection rotates the hit by the same angle and lifts it by the same height, a hundred times.

    A rounding of the direction changes the step of the angle, and steps add up: k^2.
    """
    pipe = replace(PIPE, material=MIRROR)
    tree = tracer.trace(world_of(pipe), ray=((0.2, 0.4, -89.2), (-2, 1, 2)), depth=100)
    assert len(tree) == 101
    k = np.arange(1, 102)
    points = tree.nodes["point"]
    angle = k * (math.pi - 2.0 * math.atan(0.5))
    assert (np.abs(points[:, 0] - np.cos(angle)) <= 16 * U * k * k).all()
    assert (np.abs(points[:, 1] - np.sin(angle)) <= 16 * U * k * k).all()
    assert (np.abs(points[:, 2] - (1.6 * k - 90.0)) <= 16 * U * (90 + k * k)).all()
    # Every hit is projected onto the side, so that its error does not accumulate.
    assert (np.abs(np.hypot(points[:, 0], points[:, 1]) - 1.0) <= 4 * U).all()


def test_glass_cone_bounds_its_medium_on_the_side_of_its_axis() -> None:
    glass = Material("glass", transmit=1.0, ior=1.5)
    world = world_of(cone((0, 0, 0), 1, (0, 0, 5), 1, glass))
    across = tracer.trace(world, ray=((3, 0, 2), (-1, 0, 0)), depth=3)
    assert across.nodes["n1"].tolist() == [1.0, 1.5, 1.0]
    # An open cone: a ray that starts inside is known to be so only when it leaves.
    out = tracer.trace(world, ray=((0, 0, 2), (1, 0, 0)), depth=3)
    assert out.nodes["n1"].tolist() == [1.5, 1.0]


@pytest.mark.parametrize(("z", "climb", "indices"), [(9, -1, (1.0, 1.5)), (1, 1, (1.5, 1.0))])
def test_tip_of_glass_is_entered_from_without_and_left_from_within(z: int, climb: int, indices: tuple) -> None:
    glass = Material("glass", transmit=1.0, ior=1.5)
    tree = tracer.trace(world_of(replace(HAT, material=glass)), ray=((0, 0, z), (0, 0, climb)), depth=1)
    assert (tree.nodes["n1"][0], tree.nodes["n2"][0]) == indices
    assert tree.nodes["normal"][0].tolist() == [0.0, 0.0, -climb]


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        (Cone((1.0, 2.0, 3.0), 1.0, (1.0, 2.0, 3.0), 0.0), ["apex must differ from base, got [1, 2, 3] for both"]),
        (Cone((0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 1.0), 0.0), ["base_radius or apex_radius must be > 0, got 0 for both"]),
        (Cone((0.0, 0.0, 0.0), 1.0, (0.0, 0.0, 1.0), 0.0), []),
    ],
)
def test_what_is_no_cone_is_told(shape: Cone, said: list[str]) -> None:
    assert shape.faults() == said

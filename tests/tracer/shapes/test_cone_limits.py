"""Limits of cones: no second hit by rounding, tips, extreme proportions, tight bounding boxes."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import CLEAR, MIRROR, cone, random_cone, world_of
from tracer.kernel.nodes import BACKGROUND
from tracer.rays import make_ray
from tracer.scene import Camera, Object
from tracer.shapes import cone as formulas
from tracer.shapes.cone import Cone

U = 2.0**-53


def test_mirrored_outside_is_never_met_again() -> None:
    """Of 10^5 rays that the outside of a cone reflects none hits it again: at depth 6 there is one ray a hit.

    Seen from the side, so that no ray enters through the open ends.
    """
    for shape in (
        Cone((0.0, 0.0, 0.0), 1.0, (0.0, 3.0, 0.0), 1.0),
        Cone((4.0, 0.0, 0.0), 2.0, (4.5, 3.0, 0.0), 0.5),
        Cone((8.0, 3.0, 1.0), 1.5, (8.0, 0.0, 0.9), 0.0),
    ):
        item = Object(shape, MIRROR)
        middle = 0.5 * np.add(shape.base, shape.apex)
        camera = Camera(position=(middle[0] + 0.3, 1.4, 9.0), look_at=tuple(middle.tolist()), fov=24)
        image = tracer.render(world_of(item, camera=camera), (400, 300), depth=6)
        assert image.rays["reflection"] > 10**4 * 3
        shallow = tracer.render(world_of(item, camera=camera), (400, 300), depth=1)
        assert shallow.rays == image.rays


@pytest.mark.parametrize("inward", [1e-17, U, 1e-14, 1e-9])
@pytest.mark.parametrize(
    ("shape", "start", "normal", "along", "chord"),
    [
        (Cone((0.0, 0.0, -9.0), 1.0, (0.0, 0.0, 9.0), 1.0), (1.0, 0.0, 0.0), (1, 0, 0), (0, 0.8, 0.6), 2 / 0.64),
        (
            Cone((0.0, 0.0, 0.0), 3.0, (0.0, 0.0, 4.0), 0.0),
            (1.5, 0.0, 2.0),
            (0.8, 0, 0.6),
            (-0.36, 0.8, 0.48),
            2.4 / 0.4096,
        ),
    ],
)
def test_grazing_ray_that_leaves_outwards_is_gone(
    shape: Cone, start: tuple, normal: tuple, along: tuple, chord: float, inward: float
) -> None:
    """A grazing ray that leaves outwards does not hit again, even if rounding turns its direction inwards.

    Inwards its chord has length -2 B / A.
    """
    world = world_of(Object(shape, MIRROR)).arrays
    d = tuple((np.array(along) - inward * np.array(normal)).tolist())
    assert formulas.next_hit(world, world.surfaces[0], make_ray(start, d, 0, 1.0, 2.0)) == math.inf
    t = formulas.next_hit(world, world.surfaces[0], make_ray(start, d, 0, -1.0, 2.0))
    if inward > 8 * U or t < math.inf:
        assert abs(t - chord * inward) <= 16 * U + 4 * inward**2


def test_called_from_python_the_formulas_give_the_bits_of_the_compiled_ones() -> None:
    random = np.random.default_rng(31)
    compared = 0
    for k in range(60):
        shape = random_cone(random, k)
        world = world_of(Object(shape, CLEAR))
        origin = np.array(shape.base) + random.normal(size=3) * 5.0
        aim = 0.5 * np.add(shape.base, shape.apex) - origin
        for row in tracer.trace(world, ray=(tuple(origin), tuple(aim)), depth=3).nodes:
            start = 0 if row["depth"] else -1
            ray = make_ray(tuple(row["origin"].tolist()), tuple(row["direction"].tolist()), start, -1.0, 1.0)
            surface = world.arrays.surfaces[0]
            own = (
                formulas.next_hit(world.arrays, surface, ray)
                if row["depth"]
                else formulas.intersect(world.arrays, surface, ray, 0.0, math.inf, True)
            )
            assert own == row["t"] or (own == math.inf and row["end"] == BACKGROUND)
            if own < math.inf:
                p, n, _ = formulas.interaction(world.arrays, surface, ray, own)
                assert p == tuple(row["point"])
                assert n == tuple(row["normal"]) or n == tuple(-row["normal"])
                compared += 1
    assert compared > 40


@pytest.mark.parametrize("lean", [(0, 0, 1), (1, 2, 2), (-0.3, 0.7, 0.1)])
def test_tip_is_hit_in_numbers(lean: tuple) -> None:
    """Rays at the tip, from inside and outside, along the axis or not: all numbers finite, normals of length 1."""
    axis = np.array(lean) / np.linalg.norm(lean)
    tip = np.array((0.25, -0.5, 3.0))
    random = np.random.default_rng(12)
    for material in (MIRROR, CLEAR):
        world = world_of(cone(tip - 4 * axis, 3, tip, 0, material))
        for k in range(200):
            towards = (axis, -axis, random.normal(size=3))[k % 3]
            tree = tracer.trace(world, ray=(tuple(tip - 2.0 * towards), tuple(towards)), depth=6)
            hit = np.isfinite(tree.nodes["t"])
            assert hit[0] or k % 3 == 2  # along the axis it is not missed
            assert (tree.nodes["t"][hit] > 0.0).all()
            for field in ("direction", "point", "normal"):
                assert np.isfinite(tree.nodes[field][hit]).all()
            assert (np.abs(np.linalg.norm(tree.nodes["normal"][hit], axis=1) - 1.0) <= 4 * U).all()


# within the range in which squares of the rounding are representable
@pytest.mark.parametrize("size", [1e-130, 1e-60, 1.0, 1e60, 1e140])
@pytest.mark.parametrize("flatness", [1e-12, 1e-3, 1.0, 1e3, 1e9])
def test_no_proportion_gives_anything_but_numbers(size: float, flatness: float) -> None:
    random = np.random.default_rng(9)
    for k in range(60):
        axis = np.eye(3)[k % 3] if k % 2 else random.normal(size=3)
        radii = ((1, 1), (1, 0), (0, 1), (1, 1 + 2 * U), (0.5, 1))[k % 5]
        tall = cone((0, 0, 0), size * radii[0], size * flatness * axis, size * radii[1], MIRROR)
        aim = size * flatness * random.random() * axis + size * random.uniform(-1, 1, 3) * (k % 4 > 0)
        origin = 3.0 * size * (random.normal(size=3) if k % 7 else axis)
        tree = tracer.trace(world_of(tall), ray=(tuple(origin), tuple((aim - origin) / size)), depth=4)
        assert "invalid" not in {tree.end(i) for i in range(len(tree))}
        hit = np.isfinite(tree.nodes["t"])
        for field in ("origin", "direction", "radiance"):
            assert np.isfinite(tree.nodes[field]).all()
        assert np.isfinite(tree.nodes["point"][hit]).all()
        assert (np.abs(np.linalg.norm(tree.nodes["normal"][hit], axis=1) - 1.0) <= 6 * U).all()


def test_bounds_are_tight() -> None:
    """The rims of a tilted frustum touch the bounding box on every side. Along the axes the box is exact."""
    np.testing.assert_array_equal(Cone((1.0, 2.0, 3.0), 2.0, (1.0, 2.0, 7.0), 0.0).bounds(), [[(-1, 0, 3), (3, 4, 7)]])
    random = np.random.default_rng(3)
    phi = np.linspace(0, 2 * math.pi, 4001)[:, None]
    for k in range(50):
        shape = random_cone(random, k)
        axis = np.subtract(shape.apex, shape.base)
        u = np.cross(axis, random.normal(size=3))
        u /= np.linalg.norm(u)
        v = np.cross(axis, u) / np.linalg.norm(axis)
        circle = np.cos(phi) * u + np.sin(phi) * v
        rims = np.concatenate([shape.base + shape.base_radius * circle, shape.apex + shape.apex_radius * circle])
        low, high = shape.bounds()[0]
        reach = np.abs(rims).max()
        assert (rims.min(axis=0) >= low - 8 * U * reach).all() and (rims.max(axis=0) <= high + 8 * U * reach).all()
        # Between two of 4000 points a circle rises by (pi/4000)^2/2 of its radius.
        gap = 4e-7 * max(shape.base_radius, shape.apex_radius) + 8 * U * reach
        assert (rims.min(axis=0) <= low + gap).all() and (rims.max(axis=0) >= high - gap).all()


@pytest.mark.parametrize("closed", [False, True])
def test_the_normal_at_a_tip_is_not_known(closed: bool) -> None:
    """No disc ends a cone there, also if it is closed: beside the tip, the normal turns the faster the nearer it is."""
    world = world_of(Object(Cone((0.0, 0.0, 0.0), 1.0, (0.0, 1.0, 0.0), 0.0, closed), MIRROR, "cone")).arrays
    for distance in (1e-3, 1e-12):
        p, v = (distance, 1.0, 0.0), (0.0, 0.0, 1e-15)  # off the side by rounding
        change = np.linalg.norm(formulas.normal_derivative(world, world.surfaces[0], p, v))
        assert change == pytest.approx(1e-15 / distance / math.sqrt(2.0), rel=1e-3)
    assert not np.isfinite(
        formulas.normal_derivative(world, world.surfaces[0], (0.0, 1.0, 0.0), (0.0, 0.0, 1e-15))
    ).any()

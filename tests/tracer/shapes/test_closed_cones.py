"""Closed cones and cylinders: one solid with three faces, closed at its rims; silhouettes and rims decided exactly."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf

import tracer
from tests.exact import exact
from tests.scenes import GLASS, MATTE, MIRROR, ends, kinds, world_of
from tracer.scene import Object
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc

U = 2.0**-53


def test_glass_cylinder_is_one_medium() -> None:
    """In through the lower end and out through the upper one, and once across: no index but 1.5 inside."""
    world = world_of(Object(Cone((0, 0, 0), 1.0, (0, 3, 0), 1.0, closed=True), GLASS, "cylinder"))
    assert [solid.closed for solid in world.solids] == [True]
    along = tracer.trace(world, ray=((0.25, -2, 0.5), (0, 1, 0)), depth=2)
    assert kinds(along)[:3] == ["camera", "reflection", "refraction"] or kinds(along)[:2] == ["camera", "refraction"]
    inner = [k for k in range(len(along)) if along.nodes["n1"][k] == 1.5]
    assert along.nodes["t"][inner[0]] == 3.0
    assert along.nodes["normal"][0].tolist() == [0.0, -1.0, 0.0]
    across = tracer.trace(world, ray=((-4, 1, 0), (1, 0, 0)), depth=2)
    inner = [k for k in range(len(across)) if across.nodes["n1"][k] == 1.5]
    assert across.nodes["t"][inner[0]] == 2.0
    assert world.eye((0.5, 1.0, 0.5)).solids.tolist() == [1]
    assert world.eye((0.9, 1.0, 0.9)).solids.tolist() == [0]


def random_cone(random: np.random.Generator, k: int) -> tuple[Cone, np.ndarray, np.ndarray]:
    """A frustum or cylinder in any direction, half of them along an axis, with its base and its axis."""
    radii = random.choice([0.25, 0.5, 1.0, 2.0], 2)
    axis = random.normal(size=3) if k % 2 else np.eye(3)[random.integers(3)] * random.choice((-1.0, 1.0))
    axis *= random.choice((0.5, 2.0)) / np.linalg.norm(axis)
    base = np.round(random.normal(size=3), int(random.integers(3)))
    return Cone(tuple(base), float(radii[0]), tuple(base + axis), float(radii[1]), closed=True), base, axis


def place_on(random: np.random.Generator, shape: Cone, base: np.ndarray, axis: np.ndarray, k: int) -> np.ndarray:
    """A point of the side, of a rim or of an end."""
    aside = np.cross(axis, random.normal(size=3))
    share = random.random() if k % 3 == 0 else float(random.integers(2))
    radius = shape.base_radius + (shape.apex_radius - shape.base_radius) * share
    return base + share * axis + aside / np.linalg.norm(aside) * radius * (random.random() if k % 3 == 2 else 1.0)


def test_medium_inside_and_outside_is_right_after_rays_at_rims() -> None:
    random = np.random.default_rng(1)
    asked = 0
    for k in range(120):
        shape, base, axis = random_cone(random, k)
        world = world_of(Object(shape, GLASS, "cone"), model="fresnel")
        for j in range(6):
            target = place_on(random, shape, base, axis, j)
            eye = target + 3.0 * random.normal(size=3)
            for row in tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=5).nodes:
                length = min(float(row["t"]), 50.0) if math.isfinite(row["t"]) else 50.0
                for share in (0.13, 0.5, 0.87):
                    arm = row["origin"] + share * length * row["direction"] - base
                    height = arm @ axis / (axis @ axis)
                    radius = shape.base_radius + (shape.apex_radius - shape.base_radius) * height
                    across = float(np.linalg.norm(arm - height * axis))
                    depth = min(height, 1.0 - height, radius - across)
                    if length > 1e-9 and abs(depth) > 1e-9:
                        asked += 1
                        assert row["n1"] == (1.5 if depth > 0.0 else 1.0)
    assert asked > 10_000


def test_no_ray_leaves_a_room_of_mirrors_through_its_rims() -> None:
    random = np.random.default_rng(2)
    for k in range(150):
        shape, base, axis = random_cone(random, k)
        world = world_of(Object(shape, MIRROR, "room"))
        eye = base + 0.5 * axis + 0.1 * random.uniform(-1, 1, 3) * min(shape.base_radius, shape.apex_radius)
        for j in range(3):
            target = place_on(random, shape, base, axis, 1 + j)
            tree = tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=25)
            assert "background" not in ends(tree)


def crosses_side(shape: Cone, row: np.void) -> bool:
    """Whether the line of a ray meets the infinite cone, with 50 digits."""
    w, f, d = exact(shape.apex) - exact(shape.base), exact(row["origin"]) - exact(shape.base), exact(row["direction"])
    square, s0, s1 = (w * w).sum(), (f * w).sum(), (d * w).sum()
    r, growth = mpf(shape.base_radius), mpf(shape.apex_radius) - mpf(shape.base_radius)
    rho, rise = r + growth * s0 / square, growth * s1 / square
    a = (d * d).sum() - s1 * s1 / square - rise * rise
    b = (f * d).sum() - s0 * s1 / square - rho * rise
    c = (f * f).sum() - s0 * s0 / square - rho * rho
    return bool(b * b - a * c >= 0)


def test_no_ray_leaves_a_room_of_mirrors_through_its_tip() -> None:
    """Rays aimed within rounding at the tips of cones of any place and slope. The tip has no normal of its own."""
    random = np.random.default_rng(5)
    for _ in range(60):
        base, axis = random.normal(size=3) * 10.0 ** random.uniform(-2, 2), random.normal(size=3)
        radius = float(10.0 ** random.uniform(-1, 0.5) * np.linalg.norm(axis))
        cone = Cone(tuple(base.tolist()), radius, tuple((base + axis).tolist()), 0.0, True)
        world = world_of(Object(cone, MIRROR, "cone"))
        eye = base + axis * random.uniform(0.1, 0.6)
        off = random.normal(size=(40, 3)) * 10.0 ** random.uniform(-18, -14, (40, 1)) * np.linalg.norm(axis)
        trees = tracer.trace_rays(world, eye[None], np.array(cone.apex) - eye + off, depth=6)
        assert (trees.nodes["object"] == 0).all()
        assert len(trees.nodes) == 40 * 7


def test_silhouette_of_a_cylinder_is_decided_exactly() -> None:
    """Rays that pass the side at 1e-16 to 1e-8 of the radius, from up to 1e7 radii away."""
    random = np.random.default_rng(3)
    for _ in range(400):
        axis, middle = random.normal(size=3), random.normal(size=3)
        axis /= np.linalg.norm(axis)
        shape = Cone(tuple(middle - 50.0 * axis), 1.0, tuple(middle + 50.0 * axis), 1.0)
        side = np.cross(axis, random.normal(size=3))
        side /= np.linalg.norm(side)
        off = 1.0 + random.choice((-1.0, 1.0)) * 10.0 ** random.uniform(-16, -8)
        target = middle + np.cross(axis, side) * off
        eye = target + side * 10.0 ** random.uniform(0, 7)
        row = tracer.trace(world_of(Object(shape, MATTE)), ray=(tuple(eye), tuple(target - eye)), depth=0).nodes[0]
        assert math.isfinite(row["t"]) == crosses_side(shape, row)


def test_rim_of_a_disc_is_decided_exactly() -> None:
    random = np.random.default_rng(4)
    for _ in range(400):
        normal, center, radius = random.normal(size=3), random.normal(size=3), 10.0 ** random.uniform(-2, 2)
        aside = np.cross(normal, random.normal(size=3))
        off = 1.0 + random.choice((-1.0, 1.0)) * 10.0 ** random.uniform(-16, -10)
        target = center + aside / np.linalg.norm(aside) * radius * off
        eye = target + random.normal(size=3) * 10.0 ** random.uniform(0, 4)
        item = Object(Disc(tuple(center), tuple(normal), float(radius)), MATTE)
        row = tracer.trace(world_of(item), ray=(tuple(eye), tuple(target - eye)), depth=0).nodes[0]
        n, f, d = exact(normal), exact(row["origin"]) - exact(center), exact(row["direction"])
        t = -(n * f).sum() / (n * d).sum()
        q = f + d * t
        assert math.isfinite(row["t"]) == bool(t > 0 and (q * q).sum() <= mpf(float(radius)) ** 2)


@pytest.mark.parametrize("size", [1.0, 1e3, 1e6, 1e9, 1e12])
def test_told_error_of_a_large_cone_is_above_the_true_one(size: float) -> None:
    """The eye is 1 away from a side of this radius."""
    random = np.random.default_rng(5)
    found = 0
    for k in range(30):
        axis, side, eye = random.normal(size=3), random.normal(size=3), 0.3 * random.normal(size=3)
        axis /= np.linalg.norm(axis)
        side = np.cross(axis, side)
        side /= np.linalg.norm(side)
        base = eye - side * (size + 1.0) - 2.0 * size * axis
        shape = Cone(tuple(base), size, tuple(base + 4.0 * size * axis), size * (0.9 if k % 2 else 1.0))
        ray = (tuple(eye), tuple(0.3 * random.normal(size=3) - side))
        row = tracer.trace(world_of(Object(shape, MATTE)), ray=ray, depth=0).nodes[0]
        if not math.isfinite(row["t"]):
            continue
        found += 1
        w, d = exact(shape.apex) - exact(shape.base), exact(row["direction"])
        square, growth = (w * w).sum(), mpf(shape.apex_radius) - mpf(shape.base_radius)

        def off(t: mpf, w=w, d=d, square=square, growth=growth, row=row, shape=shape) -> mpf:
            f = exact(row["origin"]) + d * t - exact(shape.base)
            s = (f * w).sum()
            return (f * f).sum() - s * s / square - (mpf(shape.base_radius) + growth * s / square) ** 2

        t = mp.findroot(off, mpf(float(row["t"])), tol=1e-30)  # type: ignore[attr-defined]
        true = mp.norm(exact(row["origin"]) + d * t - exact(row["point"]))
        assert true <= row["error"]
    assert found > 20

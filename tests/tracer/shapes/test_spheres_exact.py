"""Spheres against 50 digits: far, huge, tiny and grazed ones, through the public interface.

u is the rounding unit, 2^-53; an ulp is up to 2 u. A tolerance is in ulps of the exact result for the recorded ray:
nothing is added for how the ray was specified.
"""

import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

import tracer
from tests.scenes import GLASS, MATTE, ball, box, world_of
from tracer.kernel.nodes import BACKGROUND

mpmath.mp.dps = 50
U = 2.0**-53

Vector = tuple[float, ...]


def roots(origin: Vector, direction: Vector, center: Vector, radius: float) -> tuple[mpf, mpf] | None:
    """Both distances, in units of the direction's length; None for a miss."""
    f = [mpf(o) - mpf(c) for o, c in zip(origin, center, strict=True)]
    d = [mpf(x) for x in direction]
    a, b = mpmath.fdot(d, d), mpmath.fdot(f, d)
    discriminant = b * b - a * (mpmath.fdot(f, f) - mpf(radius) ** 2)
    if discriminant < 0:
        return None
    half = mpmath.sqrt(discriminant)
    return ((-b - half) / a, (-b + half) / a)


def hit(origin: Vector, direction: Vector, center: Vector, radius: float) -> tuple[float | None, mpf | None]:
    """(distance found, exact distance) of the first hit, None for a miss."""
    tree = tracer.trace(
        world_of(ball((center[0], center[1], center[2]), radius, MATTE)), ray=(origin, direction), depth=0
    )
    row = tree.nodes[0]
    exact = roots(tuple(row["origin"]), tuple(row["direction"]), center, radius)
    first = None if exact is None else next((t for t in exact if t > 0), None)
    return (None if row["end"] == BACKGROUND else float(row["t"]), first)


def ulps(found: float | None, exact: mpf | None, of: float | None = None) -> float:
    assert (found is None) == (exact is None), f"found {found}, exact {exact}"
    if found is None or exact is None:
        return 0.0
    return float(abs(mpf(found) - exact) / math.ulp(float(exact) if of is None else of))


@pytest.mark.parametrize("distance", [1e3, 1e6, 4.6e7, 1.9e8, 1e9, 1e12, 3e15])
def test_far_ball_is_hit_where_it_is(distance: float) -> None:
    w = np.array([0.3, -0.5, 0.81])
    w /= np.linalg.norm(w)
    random = np.random.default_rng(1)
    for _ in range(40):
        target = random.uniform(-1, 1, 3) * 0.5
        origin = tuple(map(float, target - distance * w))
        assert ulps(*hit(origin, tuple(map(float, w)), (0.0, 0.0, 0.0), 1.0)) <= 1.0


@pytest.mark.parametrize("k", [4, 10, 20, 30, 40, 50, 52])
def test_start_just_above_the_surface(k: int) -> None:
    """2^-k above the pole: only the exact form of the near root does not cancel."""
    for direction in ((0.6, 0.0, -0.8), (0.28, 0.0, -0.96), (0.1, 0.7, -0.3), (0.9, -0.4, -0.5)):
        found, exact = hit((0.0, 0.0, 1.0 + 2.0**-k), direction, (0.0, 0.0, 0.0), 1.0)
        assert ulps(found, exact) <= 1.0


def test_start_next_to_the_surface_anywhere() -> None:
    """One or four rounding errors outside or inside: the side, and so the choice of the root, takes all digits.

    t is (|f|^2 - r^2) / 2 r cos, a difference of which double-double keeps 104 bits of r^2.
    """
    random = np.random.default_rng(5)
    missed = 0
    for _ in range(400):
        center, radius = random.normal(size=3), 10.0 ** random.uniform(-2, 2)
        n, w = random.normal(size=(2, 3))
        n, w = n / np.linalg.norm(n), w / np.linalg.norm(w)
        origin = center + radius * (1.0 + random.uniform(-4, 4) * U) * n
        found, exact = hit(tuple(origin.tolist()), tuple(w.tolist()), tuple(center.tolist()), radius)
        missed += exact is None
        assert (found is None) == (exact is None)
        if found is not None and exact is not None:
            assert abs(found - exact) <= math.ulp(float(exact)) + 8 * U**2 * radius / abs(n @ w)
    assert 50 < missed < 350


@pytest.mark.parametrize("radius", [1e3, 1e6, 6.371e6, 1e9, 1e12, 1e15])
def test_huge_ground_sphere(radius: float) -> None:
    assert ulps(*hit((0.0, 0.0, 1.0), (0.6, 0.0, -0.8), (0.0, 0.0, -radius), radius)) <= 1.0
    random = np.random.default_rng(2)
    for _ in range(40):
        tilt, turn = random.uniform(0, math.radians(80)), random.uniform(0, 2 * math.pi)
        direction = (math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), -math.cos(tilt))
        origin = (random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.5, 2.0))
        assert ulps(*hit(origin, direction, (0.0, 0.0, -radius), radius)) <= 1.0


@pytest.mark.parametrize("radius", [1e3, 1e6, 1e9, 1e12])
def test_point_on_a_huge_sphere_keeps_the_digits_of_its_neighbourhood(radius: float) -> None:
    """The centre is so far away that a point computed from it would be off by u times the radius."""
    tree = tracer.trace(
        world_of(ball((0, 0, -radius), radius, MATTE)), ray=((0.3, 0.2, 1.0), (0.6, 0.1, -0.8)), depth=0
    )
    row = tree.nodes[0]
    exact = roots(tuple(row["origin"]), tuple(row["direction"]), (0.0, 0.0, -radius), radius)
    assert exact is not None
    for found, o, d in zip(row["point"], row["origin"], row["direction"], strict=True):
        assert abs(mpf(float(found)) - (mpf(float(o)) + exact[0] * mpf(float(d)))) <= 4 * U * 3.0


@pytest.mark.parametrize("radius", [1e-3, 1e-5, 1e-6, 1e-9, 1e-12, 1e-100, 1e-150])
def test_tiny_ball_is_seen_and_crossed(radius: float) -> None:
    tree = tracer.trace(world_of(ball((0, 0, 0), radius, GLASS)), ray=((0, 0, 1), (0, 0, -1)), depth=2)
    assert [tree.object_name(i) for i in range(3)] == ["ball", "ball", None]
    assert abs(tree.nodes["t"][0] - (1.0 - radius)) <= math.ulp(1.0)
    assert tree.nodes["t"][1] == pytest.approx(2.0 * radius, rel=4 * U, abs=0.0)
    assert tree.nodes["normal"][:2].tolist() == [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
    assert tree.nodes["direction"][2].tolist() == [0.0, 0.0, -1.0]


@pytest.mark.parametrize("radius", [1e-9, 1e-12, 1e-15])
def test_normal_of_a_tiny_ball_far_off(radius: float) -> None:
    """The distance has no digits left for the ball, but its normal does: it is computed at the ray's closest point."""
    aside = 0.6 * radius
    tree = tracer.trace(world_of(ball((0, 0, 0), radius, MATTE)), ray=((aside, 0, 3), (0, 0, -1)), depth=0)
    assert tree.nodes["normal"][0].tolist() == pytest.approx([0.6, 0.0, 0.8], abs=4 * U)
    assert tree.nodes["point"][0].tolist() == pytest.approx([aside, 0.0, 0.8 * radius], rel=8 * U, abs=0.0)


@pytest.mark.parametrize("k", range(10, 53, 3))
def test_grazing_rays_are_decided_rightly_and_their_chords_are_right(k: int) -> None:
    below, above = 1.0 - 2.0**-k, 1.0 + 2.0**-k
    assert hit((0.0, below, -5.0), (0, 0, 1), (0.0, 0.0, 0.0), 1.0)[0] is not None
    assert hit((0.0, above, -5.0), (0, 0, 1), (0.0, 0.0, 0.0), 1.0)[0] is None
    assert ulps(*hit((0.0, below, 0.0), (1, 0, 0), (0.0, 0.0, 0.0), 1.0)) <= 1.0
    assert ulps(*hit((0.0, below, -5.0), (0, 0, 1), (0.0, 0.0, 0.0), 1.0)) <= 1.0


def test_tangent_and_start_on_the_surface_are_finite() -> None:
    assert hit((1.0, 0.0, -5.0), (0, 0, 1), (0.0, 0.0, 0.0), 1.0)[0] == 5.0
    assert hit((1.0, 0.0, 0.0), (0, 0, 1), (0.0, 0.0, 0.0), 1.0)[0] is None


@pytest.mark.parametrize("size", [1e-300, 1e-170, 1e-100, 1e100, 1e170, 1e300])
def test_length_of_the_direction_is_no_matter(size: float) -> None:
    assert hit((0.0, 0.0, 5.0), (0, 0, -size), (0.0, 0.0, 0.0), 1.0)[0] == 4.0


def test_random_spheres_of_all_sizes_and_places() -> None:
    """Sizes and distances 10^-8 to 10^8, aimed from the middle to beyond the rim: off by at most one float."""
    random = np.random.default_rng(3)
    near_misses = 0
    for _ in range(1500):
        radius, away = 10.0 ** random.uniform(-8, 8), 10.0 ** random.uniform(-8, 8)
        center = random.normal(size=3) * 10.0 ** random.uniform(-8, 8)
        w, aside = random.normal(size=(2, 3))
        w /= np.linalg.norm(w)
        aside -= (aside @ w) * w
        aside /= np.linalg.norm(aside)
        impact = radius * (1.0 + random.choice([-1, 1]) * 10.0 ** random.uniform(-16, 0))
        origin = center + impact * aside - (radius + away) * w
        ray = (tuple(map(float, origin)), tuple(map(float, w)))
        found, exact = hit(*ray, tuple(map(float, center)), radius)
        near_misses += found is None
        assert ulps(found, exact) <= 1.0
    assert 100 < near_misses < 1400  # the set has both hits and misses


def test_closest_hit_and_shadow_ray_agree_on_grazing_spheres() -> None:
    """Closest-hit and any-hit tests agree: what a ray hits casts a shadow along it, and nothing else does."""
    from tracer.scene import Light

    random = np.random.default_rng(4)
    blocker = ball((0, 0, 0), 1.0, MATTE, "ball")
    floor = box((-10, -10, -1e6 - 1), (10, 10, -1e6), MATTE, "floor")
    disagreements, hits = 0, 0
    for _ in range(400):
        angle, impact = random.uniform(0, 2 * math.pi), 1.0 + random.choice([-1, 1]) * 10.0 ** random.uniform(-16, -2)
        x, y = float(impact * math.cos(angle)), float(impact * math.sin(angle))
        world = world_of(blocker, floor, lights=[Light("lamp", position=(x, y, 10.0))])
        seen = tracer.trace(world, ray=((x, y, -1e6 + 1.0), (0, 0, -1)), depth=0)
        assert seen.object_name(0) == "floor"
        met = tracer.trace(world, ray=((x, y, -1e6), (0, 0, 1)), depth=0)
        blocked = seen.end(1) == "blocked"
        hits += blocked
        disagreements += blocked != (met.object_name(0) == "ball")
    assert disagreements == 0
    assert 100 < hits < 300

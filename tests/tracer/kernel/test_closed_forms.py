"""Scenes with results in closed form. Tolerances are rounding units times a stated condition number."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import DARK, GLASS, MATTE, MIRROR, ball, box, ends, kinds, plane, world_of
from tracer.scene import Camera, Light, Material

U = 2.0**-53


@pytest.mark.parametrize("n", [1.0003, 4 / 3, 1.5, 2.42, 100.0])
@pytest.mark.parametrize("depth", [2, 3, 7])
def test_ray_through_the_centre_of_a_ball_goes_straight_on(n: float, depth: int) -> None:
    """Down the z axis through a unit ball, in at (0,0,1), out at (0,0,-1), for any index. Source: P. Shirley's first
    test.
    """
    world = world_of(ball(material=Material("glass", transmit=1.0, ior=n)), background=(0.25, 0.5, 0.75))
    tree = tracer.trace(world, ray=((0, 0, 5), (0, 0, -1)), depth=depth)
    assert kinds(tree) == ["camera", "refraction", "refraction"]
    assert (tree.nodes["direction"] == (0.0, 0.0, -1.0)).all()
    assert tree.nodes["point"][0].tolist() == [0.0, 0.0, 1.0]
    assert tree.nodes["normal"][0].tolist() == [0.0, 0.0, 1.0]
    assert tree.nodes["point"][1].tolist() == [0.0, 0.0, -1.0]
    assert tree.nodes["normal"][1].tolist() == [0.0, 0.0, 1.0]
    assert (tree.nodes["n1"][0], tree.nodes["n2"][0]) == (1.0, n)
    assert (tree.nodes["n1"][1], tree.nodes["n2"][1]) == (n, 1.0)
    assert tree.radiance.tolist() == [0.25, 0.5, 0.75]


def test_pole_of_a_ball_has_no_sideways_component() -> None:
    """A ray along a coordinate axis: tracers that offset the hit by an epsilon move it sideways here."""
    tree = tracer.trace(world_of(ball(material=GLASS)), ray=((0, 0, -5), (0, 0, 1)), depth=3)
    assert (tree.nodes["point"][:2, :2] == 0.0).all()
    assert tree.nodes["t"][:2].tolist() == [4.0, 2.0]


@pytest.mark.parametrize("degrees", [1, 30, 53.13010235415598, 80, 89])
def test_slab_shifts_a_ray_and_keeps_its_direction(degrees: float) -> None:
    """A slab of thickness 1 keeps the direction and shifts the ray by sin(t1) (1 - cos t1 / (n cos t2))."""
    n = 4 / 3
    a = math.radians(degrees)
    slab = box((-1000, 0, -1000), (1000, 1, 1000), Material("glass", transmit=1.0, ior=n))
    start = (-math.tan(a), 2.0, 0.0)  # so that it enters near x = 0
    tree = tracer.trace(world_of(slab), ray=(start, (math.sin(a), -math.cos(a), 0)), depth=2)
    assert kinds(tree) == ["camera", "refraction", "refraction"]
    d_in, d_out = tree.nodes["direction"][0], tree.nodes["direction"][2]
    assert np.abs(d_out - d_in).max() <= 8 * U / math.cos(a)
    cos2 = math.sqrt(1.0 - (math.sin(a) / n) ** 2)
    expected = math.sin(a) * (1.0 - math.cos(a) / (n * cos2))
    across = np.array([math.cos(a), math.sin(a), 0.0])
    shift = float((tree.nodes["point"][0] - tree.nodes["point"][1]) @ across)
    # The exit lies tan(t2) further along the slab: as many rounding units, and those of the entry.
    assert abs(shift - expected) <= 16 * U * (1.0 + math.tan(a))


@pytest.mark.parametrize("aside", [1e-14, 1e-12, 1e-9, 1e-3])
@pytest.mark.parametrize("model", ["whitted", "fresnel"])
def test_critical_angle_of_water_is_decided_on_the_right_side(aside: float, model: str) -> None:
    """asin(1 / 1.33), the lecture's 48.75 degrees: below it two rays leave, above it one, with the whole weight."""
    critical = tracer.optics.critical_angle(1.33, 1.0)
    assert critical is not None
    assert math.degrees(critical) == pytest.approx(48.75346663132723, rel=4 * U, abs=0.0)
    water = plane((0, 0, 0), (0, 1, 0), Material("water", reflect=0.1, transmit=0.9, ior=1.33), "water")
    world = world_of(water, model=model)
    for sign, expected in ((-1, ["camera", "reflection", "refraction"]), (1, ["camera", "tir"])):
        a = critical + sign * aside
        tree = tracer.trace(world, ray=((0, -1, 0), (math.sin(a), math.cos(a), 0)), depth=1)
        assert kinds(tree) == expected
        assert (tree.nodes["radicand"][0] > 0.0) == (sign < 0)
        assert (tree.nodes["n1"][0], tree.nodes["n2"][0]) == (1.33, 1.0)
    assert tree.nodes["factor"][1].tolist() == [1.0, 1.0, 1.0]  # kr + kt


@pytest.mark.parametrize("model", ["whitted", "fresnel"])
def test_at_the_critical_angle_itself_all_light_is_reflected(model: str) -> None:
    """sin 3/5 and n = 5/3: the radicand is exactly 0, and there is one ray."""
    dense = Material("dense", reflect=0.25, transmit=0.75, ior=5 / 3)
    world = world_of(plane((0, 0, 0), (0, 1, 0), dense), model=model)
    tree = tracer.trace(world, ray=((0, -1, 0), (3, 4, 0)), depth=1)
    assert tree.nodes["radicand"][0] == 0.0
    assert kinds(tree) == ["camera", "tir"]
    assert tree.nodes["factor"][1].tolist() == [1.0, 1.0, 1.0]


def test_parallel_mirrors_are_met_at_equal_steps() -> None:
    """Between x = 0 and x = 1, rising 2^-10 a crossing: y_N = (N - 1/2) / 1024, up to the rounding of N reflections."""
    world = world_of(plane((0, 0, 0), (1, 0, 0), MIRROR, "left"), plane((1, 0, 0), (-1, 0, 0), MIRROR, "right"))
    tree = tracer.trace(world, ray=((0.5, 0, 0), (1, 2.0**-10, 0)), depth=100)
    hits = tree.nodes["point"]
    assert len(tree) == 101
    assert (hits[:, 0] == [float(k % 2 == 0) for k in range(101)]).all()
    expected = (np.arange(1, 102) - 0.5) / 1024
    assert (np.abs(hits[:, 1] - expected) <= 4 * U * np.arange(1, 102) * expected).all()
    assert (tree.nodes["weight"] == 1.0).all()


def test_shadow_of_a_ball_ends_where_the_cone_of_light_does() -> None:
    """Light at (0,10,0), ball of radius 3 about (0,5,0): the shadow on the floor has radius 7.5."""
    lamp = Light("lamp", position=(0.0, 10.0, 0.0))
    world = world_of(plane((0, 0, 0), (0, 1, 0), MATTE, "floor"), ball((0, 5, 0), 3, MATTE), lights=[lamp])
    for share, expected in ((1 - 1e-12, "blocked"), (1 + 1e-12, "lit"), (0.5, "blocked"), (2.0, "lit")):
        for angle in (0.0, 1.0, 2.5):
            x, z = 7.5 * share * math.cos(angle), 7.5 * share * math.sin(angle)
            tree = tracer.trace(world, ray=((x, 0.5, z), (0, -1, 0)), depth=0)
            assert ends(tree) == ["surface", expected]
    assert tree.object_name(1) is None
    blocked = tracer.trace(world, ray=((7.0, 0.5, 0), (0, -1, 0)), depth=0)
    assert blocked.object_name(1) == "ball"
    assert blocked.nodes["radiance"][1].tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("depth", [0, 1, 2, 10, 40])
def test_white_furnace(depth: int) -> None:
    """Inside a ball with emission 1 and reflectance 1/2: 2 - 2^-D, bit for bit, in every direction."""
    shell = ball((0, 0, 0), 1.0, Material("shell", ambient=1.0, reflect=0.5))
    world = world_of(shell)
    for direction in ((1, 0, 0), (1, 2, 3), (-0.3, 0.1, 0.9)):
        tree = tracer.trace(world, ray=((0.1, 0.2, -0.3), direction), depth=depth)
        assert tree.radiance.tolist() == [2.0 - 2.0**-depth] * 3
        assert tree.residual == 2.0 ** -(depth + 1)


def test_mirror_of_weight_one_has_one_child() -> None:
    tree = tracer.trace(
        world_of(plane((0, 0, 0), (0, 1, 0), MIRROR), background=(1, 1, 1)), ray=((0, 1, 0), (1, -1, 0))
    )
    assert kinds(tree) == ["camera", "reflection"]
    assert tree.nodes["direction"][1].tolist() == pytest.approx([math.sqrt(0.5), math.sqrt(0.5), 0.0], abs=2 * U)


@pytest.mark.parametrize("n", [1.0, 1.5])
def test_equal_indices_send_one_ray_straight_on(n: float) -> None:
    """If the medium changes but not the index of refraction, the ray goes straight on and nothing is reflected: with kt
    in Whitted's model, with all of kr + kt in Fresnel's, where R tends to 0.
    """
    same = Material("same", reflect=0.3, transmit=0.7, ior=n)
    outer = box((-2, -2, -2), (2, 2, 2), same, "outer")
    inner = box((-1, -1, -1), (1, 1, 1), same, "inner", priority=1)
    for model, factor in (("whitted", 0.7), ("fresnel", 1.0)):
        world = world_of(outer, inner, model=model)
        tree = tracer.trace(world, ray=((-1.5, 0.1, 0.2), (3, 0.1, 0.3)), depth=1)
        assert kinds(tree) == ["camera", "refraction"]
        assert (tree.nodes["direction"][1] == tree.nodes["direction"][0]).all()
        assert tree.nodes["factor"][1].tolist() == [factor] * 3
        assert tree.ledger == pytest.approx((0.0, factor**2, 1.0 - factor**2), abs=4 * U)


def test_concave_mirror_sends_rays_through_the_closed_form_of_its_axis() -> None:
    """Radius 1: a ray parallel to the axis at height h crosses it 1 / (2 cos a) from the centre, sin a = h."""
    world = world_of(ball(material=MIRROR))
    for h, crossing in ((0.6, 0.625), (0.8, 5 / 6)):
        tree = tracer.trace(world, ray=((0, h, 0), (1, 0, 0)), depth=1)
        start, d = tree.nodes["origin"][1], tree.nodes["direction"][1]
        t = -start[1] / d[1]
        assert start[0] + t * d[0] == pytest.approx(crossing, abs=8 * U)


def test_no_epsilon_swallows_near_surfaces() -> None:
    """A coat thinner than any usual epsilon: the core is hit, at the distance of the gap."""
    for gap in (1e-3, 1e-6, 1e-9, 1e-12):
        coat = ball((0, 0, 0), 1.0 + gap, Material("coat", transmit=1.0, ior=1.5), "coat")
        world = world_of(coat, ball((0, 0, 0), 1.0, DARK, "core"))
        tree = tracer.trace(world, ray=((0.2, 0, 5), (0, 0, -1)), depth=1)
        assert [tree.object_name(i) for i in range(2)] == ["coat", "core"]
        # The gap is known to about 8 rounding units of 1. The chord through it is a little longer.
        assert abs(tree.nodes["t"][1] - gap * tree_length(gap)) <= 16 * U + 1e-3 * gap


def tree_length(gap: float) -> float:
    """Length of the refracted path through a coat of thickness 1, impact parameter 0.2, n = 1.5, to first order."""
    return 1.0 / math.sqrt(1.0 - (0.2 / 1.5) ** 2)


def test_two_panes_with_a_hair_between_them_are_four_surfaces() -> None:
    for gap in (1e-2, 1e-6, 1e-12):
        glass = Material("glass", transmit=1.0, ior=1.5)
        panes = [
            box((-99, 0, -99), (99, 1, 99), glass, "first"),
            box((-99, 1 + gap, -99), (99, 2, 99), glass, "second"),
        ]
        tree = tracer.trace(
            world_of(*panes), ray=((0, -1, 0), (math.sin(math.pi / 6), math.cos(math.pi / 6), 0)), depth=5
        )
        assert [tree.object_name(i) for i in range(4)] == ["first", "first", "second", "second"]
        assert np.degrees(tree.nodes["theta1"][[0, 2]]) == pytest.approx([30, 30], abs=1e-12)
        assert np.abs(tree.nodes["direction"][4] - tree.nodes["direction"][0]).max() <= 16 * U


def test_scaling_a_scene_by_a_power_of_two_scales_its_tree_and_nothing_else() -> None:
    """No length is built in: a scene times 2^-200 or 2^200 has the same bits."""

    def tree_at(k: int) -> tracer.RayTree:
        s = 2.0**k
        glass = Material("glass", diffuse=0.1, specular=0.3, shininess=20, reflect=0.1, transmit=0.9, ior=1.5)
        objects = (
            ball((0, s, 0), s, glass, "ball"),
            plane((0, 0, 0), (0, 1, 0), MATTE, "floor"),
            box((-3 * s, 0, -3 * s), (-2 * s, s, -2 * s), MIRROR, "block"),
        )
        lamp = Light("lamp", position=(2 * s, 5 * s, 3 * s))
        world = world_of(*objects, lights=[lamp], background=(0.1, 0.2, 0.3))
        return tracer.trace(world, ray=((0.2 * s, 1.3 * s, 4 * s), (-0.1, -0.2, -1)), depth=6)

    reference = tree_at(0)
    assert len(reference) > 20
    for k in (-200, -20, -1, 1, 20, 200):
        tree = tree_at(k)
        assert len(tree) == len(reference)
        for field in reference.nodes.dtype.names or ():
            factor = 2.0**k if field in ("origin", "point", "t", "error") else 1
            expected = reference.nodes[field] * factor if factor != 1 else reference.nodes[field]
            np.testing.assert_array_equal(tree.nodes[field], expected, err_msg=f"{field} at 2^{k}")


@pytest.mark.parametrize("k", [-1074, -600, 490])
def test_length_of_a_direction_is_no_matter(k: int) -> None:
    """Lengths of the normal, of the light's direction and of the camera's up vector do not change a bit."""

    def tree_with(s: float) -> tracer.RayTree:
        slope = plane((0, 0, 0), (0, s, 0), Material("floor", diffuse=0.5, reflect=0.25), "floor")
        light = Light("sun", direction=(s, -s, s))
        camera = Camera(position=(1.0, 2.0, 3.0), look_at=(0.0, 0.0, 0.0), up=(s, s, 0.0))
        world = world_of(slope, lights=[light], camera=camera, background=(0.1, 0.2, 0.3))
        return tracer.trace(world, (20, 40))

    assert tree_with(2.0**k).nodes.tobytes() == tree_with(1.0).nodes.tobytes()

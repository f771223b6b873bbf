"""The rules of the recursion: limits, cuts, thin sheets, media, Fresnel weights."""

import math
from dataclasses import replace

import numpy as np
import pytest

import tracer
from tests.scenes import GLASS, MATTE, MIRROR, ball, box, cone, disc, ends, kinds, plane, sheet, world_of
from tracer.kernel.nodes import SHADOW
from tracer.scene import Checker, Light, Material

HALF_MIRROR = Material("half", reflect=0.5)
SUN = Light("sun", direction=(0.0, -1.0, 0.0))


def plates(count: int) -> tracer.World:
    """Glass plates one behind the other: the tree doubles at every face."""
    glass = Material("glass", reflect=0.2, transmit=0.8, ior=1.5)
    faces = [box((-9, -9, 2.0 * k), (9, 9, 2.0 * k + 1), glass, f"plate {k}") for k in range(count)]
    return world_of(*faces, background=(1.0, 1.0, 1.0))


def test_depth_limit_cuts_and_says_so() -> None:
    world = world_of(ball(material=HALF_MIRROR))
    tree = tracer.trace(world, ray=((0, 0, 0), (1, 2, 3)), depth=4)
    assert ends(tree) == [None, None, None, None, "depth"]
    assert tree.residual == 0.5**5
    assert tree.nodes["weight"][:, 0].tolist() == [0.5**k for k in range(5)]


def test_weight_limit_cuts_what_weighs_less() -> None:
    world = world_of(ball(material=HALF_MIRROR))
    tree = tracer.trace(world, ray=((0, 0, 0), (1, 2, 3)), depth=100, min_weight=0.25)
    assert ends(tree) == [None, None, "weight"]  # 1, 1/2, 1/4; 1/8 is below the limit
    assert tree.residual == 0.125


@pytest.mark.parametrize("most", [1, 2, 7, 50, 1000])
def test_node_limit_never_cuts_silently(most: int) -> None:
    tree = tracer.trace(plates(3), ray=((0, 0, 9), (0.1, 0.2, -1)), depth=30, max_nodes=most)
    assert len(tree) <= most
    assert "nodes" in ends(tree)
    assert tree.residual > 0.0


@pytest.mark.parametrize("limits", [{"depth": 5}, {"depth": 40, "min_weight": 1e-3}, {"depth": 40, "max_nodes": 300}])
def test_what_is_missing_is_within_the_residual(limits: dict) -> None:
    """If nothing emits light but the background, cut rays lose at most their weights times its colour."""
    world = plates(2)
    ray = ((0.3, 0.1, 9), (0.1, 0.05, -1))
    cut = tracer.trace(world, ray=ray, **limits)
    full = tracer.trace(world, ray=ray, depth=60, min_weight=1e-9)
    missing = float((full.radiance - cut.radiance).max())
    assert full.residual < 1e-4
    assert 0.0 <= missing <= cut.residual + full.residual
    leaves = cut.nodes["weight"][cut.nodes["end"] == 1].sum(axis=0)[0]
    assert leaves + cut.residual == pytest.approx(1.0, abs=len(cut) * 2.0**-50)


def test_node_limit_is_used_to_the_last_row() -> None:
    for most in (1, 2, 5):
        assert (
            len(tracer.trace(world_of(ball(material=HALF_MIRROR)), ray=((0, 0, 0), (1, 2, 3)), max_nodes=most, depth=9))
            == most
        )


def test_phong_highlight() -> None:
    """ks (R.V)^p, in at 45 degrees and out along the normal: cos(45)^2 = 1/2."""
    shiny = Material("shiny", specular=0.5, shininess=2.0)
    lamp = Light("lamp", position=(4.0, 4.0, 0.0))
    tree = tracer.trace(
        world_of(plane((0, 0, 0), (0, 1, 0), shiny), lights=[lamp]), ray=((0, 2, 0), (0, -1, 0)), depth=0
    )
    assert tree.radiance == pytest.approx([0.25] * 3, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("model", ["whitted", "fresnel"])
def test_thin_sheet_transmits_unbent(model: str) -> None:
    pane = sheet(0.0, Material("sheet", reflect=0.1, transmit=0.9, ior=1.5))
    tree = tracer.trace(world_of(pane, model=model), ray=((0, 1, 0), (1, -2, 0.5)), depth=1)
    assert kinds(tree) == ["camera", "reflection", "refraction"]
    assert (tree.nodes["direction"][2] == tree.nodes["direction"][0]).all()
    assert tree.nodes["n2"][0] == tree.nodes["n1"][2] == 1.0
    assert tree.ledger == pytest.approx((1.0, 0.0, 0.0), abs=4 * 2.0**-53)
    if model == "whitted":
        assert tree.nodes["factor"][1:, 0].tolist() == [0.1, 0.9]
    else:
        cos1 = -float(tree.nodes["direction"][0] @ tree.nodes["normal"][0])
        r, t = tracer.optics.fresnel(cos1, 1.0, 1.5)
        assert tree.nodes["factor"][1:, 0] == pytest.approx([r, t], rel=1e-14, abs=0.0)


@pytest.mark.parametrize("sine", [0.8, 0.95])
def test_thin_sheet_of_less_index_than_where_it_lies_reflects_all(sine: float) -> None:
    """A sheet of air in glass of index 1.5, beyond the critical angle: nothing is transmitted."""
    gap = sheet(0.0, Material("gap", reflect=0.25, transmit=0.5, ior=1.0))
    world = world_of(box((-9, -9, -9), (9, 9, 9), GLASS), gap, model="fresnel")
    tree = tracer.trace(world, ray=((0, 1, 0), (sine, -math.sqrt(1 - sine * sine), 0)), depth=1)
    assert kinds(tree) == ["camera", "reflection"]
    assert tree.nodes["factor"][1].tolist() == [0.75] * 3


def test_grazing_ray_lets_through_what_the_formula_says() -> None:
    """At c1 = 2^-40 on n = 3/2 almost nothing is transmitted. Computed as 1 - R, T would keep 4 digits.

    T = 2 c1 n c2 (1 / (c1 + n c2)^2 + 1 / (n c1 + c2)^2), with n c2 = sqrt(n^2 - 1 + c1^2).
    """
    c1, n = 2.0**-40, 1.5
    glass = plane((0, 0, 0), (0, 1, 0), Material("glass", transmit=1.0, ior=n), "glass")
    tree = tracer.trace(world_of(glass, model="fresnel"), ray=((-1, c1, 0), (1, -c1, 0)), depth=1)
    assert kinds(tree) == ["camera", "reflection", "refraction"]
    n_c2 = math.sqrt(n * n - 1 + c1 * c1)
    expected = 2 * c1 * n_c2 * (1 / (c1 + n_c2) ** 2 + 1 / (n * c1 + n_c2 / n) ** 2)
    assert tree.nodes["factor"][2][0] == pytest.approx(expected, rel=16 * 2.0**-53, abs=0.0)


def test_fresnel_weights_are_those_of_the_formula() -> None:
    glass = ball(material=Material("glass", reflect=0.05, transmit=0.9, ior=1.5))
    tree = tracer.trace(world_of(glass, model="fresnel"), ray=((0.5, 0.1, 5), (0, 0, -1)), depth=1)
    cos1 = math.cos(tree.nodes["theta1"][0])
    r, t = tracer.optics.fresnel(cos1, 1.0, 1.5)
    assert r + t == pytest.approx(1.0, abs=4e-16)
    assert tree.nodes["factor"][1:, 0] == pytest.approx([0.95 * r, 0.95 * t], rel=1e-14, abs=0.0)
    n1, n2 = tree.nodes["n1"][0], tree.nodes["n2"][0]
    assert n1 * math.sin(tree.nodes["theta1"][0]) == pytest.approx(
        n2 * math.sin(tree.nodes["theta2"][0]), rel=1e-15, abs=0.0
    )


def test_eye_in_the_glass_starts_with_its_index() -> None:
    world = world_of(ball(material=GLASS, name="glass"))
    tree = tracer.trace(world, ray=((0.1, 0, 0), (1, 0, 0)), depth=1)
    assert (tree.nodes["n1"][0], tree.nodes["n2"][0]) == (1.5, 1.0)
    assert kinds(tree) == ["camera", "refraction"]


def test_eye_under_water_that_is_a_half_space() -> None:
    water = plane((0, 0, 0), (0, 1, 0), Material("water", transmit=1.0, ior=1.33), "water")
    tree = tracer.trace(world_of(water), ray=((0, -3, 0), (0, 1, 0)), depth=1)
    assert (tree.nodes["n1"][0], tree.nodes["n2"][0]) == (1.33, 1.0)


def test_water_in_glass_with_touching_faces() -> None:
    """air | glass | water | air at 60 degrees: the angles of a stack of plane layers, no false total reflection."""
    glass = Material("glass", transmit=1.0, ior=1.5)
    water = Material("water", transmit=1.0, ior=4 / 3)
    expected = [60.0, 35.264389682754654, 40.505350327418596, 60.0]
    start, d = (0.0, -1.0, 0.0), (math.sin(math.pi / 3), 0.5, 0.0)
    touching = [box((-99, 0, -99), (99, 1, 99), glass, "glass"), box((-99, 1, -99), (99, 3, 99), water, "water")]
    overlapping = [
        box((-99, 0, -99), (99, 1, 99), glass, "glass", priority=1),
        box((-99, 0.9, -99), (99, 3, 99), water, "water"),
    ]
    for objects in (touching, touching[::-1], overlapping, overlapping[::-1]):
        tree = tracer.trace(world_of(*objects), ray=(start, d), depth=3)
        assert kinds(tree) == ["camera", "refraction", "refraction", "refraction"]
        assert tree.nodes["n1"].tolist() == [1.0, 1.5, 4 / 3, 1.0]
        cosines = np.abs(tree.nodes["direction"][:, 1])
        assert np.degrees(np.arccos(cosines)) == pytest.approx(expected, abs=1e-12)
        assert tree.nodes["point"][2][1] == 3.0


def test_the_same_glass_twice_is_met_once() -> None:
    one = ball(material=GLASS, name="one")
    two = ball(material=GLASS, name="two")
    ray = ((0.4, 0.2, 5), (0, 0, -1))
    single = tracer.trace(world_of(one), ray=ray, depth=4)
    double = tracer.trace(world_of(one, two), ray=ray, depth=4)
    assert double.nodes["point"].tobytes() == single.nodes["point"].tobytes()
    assert [double.object_name(i) for i in range(2)] == ["one", "one"]


def test_what_was_entered_unseen_is_still_around_after_a_reflection() -> None:
    """A medium that was entered inside another, without a visible surface, still counts after a reflection.

    Into glass at z = 0, into water within it at z = 1, hidden; reflected at z = 2, and out of the glass at its side.
    """
    glass = box((-1, -9, 0), (1, 9, 2), Material("glass", reflect=0.5, transmit=0.5, ior=1.5), "glass", priority=1)
    water = box((-5, -9, 1), (5, 9, 5), Material("water", transmit=1.0, ior=1.33), "water")
    tree = tracer.trace(world_of(glass, water), ray=((-1.3, 0, -1), (1, 0, 1)), depth=2)
    (back,) = (row for k, row in enumerate(tree.nodes) if tree.kind(k) == "reflection" and row["depth"] == 2)
    assert back["point"][0] == 1.0 and 1.0 < back["point"][2] < 2.0
    assert (back["n1"], back["n2"]) == (1.5, 1.33)


def test_opaque_thing_in_glass_is_seen_through_it() -> None:
    core = ball((0, 0, 0), 0.5, MATTE, "core")
    tree = tracer.trace(world_of(ball(material=GLASS, name="glass"), core), ray=((0, 0, 5), (0, 0, -1)), depth=3)
    assert [tree.object_name(i) for i in range(2)] == ["glass", "core"]
    assert (tree.nodes["n1"][1], tree.nodes["end"][1]) == (1.5, 0)
    assert math.isnan(tree.nodes["n2"][1])


def test_checker_on_a_plane_and_in_space() -> None:
    squares = Material("squares", color=(1, 1, 1), ambient=1.0, checker=Checker((0.0, 0.0, 0.0), 0.5))
    floor = world_of(plane((0, 0, 0), (0, 1, 0), squares))
    for x, z, expected in ((0.1, 0.1, 1), (0.6, 0.1, 0), (0.6, 0.6, 1), (-0.1, 0.1, 0), (-0.1, -0.1, 1)):
        assert tracer.trace(floor, ray=((x, 1, z), (0, -1, 0))).radiance[0] == expected
    cubes = world_of(box((-1, -1, -1), (1, 1, 1), squares))
    for x, z, expected in ((0.1, 0.1, 1), (0.6, 0.1, 0), (0.6, 0.6, 1)):
        assert tracer.trace(cubes, ray=((x, 3, z), (0, -1, 0))).radiance[0] == expected  # its top is layer 2: even


def test_children_of_a_split_come_reflected_first() -> None:
    both = ball(material=Material("both", reflect=0.3, transmit=0.6, ior=1.5))
    tree = tracer.trace(world_of(both, lights=[SUN]), ray=((0.3, 0.2, 5), (0, 0, -1)), depth=2)
    for i in range(len(tree)):
        below = [tree.kind(child) for child in tree.children[i] if tree.nodes["kind"][child] != SHADOW]
        assert below in ([], ["reflection", "refraction"], ["tir"])


@pytest.mark.parametrize(
    ("ray", "said"),
    [
        (((0, 0, 0), (0, 0, 0)), "direction"),
        (((0, 0, math.nan), (0, 0, 1)), "finite"),
        (((0, 0, 0), (math.inf, 0, 1)), "finite"),
    ],
)
def test_a_ray_without_direction_is_refused(ray: tuple, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        tracer.trace(world_of(ball()), ray=ray)


@pytest.mark.parametrize("length", [1e-170, 1e-100, 1.0, 1e100, 1e170])
def test_direction_may_have_any_length(length: float) -> None:
    tree = tracer.trace(world_of(ball()), ray=((0, 0, 5), (0, 0, -length)), depth=0)
    assert tree.nodes["t"][0] == 4.0


def test_pixels_outside_the_image_are_refused() -> None:
    world = world_of(ball())
    for pixel in ((-1, 0), (64, 0), (0, 48)):
        with pytest.raises(ValueError, match="pixel must be within"):
            tracer.trace(world, pixel)
    with pytest.raises(ValueError, match="one of them"):
        tracer.trace(world)


def test_mirrored_scene_has_the_mirrored_tree() -> None:
    """x negated everywhere: the same bits except for that sign."""

    def tree(sign: int) -> tracer.RayTree:
        objects = (
            ball(
                (0.3 * sign, 0, 0), 1, Material("glass", diffuse=0.2, specular=0.2, reflect=0.2, transmit=0.8, ior=1.5)
            ),
            box((min(1.5 * sign, 2.5 * sign), -1, -2), (max(1.5 * sign, 2.5 * sign), 1, 0), MIRROR),
            plane((0, -1, 0), (0, 1, 0)),
        )
        lamp = Light("lamp", position=(2.0 * sign, 5.0, 3.0))
        return tracer.trace(
            world_of(*objects, lights=[lamp]), ray=((0.2 * sign, 0.5, 5), (0.03 * sign, -0.1, -1)), depth=6
        )

    right, left = tree(1), tree(-1)
    assert len(right) >= 20
    for field in ("origin", "direction", "point", "normal"):
        assert (right.nodes[field][:, 1:] == left.nodes[field][:, 1:]).all() or np.isnan(right.nodes[field]).any()
        np.testing.assert_array_equal(right.nodes[field][:, 0], -left.nodes[field][:, 0])
        np.testing.assert_array_equal(right.nodes[field][:, 1:], left.nodes[field][:, 1:])
    for field in ("t", "radiance", "weight", "theta1", "theta2", "kind", "end"):
        np.testing.assert_array_equal(right.nodes[field], left.nodes[field])


def test_solid_that_another_hides_is_named() -> None:
    """Water in a glass box of higher priority is never visible, and a note says so. With a higher priority it is
    visible.
    """
    glass, water = Material("glass", transmit=1.0, ior=1.5), Material("water", transmit=1.0, ior=1.33)
    outer = box((-1, -1, -1), (1, 1, 1), glass, "glass box")
    for more, said in (({}, ["water ball"]), ({"priority": 1}, [])):
        world = world_of(outer, ball((0, 0, 0), 0.5, water, "water ball", **more))
        assert [note.split('"')[1] for note in world.notes] == said
        tree = tracer.trace(world, ray=((0.1, 0.1, 3), (0, 0, -1)), depth=3)
        assert ("water ball" in {tree.object_name(i) for i in range(len(tree))}) == (not said)
    apart = world_of(outer, ball((0, 0, 0.6), 0.5, water, "water ball"))
    assert apart.notes == []


def test_open_surface_of_glass_is_named() -> None:
    """A cylinder closed by discs that are objects of their own: light that enters through a disc never leaves the
    glass.
    """
    glass = Material("glass", transmit=1.0, ior=1.5)
    side = cone((0, 0, 0), 1.0, (0, 1, 0), 1.0, glass, "side")
    lids = disc((0, 1, 0), (0, 1, 0), 1.0, glass, "top"), disc((0, 0, 0), (0, -1, 0), 1.0, glass, "bottom")
    world = world_of(side, *lids)
    (note,) = world.notes
    assert note.startswith('"side", "top", "bottom" are open (3 surfaces): light that enters stays')
    assert tracer.trace(world, ray=((0.1, 3, 0), (0.2, -1, 0)), depth=3).nodes["n1"][-1] == 1.5
    assert world_of(replace(side, thin=True), ball(material=glass), box((3, 3, 3), (4, 4, 4), glass)).notes == []

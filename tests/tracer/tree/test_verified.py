"""Verified trees: enclosures that contain the judge's answer, whatever the decisions."""

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp

import tracer
from tests.compared_trees import compared, judged_pixel, judged_ray
from tests.exact_scene import norm, sub, vec
from tests.planted_rays import planted_ray
from tests.random_scenes import random_scene, stiff_scene
from tests.scenes import GLASS, MATTE, MIRROR, OPEN, ball, box, cube_mesh, plane, polygon, world_of
from tracer.extras import MissingExtra
from tracer.formulas.double_double import U
from tracer.kernel.nodes import SHADOW
from tracer.scene import Checker, Light, Material, Object, Scene
from tracer.shapes.cone import Cone
from tracer.tree.raytree import RayTree
from tracer.tree.text import tree_text
from tracer.tree.verified.enclosures import VerifiedTree
from tracer.tree.verified.text import range_text, verified_text
from tracer.tree.verified.verifier import ROUNDING


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    """The differences from the judge's numbers are computed with as many digits as these have."""
    with mp.workdps(50):
        yield


def pixel_tree(scene: Scene, seed: int) -> RayTree:
    random = np.random.default_rng(seed)
    return tracer.trace(tracer.prepare(scene), (int(random.integers(32)), int(random.integers(24))))


def check(tree: RayTree, verified: VerifiedTree) -> list[float]:
    """The judge's numbers lie in the enclosures, and certified rows are the judge's rows. Returns relative widths."""
    ray = judged_pixel(tree.world, tree) if tree.ray is None else judged_ray(tree.world, tree)
    widths = []
    for channel, (low, high) in zip(ray.radiance, verified.color, strict=True):
        assert low <= channel <= high
        if channel > 0:
            widths.append((high - low) / float(channel))
    for i, one, agrees, whole in compared(tree, ray):
        row = verified.rows[i]
        assert agrees or not row.certified
        if tree.nodes["kind"][i] == SHADOW or not agrees:
            continue
        if row.certified:
            assert row.weight is not None
            assert row.weight[0] <= one.weight <= row.weight[1]
            for (low, high), exact in zip(row.point or (), one.point or (), strict=True):
                assert low <= exact <= high
            if one.point is not None:
                off = norm(sub(vec(tree.nodes["point"][i]), one.point))
                assert not off > tree.nodes["error"][i]  # the same of the two points where a ray can meet a shape
        if whole:
            for (low, high), exact in zip(row.radiance, one.radiance, strict=True):
                assert low <= exact <= high
    return widths


@pytest.mark.parametrize("scenes", [random_scene, stiff_scene])
def test_enclosures_contain_the_exact_tree(scenes: Callable[[int], Scene]) -> None:
    many(scenes, range(200))


@pytest.mark.slow
@pytest.mark.timeout(1500)
@pytest.mark.parametrize("scenes", [random_scene, stiff_scene])
def test_enclosures_of_ten_thousand_trees(scenes: Callable[[int], Scene]) -> None:
    many(scenes, range(1000, 6000))


def many(scenes: Callable[[int], Scene], seeds: range) -> None:
    decisions = certified = 0
    widths: list[float] = []
    for seed in seeds:
        tree = pixel_tree(scenes(seed), seed)
        verified = tracer.verify(tree.world, tree)
        widths += check(tree, verified)
        decisions += verified.decisions
        certified += verified.certified
    assert certified >= 0.99 * decisions
    assert np.median(widths) <= 1e-12


@pytest.mark.parametrize("scenes", [random_scene, stiff_scene])
def test_rays_aimed_at_outlines(scenes: Callable[[int], Scene]) -> None:
    """The enclosure of a decision that is not certified, or was recorded otherwise, is wide, and still holds."""
    open_ones = 0
    for seed in range(400):
        scene = scenes(seed)
        world = tracer.prepare(scene)
        ray = planted_ray(seed, scene, world)
        if ray is None:
            continue
        tree = tracer.trace(world, ray=ray, depth=3)
        verified = tracer.verify(world, tree)
        check(tree, verified)
        open_ones += verified.certified < verified.decisions
    assert open_ones > 5


def test_shipped_scenes(world: tracer.World) -> None:
    """Every decision of every lesson's tree is certified."""
    width, height = world.scene.image.width, world.scene.image.height
    for pixel in ((width // 3, height // 2), (width // 2 + 7, height // 3), (5, height - 5)):
        tree = tracer.trace(world, pixel)
        verified = tracer.verify(world, tree)
        assert verified.certified == verified.decisions
        assert verified.bits == 128
        for (low, high), color in zip(verified.color, tree.radiance, strict=True):
            assert low - tree.radiance_error <= color <= high + tree.radiance_error
            assert high - low <= 1e-12


def test_a_tie_is_enclosed_by_all_that_could_be() -> None:
    """A ray exactly at the edge of a bright square before a dark background: 0 to the most that a ray can bring."""
    square = polygon(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)), OPEN, "square")
    world = world_of(square, background=(0.25, 0.25, 0.25))
    tree = tracer.trace(world, ray=((1, 0.3, 5), (0, 0, -1)), depth=2)
    verified = tracer.verify(world, tree)
    assert (verified.certified, verified.decisions, verified.bits) == (0, 1, 512)
    assert verified.rows[0].doubts == ("which surface it meets",)
    for low, high in verified.color:
        assert low == 0.0
        assert high == pytest.approx(1.0, rel=1e-9)
        assert high >= 1.0


def test_only_what_hangs_on_an_open_decision_is_wide() -> None:
    """At the critical angle, sin = 4/5 for n = 5/4, the rays sent out are not certain, the surface's own light is."""
    glass = Material("glass", ambient=0.25, transmit=0.5, ior=1.25)
    world = world_of(plane((0, 0, 0), (0, 1, 0), glass, "glass"))
    tree = tracer.trace(world, ray=((0, -1, 0), (4, 3, 0)), depth=1)
    verified = tracer.verify(world, tree)
    assert verified.rows[0].doubts == ("total internal reflection or not",)
    assert verified.decisions - verified.certified == 1
    for low, high in verified.color:
        assert low == 0.25
        # Half of what any ray can bring, 0.25 / (1 - 0.5), is added, and both ends are rounded outwards.
        most = 0.25 + 0.25 * ROUNDING
        assert most <= high <= most + 4.0 * U


def test_without_a_bound_there_is_no_upper_end_and_the_text_says_why() -> None:
    shining = Material("shining glass", transmit=1.0, ior=1.5, specular=0.5)
    lamp = Light("lamp", position=(5.0, 5.0, 5.0))
    world = world_of(box((-1, -1, -1), (1, 1, 1), shining, "block"), lights=[lamp])
    tree = tracer.trace(world, ray=((1, 0.3, 5), (0, 0, -1)), depth=2)
    verified = tracer.verify(world, tree)
    assert verified.unbounded == "shining glass"
    assert all(high == math.inf for _, high in verified.color)
    assert 'no bound is known for the material "shining glass"' in verified_text(verified, tree.label)[0]
    assert verified.to_dict()["color"] == [[0.0, None]] * 3


def test_faces_in_one_plane_are_certified() -> None:
    """A glass block on a glass block, on a floor: the ray crosses both shared planes, and leaves them."""
    lower, upper = box((-1, 0, -1), (1, 1, 1), GLASS, "lower"), box((-0.7, 1, -0.7), (0.7, 2, 0.7), GLASS, "upper")
    world = world_of(lower, upper, plane((0, 0, 0), (0, 1, 0), MIRROR, "floor"), background=(0.5, 0.6, 0.7))
    tree = tracer.trace(world, ray=((0.1, 3, 0.2), (0.05, -1, 0.03)), depth=5)
    verified = tracer.verify(world, tree)
    assert len(tree) > 4
    assert verified.certified == verified.decisions
    check(tree, verified)


def test_a_recorded_decision_that_is_wrong_is_refuted() -> None:
    """A table that says another object was met is not believed."""
    world = world_of(ball((0, 0, 0), 1.0, MIRROR, "ball"), ball((5, 0, 0), 1.0, MATTE, "other"))
    tree = tracer.trace(world, ray=((0.3, 0.2, 5), (0, 0, -1)), depth=1)
    nodes = tree.nodes.copy()
    nodes["object"][0] = 1
    forged = RayTree(world, nodes, tree.details, 0.0, 1, "whitted", None, tree.size, ray=tree.ray)
    verified = tracer.verify(world, forged)
    assert verified.rows[0].doubts == ("it meets another surface than recorded",)
    assert not verified.rows[0].certified


def test_boxes_exclude_most_surfaces() -> None:
    balls = [ball((3 * x, 3 * y, 0), 1.0, MATTE, f"{x} {y}") for x in range(20) for y in range(20)]
    world = world_of(*balls)
    tree = tracer.trace(world, ray=((9.3, 12.2, 9), (0, 0, -1)), depth=0)
    verified = tracer.verify(world, tree)
    assert verified.tested + verified.boxed == 400
    assert verified.tested == 1


def test_without_the_library_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "flint", None)
    world = world_of(ball())
    with pytest.raises(MissingExtra, match=r"raytree\[verify\]"):
        tracer.verify(world, tracer.trace(world, (5, 5)))


SOLIDS = {
    "box": box((-0.6, 0.0, -0.6), (0.6, 1.2, 0.6), GLASS),
    "cylinder": Object(Cone((0.0, 0.0, 0.0), 0.6, (0.0, 1.2, 0.0), 0.6, True), GLASS, "cylinder"),
    "mesh": Object(cube_mesh(np.array([-0.6, 0.0, -0.6]), np.array([0.6, 1.2, 0.6])), GLASS, "cube"),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_another_face_of_the_same_object_is_not_certified(name: str) -> None:
    """Rays aimed at an edge: rounding takes one face, the exact ray may meet the other. Where all is certified, the
    recorded colour is the exact one but for its told error.
    """
    world = world_of(SOLIDS[name], lights=(Light(position=(3.0, 6.0, 5.0)),), background=(0.3, 0.4, 0.6), depth=1)
    random, certified = np.random.default_rng(4), 0
    for _ in range(100):
        turn = random.uniform(-0.8, 0.8)
        edge = np.array([0.6 * math.sin(turn), 1.2, 0.6 * math.cos(turn)] if name == "cylinder" else [turn, 1.2, 0.6])
        eye = edge + random.uniform(0.1, 3.0, 3) * (1, 1, 2)
        tree = tracer.trace(world, ray=(eye.tolist(), (edge - eye).tolist()))
        verified = tracer.verify(world, tree)
        check(tree, verified)
        if verified.certified < verified.decisions:
            continue
        certified += 1
        error = tree.nodes["radiance_error"][0] + 1e-15
        for (low, high), shown in zip(verified.color, tree.radiance, strict=True):
            assert low - error <= shown <= high + error
    assert 10 < certified < 90


def test_a_ray_along_a_face_that_it_does_not_reach_is_certified() -> None:
    """Down the axis of a closed cylinder, and over a mirror to a wall: neither may go otherwise."""
    world = world_of(SOLIDS["cylinder"], plane((0.0, -1.0, 0.0), (0.0, 1.0, 0.0), MATTE), background=(0.3, 0.4, 0.6))
    for ray in (((0.0, 5.0, 0.0), (0.0, -1.0, 0.0)), ((0.1, 5.0, 0.05), (0.0, -1.0, 0.0))):
        tree = tracer.trace(world, ray=ray)
        verified = tracer.verify(world, tree)
        assert len(tree) == 3
        assert verified.certified == verified.decisions
        assert (tree.margins.margin > 1e12).all()
    floor = plane((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), MIRROR, "floor")
    world = world_of(floor, polygon([(-9, -9, -9), (9, -9, -9), (9, 9, -9), (-9, 9, -9)], MATTE))
    tree = tracer.trace(world, ray=((0.0, 0.5, 6.0), (0.0, 0.0, -1.0)))
    verified = tracer.verify(world, tree)
    assert verified.certified == verified.decisions
    assert tree.margins.margin[0] > 1e12


def test_a_colour_in_doubt_is_not_called_certified() -> None:
    """A wall that stands on a border of its checker: the way of the ray is certified, its colour is not."""
    squares = replace(OPEN, checker=Checker((0.2, 0.2, 0.2), 0.5))
    world = world_of(box((-2.0, -2.0, -3.0), (2.0, 2.0, -2.0), squares))
    tree = tracer.trace(world, ray=((0.3, 0.3, 5.0), (0.1, 0.03, -1.0)))
    verified = tracer.verify(world, tree)
    assert verified.rows[0].doubts == ("which colour of the checker",)
    assert verified.row_to_dict(0)["certified"] is False
    said = tree_text(tree, verified=verified)
    assert "and are certified" not in said
    assert "not certain: the border of two colours of the checker" in said


def test_a_printed_range_contains_its_ends() -> None:
    """Read as decimals: the digits, plus or minus the error that is rounded up."""
    random = np.random.default_rng(18)
    for _ in range(3000):
        low = float(random.random() * 10.0 ** random.integers(-20, 3))
        high = low + float(random.random() * low * 10.0 ** random.integers(-17, -3))
        shown, _, off = range_text((low, high)).partition(" ± ")
        middle, most = Fraction(shown), Fraction(off or 0)
        assert middle - most <= Fraction(low) <= Fraction(high) <= middle + most
    assert range_text((0.5, 0.5)) == "0.5"


@pytest.mark.parametrize("seed", [500540, 500844, 501375, 500885, 501740])
def test_a_colour_or_a_light_that_was_recorded_otherwise_is_not_certified(seed: int) -> None:
    """Rays at borders of checkers, and surfaces that face a light by no more than rounding."""
    scene = (random_scene, stiff_scene)[seed % 2](seed)
    world = tracer.prepare(scene)
    ray = planted_ray(seed, scene, world)
    assert ray is not None
    tree = tracer.trace(world, ray=ray)
    verified = tracer.verify(world, tree)
    check(tree, verified)
    assert any("recorded" in doubt for row in verified.rows for doubt in row.doubts)


@pytest.mark.parametrize("depth", [0, 4])
def test_the_far_side_of_an_open_cone_is_not_certified_as_its_near_side(depth: int) -> None:
    """The exact ray meets the near side within 1e-17 of the rim. The recorded one passes it by, and meets the same
    surface farther away.
    """
    apex, base = (
        (-1.1819733484436243, 0.4247764997547408, 0.2593719581718216),
        (-0.6313198892796109, 0.4953811499113988),
    )
    cone = Cone((*base, 0.7275144070411107), 0.0, apex, 0.1371077526905166)
    lamp = Light("lamp", position=(-7.761299723013792, 1.797831741669493, -0.7280299706685651))
    ray = (
        (-4.879268374910433, 0.5939432326933509, 1.0092959449006218),
        (3.6188881519467997, -0.09046679279657954, -0.6695671743387593),
    )
    tree = tracer.trace(world_of(Object(cone, MATTE, "cone"), lights=[lamp]), ray=ray, depth=depth)
    verified = tracer.verify(tree.world, tree)
    check(tree, verified)
    assert verified.rows[0].doubts == ("it meets the surface at another point than recorded",)
    assert not verified.rows[0].certified and verified.certified < verified.decisions


def test_where_no_digit_of_the_point_is_left_the_colour_says_how_far_it_may_be_off() -> None:
    """A ray nearly along a plane: the error of the point is infinite, but that of a cosine is at most 1."""
    mirror = Material("mirror", diffuse=0.05, reflect=0.7)
    ground = plane((-0.13729321192513386, 0.09086611488887728, -1.3105338350749323),
                   (0.3788400095889407, -0.016591638231295693, -0.4603840758819903), mirror)  # fmt: skip
    lamp = Light("lamp", position=(-3.368058541759093, 7.256357115704829, 0.0382500803072131), color=(0.4, 0.2, 0.1))
    ray = (
        (-2.695995572527825, -0.06139615961738076, -2.844050074581507),
        (0.6248385392076123, 0.6059620600376472, 0.4923279209183935),
    )
    tree = tracer.trace(world_of(ground, lights=[lamp], background=(0.2, 0.3, 0.5)), ray=ray, depth=1)
    assert math.isinf(tree.nodes["error"][0])
    verified = tracer.verify(tree.world, tree)
    check(tree, verified)
    for (low, high), seen in zip(verified.color, tree.radiance, strict=True):
        assert low - tree.radiance_error <= seen <= high + tree.radiance_error
    assert tree.radiance_error <= 0.05 * 0.4 + 1e-12

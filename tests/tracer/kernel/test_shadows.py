"""Shadow rays: one to every light in the tree, in the image only those that can add light; transparent occluders."""

import itertools
import math
import random

import numpy as np
import pytest

import tracer
from tests.scenes import DARK, MATTE, ball, box, cube_mesh, ends, kinds, plane, sheet, world_of
from tracer.formulas.vector import unit
from tracer.kernel.workspace import MAX_CROSSINGS
from tracer.scene import Light, Material, Object
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.polygon import Polygon

SUN = Light("sun", direction=(0.0, -1.0, 0.0))


def test_image_traces_one_shadow_ray_a_lit_hit() -> None:
    """No shadow ray to a light behind the surface, and none for a material that light does not change."""
    lamps = [Light("eye", position=(0.0, 0.0, 100.0)), Light("behind", position=(0.0, 0.0, -100.0))]
    for lights in (lamps[:1], lamps):
        image = tracer.render(world_of(ball(), lights=lights))
        hits = int((image.pixels.sum(axis=2) > 0.0).sum())
        assert image.rays == {"camera": 64 * 48, "reflection": 0, "refraction": 0, "tir": 0, "shadow": hits}
    image = tracer.render(world_of(ball(material=Material("dull", ambient=1.0)), lights=lamps))
    assert image.rays["shadow"] == 0


def test_tree_has_a_shadow_ray_to_every_light() -> None:
    """The tree also has those that add nothing: to a light behind the surface, or for a material that light does not
    change.
    """
    below = Light("below", position=(0.0, -3.0, 0.0))
    ray = ((0, 1, 0), (0.1, -1, 0))
    for material in (Material("matte", diffuse=1.0), Material("dull", ambient=1.0)):
        floor = plane((0, 0, 0), (0, 1, 0), material)
        tree = tracer.trace(world_of(floor, lights=[SUN, below]), ray=ray)
        assert ends(tree) == ["surface", "lit", "blocked"]
        assert tree.object_name(2) == "plane"
        assert tree.faces_away(2)
        assert tree.nodes["t"][2] == 0.0
        assert tree.nodes["point"][2].tolist() == tree.nodes["point"][0].tolist()
        assert not tree.nodes["radiance"][2].any()
        assert tree.nodes["local"][0][0] == material.diffuse + material.ambient


@pytest.mark.parametrize(("shadows", "share"), [("filter", 0.9), ("block", 0.0)])
def test_glass_that_faces_away_is_in_its_own_way(shadows: str, share: float) -> None:
    """A glass surface that faces away from the light blocks its own shadow ray. A sheet seen from above, lit from
    below.
    """
    below = Light("below", position=(0.0, -3.0, 0.0))
    pane = sheet(0.0, Material("sheet", transmit=0.9, diffuse=1.0))
    tree = tracer.trace(world_of(pane, lights=[below], shadows=shadows), ray=((0, 1, 0), (0, -1, 0)), depth=0)
    assert tree.end(1) == ("filtered" if share else "blocked")
    assert tree.object_name(1) == tree.object_name(0)
    assert tree.nodes["factor"][1].tolist() == [share] * 3
    assert not tree.nodes["local"][0].any()


def test_shadow_rows_carry_their_lights_share() -> None:
    lamps = [
        Light("near", position=(0.0, 2.0, 0.0), color=(0.5, 0.25, 0.125)),
        Light("far", position=(0.0, 4.0, 0.0), color=(0.25, 0.5, 1.0)),
        SUN,
    ]
    floor = plane((0, 0, 0), (0, 1, 0), Material("floor", color=(0.5, 1.0, 1.0), diffuse=0.5, ambient=0.25))
    lid = box((-1, 3, -1), (1, 3.5, 1), DARK, "lid")
    tree = tracer.trace(world_of(floor, lid, lights=lamps), ray=((0, 1, 0), (0, -1, 0)), depth=0)
    assert kinds(tree) == ["camera", "shadow", "shadow", "shadow"]
    assert [tree.light_name(i) for i in (1, 2, 3)] == ["near", "far", "sun"]
    assert ends(tree)[1:] == ["lit", "blocked", "blocked"]
    assert [tree.object_name(i) for i in (1, 2, 3)] == [None, "lid", "lid"]
    assert tree.nodes["t"][1:].tolist() == [2.0, 3.0, 3.0]
    assert tree.nodes["radiance"][1].tolist() == [0.125, 0.125, 0.0625]
    assert tree.nodes["radiance"][2:].tolist() == [[0.0] * 3] * 2
    assert tree.nodes["local"][0].tolist() == [0.25, 0.375, 0.3125]
    assert [tree.light_path(i) for i in range(4)] == ["ED", "EDL", "ED", "ED"]


def test_unblocked_light_at_infinity_has_no_end() -> None:
    tree = tracer.trace(world_of(plane((0, 0, 0), (0, 1, 0)), lights=[SUN]), ray=((0, 1, 0), (1, -1, 0)), depth=0)
    assert ends(tree) == ["surface", "lit"]
    assert math.isnan(tree.nodes["t"][1])
    assert tree.nodes["direction"][1].tolist() == [0.0, 1.0, 0.0]
    assert tree.to_dict()["nodes"][1]["point"] is None


@pytest.mark.parametrize(("shadows", "share", "end"), [("filter", 0.81 * 0.5, "filtered"), ("block", 0.0, "blocked")])
def test_glass_filters_or_blocks_shadow_rays(shadows: str, share: float, end: str) -> None:
    """In and out of a ball and through a thin sheet: transmit squared, times the sheet's."""
    glass = ball((0, 3, 0), 1, Material("glass", transmit=0.9, ior=1.5), "glass")
    pane = sheet(5.0, Material("sheet", transmit=0.5))
    world = world_of(plane((0, 0, 0), (0, 1, 0)), glass, pane, lights=[SUN], shadows=shadows)
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert ends(tree) == ["surface", end]
    assert tree.nodes["factor"][1][0] == pytest.approx(share, rel=4e-16, abs=0.0)
    assert tree.object_name(1) == "glass"
    assert tree.radiance[0] == pytest.approx(share, rel=4e-16, abs=0.0)


@pytest.mark.parametrize("balls", [1, 5, MAX_CROSSINGS // 2, MAX_CROSSINGS // 2 + 1, 40])
def test_every_ball_on_the_way_is_crossed_twice(balls: int) -> None:
    kt = [0.9 + 0.002 * k for k in range(balls)]
    glass = [
        ball((0, 3 + 3 * k, 0), 1, Material(f"glass {k}", transmit=kt[k], ior=1.5), f"ball {k}") for k in range(balls)
    ]
    shuffled = random.Random(balls).sample(glass, balls)
    sun = Light("sun", direction=(0.0, -1.0, 0.0))
    world = world_of(plane((0, 0, 0), (0, 1, 0)), *shuffled, lights=[sun])
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    share = 1.0
    for k in range(balls):  # nearest first, as the kernel multiplies
        share = share * kt[k] * kt[k]
    assert ends(tree)[1] == "filtered"
    assert tree.object_name(1) == "ball 0"
    assert tree.nodes["factor"][1][0] == share
    assert tree.radiance[0] == share


def test_occluder_is_the_nearest_opaque_one_behind_any_glass() -> None:
    objects = [
        plane((0, 0, 0), (0, 1, 0)),
        ball((0, 9, 0), 1, name="far"),
        ball((0, 6, 0), 1, name="near"),
        ball((0, 3, 0), 1, Material("glass", transmit=0.5, ior=1.5), "glass"),
    ]
    sun = Light("sun", direction=(0.0, -1.0, 0.0))
    tree = tracer.trace(world_of(*objects, lights=[sun]), ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert (ends(tree)[1], tree.object_name(1), tree.nodes["t"][1]) == ("blocked", "near", 5.0)
    blocking = tracer.trace(world_of(*objects, lights=[sun], shadows="block"), ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert (ends(blocking)[1], blocking.object_name(1), blocking.nodes["t"][1]) == ("blocked", "glass", 2.0)


@pytest.mark.parametrize("panes", [0, MAX_CROSSINGS])
def test_edge_between_two_faces_is_crossed_once(panes: int) -> None:
    """A shadow ray through the diagonals of a cube's top and bottom has two crossings, collected in one traversal or in
    many.
    """
    cube = glass_cube(0.5)
    above = [
        Object(Polygon(square(3.0 + k)), Material("pane", transmit=1.0), f"pane {k}", thin=True) for k in range(panes)
    ]
    sun = Light("sun", direction=(0.0, -1.0, 0.0))
    world = world_of(plane((0, -2, 0), (0, 1, 0)), cube, *above, lights=[sun])
    tree = tracer.trace(world, ray=((0.25, -1.5, 0.25), (0, -1, 0)), depth=0)
    assert (tree.end(1), tree.object_name(1)) == ("filtered", "cube")
    assert tree.nodes["factor"][1].tolist() == [0.25] * 3


@pytest.mark.parametrize("panes", [12, MAX_CROSSINGS + 1])
def test_of_panes_at_one_height_the_files_first_comes_first(panes: int) -> None:
    """Coplanar panes are crossed in the order of the file: all have the same t, and the BVH orders them otherwise."""
    turn = np.linspace(0.0, 6.0, panes)
    shifted = [[(x + math.cos(a), y, z + math.sin(a)) for x, y, z in square(3.0)] for a in turn]
    kt = [0.9 + 0.1 / (k + 2) for k in range(panes)]
    order = random.Random(3).sample(range(panes), panes)
    sheets = [
        Object(Polygon(tuple(shifted[k])), Material("pane", transmit=kt[k]), f"pane {k}", thin=True) for k in order
    ]
    sun = Light("sun", direction=(0.0, -1.0, 0.0))
    world = world_of(*sheets, plane((0, 0, 0), (0, 1, 0)), lights=[sun])
    tree = tracer.trace(world, ray=((0.05, 0.5, 0.02), (0, -1, 0)), depth=0)
    share = 1.0
    for k in order:
        share = share * kt[k]
    assert tree.object_name(1) == f"pane {order[0]}"
    assert tree.nodes["factor"][1][0] == share


def test_light_from_behind_a_ball_comes_through_it() -> None:
    """The eye sees the near side of a ball and the light is behind it: the tree's shadow ray crosses both sides."""
    glass = ball((0, 0, 0), 1, Material("glass", transmit=0.5, diffuse=1.0, ior=1.5), "glass")
    lamp = Light("lamp", position=(0.0, 0.0, -9.0))
    tree = tracer.trace(world_of(glass, lights=[lamp]), ray=((0.25, 0, 5), (0, 0, -1)), depth=0)
    assert (tree.end(1), tree.object_name(1)) == ("filtered", "glass")
    assert tree.nodes["factor"][1].tolist() == [0.25] * 3
    assert not tree.nodes["local"][0].any()


def test_glass_that_swallows_the_last_bit_of_light_is_no_occluder() -> None:
    dark = Material("dark", transmit=1e-170, ior=1.5)
    lamp = Light("lamp", position=(0.0, 9.0, 0.0))
    beyond = ball((0, 12, 0), 1, name="beyond the light")
    world = world_of(plane((0, 0, 0), (0, 1, 0)), ball((0, 3, 0), 1, dark, "dark ball"), beyond, lights=[lamp])
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert (tree.end(1), tree.object_name(1), tree.nodes["t"][1]) == ("filtered", "dark ball", 9.0)
    assert not tree.nodes["factor"][1].any()


def glass_cube(transmit: float) -> Object:
    """From -1 to 1, each face two triangles."""
    corners = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])
    return Object(Mesh(Geometry(corners, faces), "cube"), Material("glass", transmit=transmit, ior=1.5), "cube")


def square(height: float) -> tuple:
    return ((-2.0, height, -2.0), (-2.0, height, 2.0), (2.0, height, 2.0), (2.0, height, -2.0))


def test_nothing_behind_the_light_shades() -> None:
    lamp = Light("lamp", position=(0.0, 5.0, 0.0))
    world = world_of(plane((0, 0, 0), (0, 1, 0)), ball((0, 9, 0), 1), lights=[lamp])
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert ends(tree) == ["surface", "lit"]


@pytest.mark.parametrize("panes", [0, MAX_CROSSINGS + 1])
def test_nor_does_what_the_light_lies_in(panes: int) -> None:
    """A pane at the very distance of the light is no occluder, in one traversal or in many."""
    clear, dim = Material("clear", transmit=1.0), Material("dim", transmit=0.5)
    below = [Object(Polygon(square(1.0 + 0.1 * k)), clear, f"pane {k}", thin=True) for k in range(panes)]
    lamp = Light("lamp", position=(0.0, 5.0, 0.0))
    pane = Object(Polygon(square(5.0)), dim, "dim", thin=True)
    world = world_of(plane((0, 0, 0), (0, 1, 0)), *below, pane, lights=[lamp])
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=0)
    assert tree.nodes["factor"][1].tolist() == [1.0] * 3


@pytest.mark.parametrize("height", [1e-300, 1e-170, 1e-160, 1e-154, 1e-140, 1.0, 1e140, 1e149])
def test_light_at_any_distance_shines_as_bright(height: float) -> None:
    """The square of the distance may overflow or underflow: direction and radiance have the bits of a near light."""
    world = world_of(plane((0, 0, 0), (0, 1, 0), MATTE), lights=[Light("lamp", position=(0.0, height, 0.0))])
    tree = tracer.trace(world, ray=((0, 1, 0), (0, -1, 0)), depth=0)
    assert tree.nodes["t"][1] == height
    near = Light("lamp", position=(0.0, math.frexp(height)[0], 0.0))
    reference = world_of(plane((0, 0, 0), (0, 1, 0), MATTE), lights=[near])
    expected = tracer.trace(reference, ray=((0, 1, 0), (0, -1, 0)), depth=0)
    assert tree.nodes["direction"][1].tolist() == expected.nodes["direction"][1].tolist()
    assert tree.radiance.tolist() == expected.radiance.tolist()
    aslant = tracer.trace(world, ray=((height, 1, 0), (0, -1, 0)), depth=0)
    assert aslant.nodes["direction"][1].tolist() == pytest.approx(
        [-math.sqrt(0.5), math.sqrt(0.5), 0], abs=4 * 2.0**-53
    )


def test_light_in_the_very_point_it_should_light_adds_nothing() -> None:
    world = world_of(plane((0, 0, 0), (0, 1, 0), MATTE), lights=[Light("lamp", position=(0.0, 0.0, 0.0))])
    tree = tracer.trace(world, ray=((0, 1, 0), (0, -1, 0)), depth=0)
    assert np.isfinite(tree.radiance).all()
    assert tree.nodes["t"][1] == 0.0
    assert tree.end(1) == "blocked"


@pytest.mark.parametrize("order", list(itertools.permutations(range(4))))
def test_nested_and_other_balls_take_their_shares_in_any_order_of_the_file(order: tuple[int, ...]) -> None:
    """A core in two balls of glass, which its shadow ray leaves, and two balls farther on, which it crosses."""
    shares = (0.9, 0.8, 0.7, 0.6)
    balls = [
        ball(center, radius, Material(f"glass {k}", transmit=share, ior=1.0), priority=k)
        for k, (center, radius, share) in enumerate(
            zip(((0, 0, 0), (0, 0, 0), (0, 9, 0), (0, 5, 0)), (3.0, 2.0, 1.0, 0.5), shares, strict=True)
        )
    ]
    things = [balls[k] for k in order]
    lamp = Light("lamp", position=(0.0, 40.0, 0.0))
    core = ball((0, 0, 0), 1.0, MATTE, name="core")
    tree = tracer.trace(world_of(*things, core, lights=[lamp]), ray=((0.1, 20.0, 0.0), (0.0, -1.0, 0.0)), depth=9)
    (hit,) = [i for i in range(len(tree)) if tree.kind(i) != "shadow" and tree.object_name(i) == "core"]
    (shadow,) = tree.children[hit]
    expected = shares[0] * shares[1] * shares[2] ** 2 * shares[3] ** 2
    assert tree.nodes["factor"][shadow][0] == pytest.approx(expected, rel=16 * 2.0**-53, abs=0.0)


FILM = Material("film", diffuse=0.1, transmit=0.6, ior=1.5)


def up(x: float) -> float:
    return math.nextafter(x, math.inf)


FILMS = {
    "ball": (ball((0, 1, 0), 1.0, MATTE, name="core"), ball((0, up(1), 0), 1.0, FILM, name="film")),
    "larger ball": (ball((0, 0, 0), 1.0, MATTE, name="core"), ball((0, 0, 0), up(1), FILM, name="film")),
    "box": (box((-1, 0, -1), (1, 1, 1), MATTE, name="core"), box((-1, 0, -1), (1, up(1), 1), FILM, name="film")),
    "cylinder": (
        Object(Cone((0, 0, 0), 1.0, (0, 1, 0), 1.0, closed=True), MATTE, "core"),
        Object(Cone((0, 0, 0), up(1), (0, up(1), 0), up(1), closed=True), FILM, "film"),
    ),
    "cube": (
        Object(cube_mesh(-np.ones(3), np.ones(3)), MATTE, "core"),
        Object(cube_mesh(-np.ones(3), np.full(3, up(1.0))), FILM, "film"),
    ),
}


@pytest.mark.parametrize("shadows", ("filter", "block"))
@pytest.mark.parametrize("name", FILMS)
def test_what_the_ray_to_a_hit_does_not_meet_the_rays_from_there_do_not_meet_either(name: str, shadows: str) -> None:
    """A film of glass of one unit of rounding: where rounding leaves it out on the way to the core, it is no glass on
    the way from there to a light, and neither blocks nor dims it.
    """
    lamp = Light("lamp", position=(3.0, 9.0, 4.0))
    world = world_of(*FILMS[name], lights=[lamp], shadows=shadows)
    random = np.random.default_rng(7)
    bare = 0
    for _ in range(1500):
        direction = unit(tuple(random.normal(size=3)))
        tree = tracer.trace(world, ray=((-5.0 * np.array(direction)).tolist(), direction), depth=2)
        first = [i for i in tree.children[0] if not tree.faces_away(i)]
        if tree.object_name(0) == "core" and first:
            assert [tree.end(i) for i in first] == ["lit"]
            assert tree.nodes["factor"][first[0]].tolist() == [1.0] * 3
            bare += 1
    assert bare > 50

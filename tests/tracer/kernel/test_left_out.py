"""An image traces the rays that can change its pixels, and no others. Counts in closed form.

A tree has a shadow ray from every hit to every light, also to those that add nothing. Reflected and transmitted rays
are the same in the image and in the tree.
"""

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import CLEAR, DARK, GLASS, MATTE, MIRROR, ball, box, kinds, plane, sheet, world_of
from tracer.scene import Camera, Image, Light, Material, Object

SIZE = (32, 24)
PIXELS = SIZE[0] * SIZE[1]
ABOVE = Camera(position=(0.0, 4.0, 0.0), look_at=(0.1, 0.0, 0.0), up=(0.0, 0.0, 1.0), fov=20.0)
OVER, UNDER = Light("over", position=(1.0, 6.0, 2.0)), Light("under", position=(0.0, -6.0, 0.0))
SUN, NADIR = Light("sun", direction=(0.0, -1.0, 0.25)), Light("nadir", direction=(0.0, 1.0, 0.0))


def counted(*objects: Object, lights: tuple[Light, ...] = (), depth: int = 5, model: str = "whitted") -> dict[str, int]:
    """An image's rays by kind, without zeros; checked against the trees of all its pixels."""
    world = world_of(*objects, lights=lights, camera=ABOVE, image=Image(*SIZE), depth=depth, model=model)
    rays = {kind: count for kind, count in tracer.render(world).rays.items() if count}
    trees = [tracer.trace(world, (x, y)) for y in range(SIZE[1]) for x in range(SIZE[0])]
    shown = [kind for tree in trees for kind in kinds(tree)]
    hits = sum(int((tree.nodes["object"][tree.nodes["light"] < 0] >= 0).sum()) for tree in trees)
    assert shown.count("shadow") == hits * len(lights)
    assert {kind: shown.count(kind) for kind in shown if kind != "shadow"} == {
        kind: count for kind, count in rays.items() if kind != "shadow"
    }
    adding = [
        tree.nodes["kind"][i] for tree in trees for i in range(len(tree)) if tree.kind(i) == "shadow"
        and not tree.faces_away(i) and shines(tree, i)
    ]  # fmt: skip
    assert len(adding) == rays.get("shadow", 0)
    return rays


def shines(tree: tracer.RayTree, i: int) -> bool:
    material = tree.scene.objects[tree.nodes["object"][tree.nodes["parent"][i]]].material
    return material.diffuse > 0.0 or material.specular > 0.0


def floor(material: Material = MATTE) -> Object:
    return plane((0, 0, 0), (0, 1, 0), material)


@pytest.mark.parametrize("depth", [0, 1, 7])
@pytest.mark.parametrize("light", [OVER, SUN])
def test_matte_scene_with_one_light_traces_camera_rays_and_a_shadow_ray_a_lit_hit(light: Light, depth: int) -> None:
    assert counted(floor(), lights=(light,), depth=depth) == {"camera": PIXELS, "shadow": PIXELS}
    lid = sheet(1.0, MATTE)
    assert counted(floor(), lid, lights=(light,), depth=depth) == {"camera": PIXELS, "shadow": PIXELS}
    assert counted(floor(), lights=(light, OVER, SUN), depth=depth) == {"camera": PIXELS, "shadow": 3 * PIXELS}


@pytest.mark.parametrize("light", [UNDER, NADIR])
def test_nothing_is_traced_for_a_light_behind_the_surface(light: Light) -> None:
    assert counted(floor(), lights=(light,)) == {"camera": PIXELS}
    assert counted(floor(), lights=(light, OVER)) == {"camera": PIXELS, "shadow": PIXELS}


def test_half_of_a_ball_faces_its_light() -> None:
    """Lit from the side, with the whole disc of the ball in view: half of the hits send a ray to the light."""
    side = Light("side", direction=(-1.0, 0.0, 0.0))
    world = world_of(ball(), lights=(side,), image=Image(64, 48))
    image = tracer.render(world)
    lit = int((image.pixels.sum(axis=2) > 0.0).sum())
    hits = int((tracer.render(world_of(ball(material=Material(ambient=1.0)), image=Image(64, 48))).pixels > 0.0).sum())
    assert image.rays["shadow"] == lit
    assert 2 * lit == hits // 3  # the image is symmetric, and no pixel's middle lies on the border


@pytest.mark.parametrize("material", [DARK, Material("dull", ambient=1.0)])
def test_no_light_is_asked_for_where_none_is_shown(material: Material) -> None:
    assert counted(floor(material), lights=(OVER, SUN)) == {"camera": PIXELS}


@pytest.mark.parametrize("depth", [0, 1, 2, 6])
@pytest.mark.parametrize("model", ["whitted", "fresnel"])
def test_mirror_of_weight_1_has_one_child(depth: int, model: str) -> None:
    """A mirror of weight 1 sends out one ray and no other: between two parallel mirrors there is one ray a level."""
    once = {"camera": PIXELS} | ({"reflection": PIXELS} if depth else {})
    assert counted(floor(MIRROR), depth=depth, model=model) == once
    ceiling = plane((0, 5, 0), (0, -1, 0), MIRROR)
    levels = {"camera": PIXELS} | ({"reflection": depth * PIXELS} if depth else {})
    assert counted(floor(MIRROR), ceiling, depth=depth, model=model) == levels
    lit = counted(floor(MIRROR), sheet(-1.0, MATTE), lights=(OVER,), depth=depth, model=model)
    assert lit == once  # a mirror without a diffuse part sends no shadow ray


@pytest.mark.parametrize("model", ["whitted", "fresnel"])
def test_matched_indices_spawn_no_reflection(model: str) -> None:
    """Equal indices: no reflected ray, whatever the surface's own reflectance. The ray goes on to the matte floor."""
    for clear in (CLEAR, Material("clear", transmit=0.5, reflect=0.5, ior=1.0)):
        rays = counted(box((-9, 1, -9), (9, 2, 9), clear), floor(), lights=(OVER,), model=model)
        assert rays == {"camera": PIXELS, "refraction": 2 * PIXELS, "shadow": PIXELS}
    inside = Object(box((-9, 1, -9), (9, 2, 9)).shape, GLASS, "outer", priority=0)
    inner = Object(box((-8, 1.25, -8), (8, 1.75, 8)).shape, GLASS, "inner", priority=1)
    rays = counted(inside, inner, floor(), depth=9, model="whitted")
    assert rays == {"camera": PIXELS, "refraction": 4 * PIXELS}


def test_total_internal_reflection_has_one_child() -> None:
    block = world_of(box((-99, -1, -9), (99, 1, 9), GLASS), model="fresnel")
    for depth in (1, 4):
        tree = tracer.trace(block, ray=((0, 0, 0), (0.8, 0.6, 0)), depth=depth)
        assert kinds(tree) == ["camera"] + ["tir"] * depth


@pytest.mark.parametrize("name", EACH_LESSON)
def test_hierarchy_changes_no_bit(name: str, worlds: dict[str, tracer.World]) -> None:
    scene = worlds[name].scene
    flat, boxed = tracer.prepare(scene, hierarchy=False), tracer.prepare(scene, hierarchy=True)
    assert len(flat.arrays.nodes) == 0 < len(boxed.arrays.nodes)
    first, second = (tracer.render(world, (64, 48)) for world in (flat, boxed))
    assert (first.pixels == second.pixels).all()
    assert first.rays == second.rays
    assert np.isfinite(first.pixels).all()

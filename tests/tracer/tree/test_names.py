"""The names of rays: a path finds its ray again, and neither more lights nor more depth change a name."""

import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import ball, box, world_of
from tracer.scene import Light, Material
from tracer.tree.names import kind_of, light_names

GLASS = Material("glass", diffuse=0.5, reflect=0.3, transmit=0.6, ior=1.5)
AWKWARD = ("key", "", "fill.L(key)", "twice", "twice", "a(b", "c]", "#9", "E", "fill light")


def scene_of(names: tuple[str, ...], depth: int) -> tracer.RayTree:
    """The ray tree of a glass box and a glass ball, seen through an edge of the box."""
    lights = [Light(name, position=(k - 4.0, 5.0, 3.0)) for k, name in enumerate(names)]
    things = (box((-1, -1, -1), (1, 1, 1), GLASS), ball((0, -1.2, -3), 1, GLASS))
    world = world_of(*things, lights=lights, model="fresnel")
    return tracer.trace(world, ray=((0.3, 3.0, 4.0), (-0.1, -2.6, -3.6)), depth=depth)


@pytest.mark.parametrize("names", (("key", "fill"), AWKWARD))
def test_a_path_finds_its_ray(names: tuple[str, ...]) -> None:
    tree = scene_of(names, 5)
    assert {tree.kind(i) for i in range(len(tree))} >= {"camera", "reflection", "refraction", "shadow", "tir"}
    paths = [tree.path(i) for i in range(len(tree))]
    assert len(set(paths)) == len(tree)
    assert len({tree.label(i) for i in range(len(tree))}) == len(tree)
    for i, path in enumerate(paths):
        assert tree.find(path) == i
        assert kind_of(path) == tree.kind(i)
    for wrong in ("", ".", "E.", "e", "EE", "TX", "T.L(none)", "T.", "L(key)", "T" * 40, "R1"):
        assert tree.find(wrong) is None


def test_names_as_the_design_has_them() -> None:
    tree = scene_of(("key", "", "key", "#1", "a(b)", "lamp"), 3)
    assert light_names(tree.scene) == ["#0", "#1", "#2", "#3", "#4", "lamp"]
    tree = scene_of(("key",), 3)
    assert tree.find("E") == 0 and tree.find("E.L(key)") == 1
    into = tree.find("T")
    assert into and tree.label(into) == "T2"
    inner = tree.find("TR") or tree.find("TI")
    assert inner and tree.label(inner) == {"TR": "R3", "TI": "TIR3"}[tree.path(inner)]
    light = tree.find(f"{tree.path(into)}.L(key)")
    assert light and tree.label(light) == "T2.L(key)" and tree.light_label(light) == "L(key)"


def test_neither_lights_nor_depth_change_a_name() -> None:
    few = scene_of((), 2)
    for names, depth in ((AWKWARD, 2), (("key",), 5), ((), 4)):
        more = scene_of(names, depth)
        for i in range(len(few)):
            same = more.find(few.path(i))
            assert same is not None and more.label(same) == few.label(i)


@pytest.mark.parametrize("name", EACH_LESSON)
def test_names_in_lessons_and_in_trees_by_tolerance(worlds: dict[str, tracer.World], name: str) -> None:
    for tolerance in (None, 1e-3):
        tree = tracer.trace(worlds[name], (400, 300), tolerance=tolerance)
        nodes = tree.to_dict()["nodes"]
        assert len({node["path"] for node in nodes}) == len(tree)
        for i in range(0, len(tree), 1 + len(tree) // 50):
            assert tree.find(nodes[i]["path"]) == i
            assert nodes[i]["label"] == tree.label(i)

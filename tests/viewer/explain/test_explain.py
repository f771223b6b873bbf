"""The panel of the selected ray: its formulas give the tree's own numbers."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, ball, plane, world_of
from tracer.kernel.nodes import SHADOW
from tracer.scene import Light, Material, Object
from tracer.shapes.mesh import Mesh
from viewer.base.wording import format_number
from viewer.explain.interfaces import interfaces
from viewer.explain.intersection import intersection_sections
from viewer.explain.ray import explain_ray, headline
from viewer.explain.sections import Part
from viewer.lessons import lesson

LAMPS = [
    Light("lamp", position=(0.0, 5.0, 2.0), color=(0.5, 0.25, 1.0)),
    Light("low", position=(0.0, -5.0, 0.0)),
    Light("hidden", position=(0.0, 5.0, -9.0)),
]


def section(parts: list[Part], title: str) -> dict[str, str]:
    """The lines of a section, of the part about the end of the ray if both parts have it."""
    *_, found = [section for part in parts for section in part.sections if section.title == title]
    return {line.name: line.value for line in found.lines}


def value(text: str) -> float:
    return float(text.replace("−", "-").rstrip("°"))


def values(text: str) -> list[float]:
    return [value(part) for part in text.split("  ")]


@pytest.fixture
def water() -> tuple[tracer.World, tracer.RayTree]:
    """Into water with 3-4-5 triangles: sin 0.8 outside, 0.6 inside."""
    material = Material("water", diffuse=0.5, specular=0.5, shininess=4, reflect=0.25, transmit=0.5, ior=4 / 3)
    stone = ball((0, 3, -5), 1)
    world = world_of(plane((0, 0, 0), (0, 1, 0), material, "water"), stone, lights=LAMPS, background=(0.5, 0.5, 0.5))
    return world, tracer.trace(world, ray=((0, 3, 4), (0, -0.6, -0.8)), depth=1)


def test_snell_and_the_transmission_direction(water: tuple) -> None:
    world, tree = water
    sections = explain_ray(tree, world, 0)
    snell = section(sections, "Snell's law")
    assert list(snell) == ["1 · sin 53.13°", "1.3333 · sin 36.87°"]
    assert [value(text) for text in snell.values()] == [0.8, 0.8]
    bent = section(sections, "Transmission direction")
    assert value(bent["n = n₁/n₂"]) == 0.75
    assert value(bent["c₁ = −v·n"]) == 0.6
    assert value(bent["1 − n²(1 − c₁²)"]) == 0.64
    assert value(bent["c₂ = √(1 − n²(1 − c₁²))"]) == 0.8
    refracted = next(i for i in range(len(tree)) if tree.kind(i) == "refraction")
    assert values(bent["t"]) == pytest.approx(tree.nodes["direction"][refracted], abs=6e-5)
    mirrored = section(sections, "Reflection")
    reflected = next(i for i in range(len(tree)) if tree.kind(i) == "reflection")
    assert values(mirrored["r"]) == pytest.approx(tree.nodes["direction"][reflected], abs=6e-5)
    assert value(mirrored["n·v"]) == -0.6


def test_sum_names_each_child_with_its_share(water: tuple) -> None:
    world, tree = water
    total = section(explain_ray(tree, world, 0), "Radiance")
    parts = [np.array(values(text)) for text in total.values()]
    assert parts[-1] == pytest.approx(tree.radiance, abs=6e-5)
    assert sum(parts[:-1]) == pytest.approx(tree.radiance, abs=2e-4)
    assert any(name == "+ 0.25 × R1" for name in total)
    assert any(name == "+ 0.5 × T2" for name in total)


def test_local_light_stands_light_by_light(water: tuple) -> None:
    """One light that is visible, one behind the surface, one blocked by name; with ambient they add up to the local
    term.
    """
    world, tree = water
    local = section(explain_ray(tree, world, 0), "Local light")
    names = list(local)
    assert any(name.startswith("lamp: N·L") for name in names)
    assert any(re.fullmatch("low: N·L −[0-9.]+: surface faces away", name) for name in names)
    assert "hidden: blocked by ball" in names
    lit = next(name for name in names if name.startswith("lamp: N·L"))
    # The panel gives all numbers that are needed to compute the contribution by hand.
    _, kd, ks, p = values(local["ka  kd  kₛ  p"])
    n_l, r_v = (float(x) for x in re.findall(r"[0-9.]+", lit))
    color, light = np.array(values(local["C"])), np.array(values(local["lamp: L"]))
    assert values(local[lit]) == pytest.approx(light * (kd * color * n_l + ks * r_v**p), abs=2e-3)
    assert values(local[lit]) == pytest.approx(values(local["local"]), abs=1e-4)
    assert values(local["local"]) == pytest.approx(tree.nodes["local"][0], abs=6e-5)


def test_shadow_ray_shows_its_lights_formula(water: tuple) -> None:
    world, tree = water
    i = next(i for i in range(len(tree)) if tree.light_name(i) == "lamp")
    light = section(explain_ray(tree, world, i), "Light from lamp")
    n_l = 5 / math.hypot(5, 2 - 0)  # the hit is at the origin
    point = tree.nodes["point"][0]
    to_light = np.subtract((0.0, 5.0, 2.0), point)
    n_l = to_light[1] / np.linalg.norm(to_light)
    assert value(light["N·L"]) == pytest.approx(n_l, rel=1e-4, abs=0.0)
    assert values(light["kd C (N·L)"]) == pytest.approx([0.5 * n_l] * 3, abs=6e-5)
    contribution = np.array((0.5, 0.25, 1.0)) * (0.5 * n_l + value(light["kₛ (R·V)ᵖ"]))
    assert values(light["contribution"]) == pytest.approx(contribution, abs=2e-4)
    assert headline(tree, i)[1] == "from water to lamp: nothing in its way"


def test_total_internal_reflection_shows_the_number_that_decides() -> None:
    material = Material("water", transmit=1.0, ior=1.33)
    world = world_of(plane((0, 0, 0), (0, 1, 0), material, "water"))
    a = math.radians(60)
    tree = tracer.trace(world, ray=((0, -1, 0), (math.sin(a), math.cos(a), 0)), depth=1)
    sections = explain_ray(tree, world, 0)
    critical = section(sections, "Critical angle")
    assert critical["arcsin(1 / 1.33)"] == "48.75°"
    assert critical["θ₁ = 60.00°"] == "beyond it: total internal reflection"
    decided = section(sections, "Transmission direction")
    assert value(decided["1 − n²(1 − c₁²)"]) == pytest.approx(1 - (1.33 * math.sin(a)) ** 2, rel=1e-4, abs=0.0)
    assert decided["n²(1 − c₁²)"].endswith("≥ 1: total internal reflection")
    assert section(sections, "Snell's law")["sin θ₂"].endswith("> 1")
    assert headline(tree, 1)[0] == "Total internal reflection TIR1"


def test_fresnel_shares_are_those_of_the_children() -> None:
    material = Material("glass", reflect=0.1, transmit=0.8, ior=1.5)
    world = world_of(plane((0, 0, 0), (0, 1, 0), material, "glass"), model="fresnel")
    tree = tracer.trace(world, ray=((0, 1, 0), (1, -1, 0)), depth=1)
    shares = section(explain_ray(tree, world, 0), "Fresnel")
    assert value(shares["(kr + kt) R"]) == pytest.approx(tree.nodes["factor"][1][0], rel=1e-4, abs=0.0)
    assert value(shares["(kr + kt) T"]) == pytest.approx(tree.nodes["factor"][2][0], rel=1e-4, abs=0.0)


def test_first_the_origin_of_a_ray_then_its_end() -> None:
    """From the inside of glass: a reflected, a refracted and a totally reflected ray show the formulas of the hit that
    sent them out, with the numbers of that hit, and then those of their own hit, whose rays are named.
    """
    glass = Material("glass", reflect=0.1, transmit=0.8, ior=1.5)
    world = world_of(ball((0, 0, 0), 1, glass), model="fresnel")
    tree = tracer.trace(world, ray=((-3, 0.7, 0), (1, 0, 0)), depth=3)
    into, back, out = (tree.find(path) for path in ("T", "TR", "TT"))
    assert into and back and out
    for row, kinds in ((into, ["Snell's law", "Transmission direction", "Fresnel"]), (back, ["Reflection", "Fresnel"])):
        parts = explain_ray(tree, world, row)
        assert [section.title for section in parts[0].sections] == kinds
        parent = int(tree.nodes["parent"][row])
        symbol = "t" if row == into else "r"
        lines = [line for section in parts[0].sections for line in section.lines]
        (direction,) = [line for line in lines if line.name == symbol]
        assert direction.ray == tree.label(row)
        assert values(direction.value) == pytest.approx(tree.nodes["direction"][row], abs=6e-5)
        (incoming,) = {line.ray for line in lines if line.name == "v"}
        assert incoming == tree.label(parent)
        assert parts[0].title == f"{tree.label(row)} starts where {tree.label(parent)} meets ball"
    begun, _ = explain_ray(tree, world, out)[0], None
    assert [section.title for section in begun.sections][:2] == ["Snell's law", "Critical angle"]
    ended = explain_ray(tree, world, into)[1]
    named = {line.ray for section in ended.sections for line in section.lines if line.name in "rt"}
    assert ended.title == "T2 meets ball" and named == {tree.label(back), tree.label(out)}
    start, end = interfaces(tree, into)
    assert (start.critical, end.critical) == ("–", "41.81°") and start.theta2 == end.theta1
    deep = tracer.trace(world, ray=((0, -0.99, 0), (1, 0, 0)), depth=2)  # inside, near the rim
    whole = deep.find("I")
    assert whole
    origin = [section.title for section in explain_ray(deep, world, whole)[0].sections]
    assert origin == ["Snell's law", "Critical angle", "Transmission direction", "Reflection"]
    assert interfaces(deep, whole)[0].radicand.startswith("−")


def test_the_root_of_a_sphere_is_the_distance_digit_by_digit(worlds: dict[str, tracer.World]) -> None:
    """Of each ray of the lessons that meets a sphere: as the ray's numbers have it."""
    seen = 0
    for name, world in worlds.items():
        tree = tracer.trace(world, lesson.read(name).first.state.pixel, depth=3)
        for i in np.flatnonzero(tree.nodes["kind"] != SHADOW).tolist():
            sections = {section.title: section for part in explain_ray(tree, world, i) for section in part.sections}
            if "Ray and sphere" not in sections:
                continue
            values = {line.name: line.value for line in sections["Ray and sphere"].lines}
            (t,) = (line.value for line in sections["Numbers"].lines if line.name == "distance t")
            told, root = values["t of the ray"].split(" = ")
            assert told == t == values[root]
            seen += 1
    assert seen >= 10


def test_the_face_of_a_mesh_is_shown_with_its_coordinates() -> None:
    """Every face of a mesh: the one that is hit, and no neighbour, also at a hit far from the origin."""
    mesh = replace(Mesh.example(), translate=(1e4, -2e4, 3e4))
    world = world_of(Object(mesh, MATTE, "tetrahedron"))
    for corners in mesh.placed():
        out = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        goal = corners.T @ (0.2, 0.3, 0.5)
        tree = tracer.trace(world, ray=((goal + out).tolist(), (-out).tolist()))
        (inside,) = intersection_sections(tree, 0)
        assert [line.value for line in inside.lines[:4]] == ["0.2000", "0.3000", "0.5000", "1"]


def test_every_ray_of_every_lesson_can_be_explained(world: tracer.World) -> None:
    for pixel in ((400, 300), (300, 200), (560, 330), (452, 455), (10, 10)):
        for model in ("whitted", "fresnel"):
            tree = tracer.trace(world, pixel, depth=3, model=model)
            for i in range(len(tree)):
                parts = explain_ray(tree, world, i)
                assert parts[-1].title == "All of it" and len({part.title for part in parts}) == len(parts)
                rows = [cell for row in interfaces(tree, i) for cell in row]
                lines = [line for part in parts for section in part.sections for line in section.lines]
                for value in (*rows, *(line.value for line in lines)):
                    assert "nan" not in value and "inf" not in value, (parts[0].title, value)


def test_numbers_are_written_for_people() -> None:
    assert [format_number(x) for x in (1.0, -0.5, 1 / 3, 1e-9, math.nan)] == ["1", "−0.5", "0.33333", "1e−09", "–"]

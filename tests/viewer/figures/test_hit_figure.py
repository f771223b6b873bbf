"""The figure of a hit in its plane of incidence: angles have their true size, nothing overlaps."""

import itertools
import math
from collections.abc import Iterable
from dataclasses import replace

import pytest
from hypothesis import given, settings, strategies as st

import tracer
from tests.conftest import LESSONS
from tests.scenes import ball, box, plane, world_of
from tests.viewer.figures.geometry import check, check_texts, cuts
from tracer.kernel.nodes import SHADOW
from tracer.scene import Light, Material, Object
from tracer.shapes.polygon import Polygon
from viewer.base.theme import LIGHT
from viewer.explain.scattering import scattering_sections
from viewer.figures.figure.hit import hit_marks
from viewer.figures.layout.hit_frame import hit_frame
from viewer.figures.marks import HEIGHT, WIDTH, Figure, Formula, Line, Mark, Rectangle, Shape, Text, inside
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.lessons import lesson

PAGE = (0.0, 0.0, WIDTH, HEIGHT)
CENTER = hit_frame(PAGE, 18.0).center


def turn_of(figure: Figure, name: str, back: bool) -> float:
    """The angle of a ray's line to the vertical, by its ends. `back`: seen from the ray's origin."""
    (line,) = (m for m in figure.marks if isinstance(m, Line) and m.name == name)
    start, end = (line.end, line.start) if back else (line.start, line.end)
    return math.atan2(end[0] - start[0], start[1] - end[1])


def check_angles(tree: tracer.RayTree, node: int) -> None:
    (figure,) = pages("hit", Subject(by_depth([tree])), FigureStyle(node=node))
    check(figure)
    row = tree.nodes[node]
    close = 1e-12
    assert turn_of(figure, f"ray-{node}", True) == pytest.approx(-row["theta1"], abs=close)
    for child in tree.children[node]:
        kind = tree.kind(child)
        if kind == "refraction":
            assert turn_of(figure, f"ray-{child}", False) == pytest.approx(math.pi - row["theta2"], abs=close)
            d, n = tree.nodes["direction"][child], row["normal"]
            assert math.acos(max(-1.0, min(1.0, -float(d @ n)))) == pytest.approx(row["theta2"], abs=1e-6)
        elif kind != "shadow":
            assert turn_of(figure, f"ray-{child}", False) == pytest.approx(row["theta1"], abs=close)
    (normal,) = (m for m in figure.marks if isinstance(m, Line) and m.name == "normal" and m.end[1] < CENTER[1])
    assert normal.end[0] == CENTER[0]


@settings(max_examples=40, deadline=None)
@given(st.floats(0.0, 89.5), st.floats(1.0, 2.5), st.booleans())
def test_angles_are_true(degrees: float, ior: float, model: bool) -> None:
    glass = Material("glass", reflect=0.1, transmit=0.9, ior=ior)
    world = world_of(box((-99, -99, -2), (99, 99, 0), glass), lights=[Light("lamp", position=(0, 0, 9))])
    a = math.radians(degrees)
    start = (-math.sin(a), 0.0, math.cos(a))
    ray = (start, (math.sin(a), 0.0, -math.cos(a)))
    tree = tracer.trace(world, ray=ray, depth=2, model="fresnel" if model else "whitted")
    for i in range(len(tree)):
        if tree.object_name(i) and tree.nodes["kind"][i] != SHADOW:
            check_angles(tree, i)


def test_hits_of_the_lessons(worlds: dict[str, tracer.World]) -> None:
    for name in LESSONS:
        tree = tracer.trace(worlds[name], lesson.read(name).first.state.pixel, depth=3)
        for i in range(len(tree)):
            if tree.object_name(i) and tree.nodes["kind"][i] != SHADOW:
                check_angles(tree, i)


def written(marks: Iterable[Mark]) -> set[str]:
    """All texts, and all formulas as plain text."""
    texts = {mark.content for mark in marks if isinstance(mark, Text)}
    return texts | {mark.plain for mark in marks if isinstance(mark, Formula)}


def test_formulas_carry_the_trees_own_numbers(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["underwater"], lesson.read("underwater").first.state.pixel, depth=2)
    (figure,) = pages("hit", Subject(by_depth([tree])), FigureStyle())
    words = written(figure.marks)
    assert f"{1.0 - tree.nodes['radicand'][0]:.5g} ≥ 1: total internal reflection" in words
    assert "48.75°" in words  # the critical angle of water to air
    assert "no T: total reflection" in words


@settings(max_examples=40, deadline=None)
@given(st.floats(0.0, 89.0), st.floats(0.0, 180.0), st.floats(-180.0, 180.0))
def test_lights_stand_at_their_true_angle(degrees: float, from_normal: float, about: float) -> None:
    """In the plane of incidence and outside it. On the right if they are on the side to which the ray continues."""
    a, b, c = (math.radians(x) for x in (degrees, from_normal, about))
    towards = (math.sin(b) * math.cos(c), math.sin(b) * math.sin(c), math.cos(b))
    floor = box((-99, -99, -2), (99, 99, 0), Material("floor", diffuse=1.0))
    world = world_of(floor, lights=[Light("lamp", position=tuple(50.0 * x for x in towards))])  # type: ignore[arg-type]
    ray = ((-math.sin(a), 0.0, math.cos(a)), (math.sin(a), 0.0, -math.cos(a)))
    tree = tracer.trace(world, ray=ray, depth=1)
    (figure,) = pages("hit", Subject(by_depth([tree]), world), FigureStyle())
    check(figure)
    (light,) = (i for i in range(len(tree)) if tree.nodes["kind"][i] == SHADOW)
    stub = next(m for m in figure.marks if isinstance(m, Line) and m.name == f"ray-{light}")
    turn = math.atan2(stub.end[0] - stub.start[0], stub.start[1] - stub.end[1])
    assert abs(turn) == pytest.approx(b, abs=1e-9)
    if degrees > 1.0 and abs(towards[0]) > 1e-6 and abs(math.degrees(turn)) < 179.9:
        assert (turn > 0.0) == (towards[0] > 0.0)


def test_a_hit_without_rays_to_go_on_has_no_formulas_of_them(worlds: dict[str, tracer.World]) -> None:
    """At depth 0 the figure shows the light at the hit and why no ray follows; at depth 1 the rays."""
    world, pixel = worlds["glass-ball"], lesson.read("glass-ball").first.state.pixel
    trees = [tracer.trace(world, pixel, depth=d) for d in (0, 1)]
    first, second = pages("hit", Subject(by_depth(trees), world), FigureStyle())
    words = [written(page.marks) for page in (first, second)]
    assert "cut: depth" in words[0]
    assert all("local" in page for page in words)
    assert "r = v − 2 (n·v) n" not in words[0]
    assert {"r = v − 2 (n·v) n", "n₁ sin θ₁ = n₂ sin θ₂"} <= words[1]


def names_of(tree: tracer.RayTree) -> list[tuple[str, float]]:
    """Of each hit, outwards along the refracted rays: the object's name, and how far it stands below the surface."""
    found, node = [], 0
    while True:
        (figure,) = pages("hit", Subject(by_depth([tree]), tree.world), FigureStyle(node=node))
        check(figure)
        (text,) = (m for m in figure.marks if isinstance(m, Text) and m.name == "surface")
        found.append((text.content, text.at[1] - CENTER[1]))
        below = [c for c in tree.children[node] if tree.kind(c) in ("refraction", "tir") and tree.object_name(c)]
        if not below:
            return found
        (node,) = below


@pytest.mark.parametrize("aside", (0.05, 0.3, 0.47))
def test_a_name_stands_in_the_medium_that_it_names(aside: float) -> None:
    """A ray through water in a ball, a sheet and into a floor: below the surface where it enters, above where it
    leaves, on the surface of the sheet, which has no inside.
    """
    glass, water = Material("glass", transmit=0.9, ior=1.5), Material("water", transmit=0.9, ior=1.33)
    inner = replace(ball((0.0, 0.0, 0.0), 0.5, water, "water"), priority=1)
    sheet = Object(Polygon(((-9, -2, -9), (-9, -2, 9), (9, -2, 9), (9, -2, -9))), glass, "sheet", thin=True)
    floor = plane((0.0, -3.0, 0.0), (0.0, 1.0, 0.0), Material("floor", diffuse=1.0), "floor")
    lamp = Light("lamp", position=(4.0, 9.0, 0.0))
    world = world_of(inner, ball((0.0, 0.0, 0.0), 1.0, glass, "ball"), sheet, floor, lights=[lamp])
    names = names_of(tracer.trace(world, ray=((aside, 5.0, 0.0), (0.0, -1.0, 0.0)), depth=6))
    sides = [(name, int(math.copysign(1.0, below)) if below else 0) for name, below in names]
    assert sides == [("ball", 1), ("water", 1), ("water", -1), ("ball", -1), ("sheet", 0), ("floor", 1)]


@pytest.mark.parametrize("degrees", (0.0, 10.0, 30.0, 48.0, 60.0, 75.0, 85.0, 89.0))
def test_a_name_under_water_keeps_clear_of_rays(degrees: float) -> None:
    """Seen from under water, with and without total internal reflection, also a long name."""
    for name in ("water", "water in the lake with a very long name"):
        lake = box((-99.0, -99.0, -99.0), (99.0, 99.0, 0.0), Material("water", transmit=1.0, ior=1.33), name=name)
        lamps = [Light(str(k), position=(math.cos(k) * 9.0, math.sin(k), 3.0 * math.sin(2.0 * k))) for k in range(4)]
        a = math.radians(degrees)
        ray = ((-math.sin(a), 0.0, -math.cos(a)), (math.sin(a), 0.0, math.cos(a)))
        ((words, below),) = names_of(tracer.trace(world_of(lake, lights=lamps), ray=ray, depth=1))[:1]
        assert below < 0.0
        assert words[:5] == "water"


ROOMS = [(460.0, 270.0), (640.0, 600.0), (960.0, 540.0), (300.0, 500.0), (1200.0, 400.0), (520.0, 300.0)]


@pytest.mark.parametrize("room", ROOMS)
@pytest.mark.parametrize("size", (14.0, 16.0, 20.0, 24.0))
def test_a_hit_fits_every_panel(room: tuple[float, float], size: float, worlds: dict[str, tracer.World]) -> None:
    """Nothing overlaps or leaves the rectangle, which may begin anywhere; angles stay true, and rays long."""
    where: Rectangle = (30.0, 20.0, 30.0 + room[0], 20.0 + room[1])
    for name in ("glass-ball", "underwater", "two-lights"):
        tree = tracer.trace(worlds[name], lesson.read(name).first.state.pixel, depth=2)
        for node in (i for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW and tree.object_name(i)):
            marks = hit_marks(by_depth([tree])[0], node, size, LIGHT, worlds[name], where)
            figure = Figure("", "", "", tuple(marks), LIGHT.panel, width=where[2], height=where[3])
            for text in check_texts(figure, 0.9 * size):
                left, top, _, _ = text.box()
                assert left >= where[0] and top >= where[1], text
            lines = [mark for mark in marks if isinstance(mark, Line)]
            for line, text in itertools.product(lines, marks):
                if isinstance(text, (Text, Formula)) and text.name != line.name and text.name != "surface":
                    assert not any(cuts(piece, text.box()) for piece in line.pieces()), (line, text)
            (ray,) = (mark for mark in lines if mark.name == f"ray-{node}")
            assert turn_of(figure, f"ray-{node}", True) == pytest.approx(-tree.nodes["theta1"][node], abs=1e-12)
            assert math.dist(ray.start, ray.end) >= 2.5 * size
            assert inside(ray.end, where)


def test_the_formulas_stand_on_the_right_of_a_wide_picture_and_below_another(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["glass-ball"], lesson.read("glass-ball").first.state.pixel, depth=2)
    shown = {}
    for room in ((960.0, 540.0), (640.0, 600.0), (460.0, 250.0)):
        marks = hit_marks(by_depth([tree])[0], 0, 16.0, LIGHT, worlds["glass-ball"], (0.0, 0.0, *room))
        (_, upper), (_, lower) = ((m.name, m) for m in marks if isinstance(m, Shape) and m.name.startswith("medium"))
        formulas = [mark for mark in marks if isinstance(mark, Formula) and mark.name == "formulas"]
        shown[room] = {mark.plain for mark in formulas}
        if room == (960.0, 540.0):
            assert all(mark.box()[0] > upper.corners[1][0] for mark in formulas)
        else:
            assert all(mark.box()[1] > lower.corners[2][1] for mark in formulas)
    assert {"n₁ sin θ₁ = n₂ sin θ₂", "t = n v + (n c₁ − c₂) n"} <= shown[960.0, 540.0] & shown[640.0, 600.0]
    assert shown[460.0, 250.0] == set()  # the picture needs all of it


def test_rays_angles_and_the_normal_are_named_in_the_picture(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["glass-ball"], lesson.read("glass-ball").first.state.pixel, depth=2)
    marks = hit_marks(by_depth([tree])[0], 0, 18.0, LIGHT)
    found = {(mark.plain, mark.name) for mark in marks if isinstance(mark, Formula) and mark.name != "formulas"}
    reflected, refracted = (tree.find(path) for path in "RT")
    assert {("v", "ray-0"), ("r", f"ray-{reflected}"), ("t", f"ray-{refracted}"), ("n", "normal")} <= found
    assert {("θ₁", "angle-ray-0"), ("θ₂", f"angle-ray-{refracted}")} <= found


@pytest.mark.parametrize("high", [400.0, 500.0, 600.0, 900.0])
def test_formulas_without_room_are_counted(worlds: dict[str, tracer.World], high: float) -> None:
    tree = tracer.trace(worlds["glass-ball"], lesson.read("glass-ball").first.state.pixel, depth=1)
    sections = scattering_sections(tree, 0)
    marks = hit_marks(by_depth([tree])[0], 0, 14.0, LIGHT, None, (0.0, 0.0, 300.0, high))
    headings = {s.formula for s in sections} & {mark.source for mark in marks if isinstance(mark, Formula)}
    texts = [mark.content for mark in marks if isinstance(mark, Text)]
    notes = [content for content in texts if content.startswith("… and")]
    missing = len(sections) - len(headings)
    if notes:
        (note,) = notes
        assert note == "… and more numbers" if not missing else note.startswith(f"… and {missing} more formula")
    else:
        assert not missing

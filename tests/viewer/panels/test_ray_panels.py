"""The panels of the selected ray: its card of numbers, and its hit as a picture that can be clicked."""

import math

import numpy as np
import pytest
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tests.viewer.driver import Driver, are_equal, body, viewer
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.explain.interfaces import interfaces
from viewer.figures.marks import Handle, Line, Mark, Rectangle, Text
from viewer.panels import PANELS, hit, ray
from viewer.panels.hit import shown_row
from viewer.panels.panel import Panel
from viewer.session.session import Session

Key = imgui.Key


@pytest.fixture
def room():
    with viewer() as driver:
        driver.open("glass-ball")
        yield driver


def show(room: Driver, panel: Panel) -> None:
    """Bring a panel to the front, with the key for the next one."""
    session = room.session
    front = session.layout.current(session.appearance.is_lecture_size).front
    for _ in PANELS:
        if front.get(panel.place_in(session)) != panel.name:
            room.type("p")
    room.frames(3)
    assert front[panel.place_in(session)] == panel.name


def inner(window: internal.Window) -> Rectangle:
    return (window.pos.x, window.pos.y, window.pos.x + window.size.x, window.pos.y + window.size.y)


# --- the card ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("lecture", (False, True))
def test_both_ends_of_every_ray_are_seen_without_scrolling_and_nothing_is_cut_off(lecture: bool) -> None:
    """At 1280x720, in both sizes of text: indices, angles, critical angle and radicand lie in the panel."""
    with viewer() as room:
        for name in ("glass-ball", "underwater"):
            room.open(name)
            if lecture != room.session.appearance.is_lecture_size:
                room.press(Key.tab)
            show(room, ray.PANEL)
            tree = room.session.tree
            assert tree
            for row in range(0, len(tree), 2):
                room.session.select(row)
                room.frames(2)
                window = body(ray.PANEL.title)
                _, top, right, bottom = inner(window)
                assert window.scroll.y == 0.0
                assert window.content_size.x <= window.inner_clip_rect.get_width() + 1.0, (name, tree.label(row))
                _, first, end, last = room.canvas.ray_ends
                assert top <= first < last and end <= right
                if len(interfaces(tree, row)) < 2 or not lecture:
                    assert last <= bottom, (name, tree.label(row))
                assert last <= bottom + 4.0 * imgui.get_font_size(), (name, tree.label(row))


def test_the_card_begins_at_its_top_for_another_ray_and_stays_for_another_pixel(room: Driver) -> None:
    show(room, ray.PANEL)
    session = room.session
    session.select(session.tree.find("T"))  # type: ignore[union-attr]
    room.frames(3)
    room.type("jj")
    place, ends = body(ray.PANEL.title).scroll.y, room.canvas.ray_ends
    assert place > 50.0
    room.press(Key.right_arrow)
    room.frames(3)
    assert session.selection == "T" and body(ray.PANEL.title).scroll.y == place and room.canvas.ray_ends == ends
    session.select(session.tree.find("TR"))  # type: ignore[union-attr]
    room.frames(3)
    assert body(ray.PANEL.title).scroll.y == 0.0


def test_two_columns_if_there_is_room(room: Driver) -> None:
    """In the place at the lower right the ends stand side by side; in a narrow window below each other."""
    show(room, ray.PANEL)
    room.session.select(room.session.tree.find("T"))  # type: ignore[union-attr]
    room.frames(3)
    _, first, _, last = room.canvas.ray_ends
    side_by_side = last - first
    room.resize((760, 720))
    room.frames(3)
    _, first, _, last = room.canvas.ray_ends
    assert last - first > 1.5 * side_by_side


# --- the hit -------------------------------------------------------------------------------------------------------


def marks(room: Driver) -> list[Mark]:
    (found,) = room.canvas.hit._value
    return found


def place_of(room: Driver, row: int, share: float) -> tuple[float, float]:
    """The screen position of a point of a ray in the panel."""
    line = next(mark for mark in marks(room) if isinstance(mark, Line) and mark.name == f"ray-{row}")
    return on_screen(line.at(share))


def on_screen(point: tuple[float, float]) -> tuple[float, float]:
    """The screen position of a point of the picture of a hit."""
    left, top, _, _ = inner(body(hit.PANEL.title))
    unit = imgui.get_style().font_scale_main
    return left + unit * point[0], top + unit * point[1]


def show_hit_of_t(room: Driver, lecture: bool) -> tuple[Session, RayTree]:
    """Show the hit of the ray T, at the desk or in lecture mode."""
    if lecture:
        room.press(Key.tab)
    session, tree = room.session, room.session.tree
    assert tree
    session.select(tree.find("T"))
    show(room, hit.PANEL)
    return session, tree


@pytest.mark.parametrize("lecture", (False, True))
def test_a_ray_in_the_picture_of_a_hit_is_hovered_and_selected_by_the_mouse(room: Driver, lecture: bool) -> None:
    session, tree = show_hit_of_t(room, lecture)
    for path, after in (("TR", "TR"), ("TT", "TT")):
        session.select(tree.find("T"))
        room.frames(3)
        row = tree.find(path)
        assert row is not None
        x, y = place_of(room, row, 0.8)
        before = room.picture()
        room.move(x, y)
        room.frames(2)
        assert session.hovered == row
        near = np.s_[int(y) - 9 : int(y) + 9, int(x) - 9 : int(x) + 9]
        assert (room.picture()[near] != before[near]).any()  # it is drawn thicker
        room.click(x, y)
        assert session.selection == after
    selected = session.selection
    left, top, right, bottom = inner(body(hit.PANEL.title))
    room.click(left + 0.9 * (right - left), top + 0.3 * (bottom - top))  # on no ray
    assert session.selection == selected
    room.move(*room.pixel_at(5, 5))
    room.frames(2)
    assert session.hovered is None


@pytest.mark.parametrize("lecture", (False, True))
def test_the_ray_in_the_picture_of_a_hit_is_turned_by_its_handle(room: Driver, lecture: bool) -> None:
    """To 60 degrees inside the glass: all light is reflected. A double click, or another ray, ends it."""
    session, tree = show_hit_of_t(room, lecture)

    def handle() -> Handle:
        return next(mark for mark in marks(room) if isinstance(mark, Handle))

    def words() -> list[str]:
        return [mark.content for mark in marks(room) if isinstance(mark, Text)]

    assert handle().value == pytest.approx(math.degrees(tree.nodes["theta1"][tree.find("T")]), abs=1e-12)
    for end in ("double click", "another ray"):
        traced = room.picture()
        start, stop = on_screen(handle().at), on_screen(handle().path[60])
        room.drag([start, (start[0] - 8.0, start[1]), stop])
        assert session.turn == pytest.approx(60.0, abs=1.0)
        assert "v: turned by hand" in words() and f"θ₁ = {session.turn:.2f}°" in " ".join(words())
        assert any(content.startswith("no T") for content in words())
        assert session.selection == "T" and session.tree is tree
        assert not are_equal(room.picture(), traced)
        if end == "double click":
            x, y = on_screen(handle().at)
            room.click(x, y)
            room.click(x, y)
        else:
            session.select(tree.find("E"))
        room.frames(3)
        assert session.turn is None and "v: turned by hand" not in words()


def test_the_hit_on_show_is_that_of_the_selected_ray(room: Driver) -> None:
    """A ray that meets nothing and a shadow ray show the hit that they come from; without a selection the first."""
    show(room, hit.PANEL)
    session, tree = room.session, room.session.tree
    assert tree
    for row in (None, *range(len(tree))):
        session.select(row)
        room.frames(2)
        expected = shown_row(tree, row or 0)
        incoming = {mark.name for mark in marks(room) if mark.name.startswith("angle-ray-")}
        assert f"angle-ray-{expected}" in incoming
        if row and (tree.nodes["kind"][row] == SHADOW or not tree.object_name(row)):
            assert expected == tree.nodes["parent"][row]
        else:
            assert expected == (row or 0)


def test_the_picture_of_a_hit_fills_its_panel_and_is_laid_out_once(room: Driver) -> None:
    show(room, hit.PANEL)
    room.session.select(0)
    room.frames(3)
    first = marks(room)
    room.frames(3)
    assert marks(room) is first
    room.session.layout.maximise(hit.PANEL.name)
    room.frames(3)
    assert marks(room) is not first
    _, _, width, height = room.app.tiles.places[hit.PANEL.place]
    boxes = [mark.box() for mark in marks(room) if hasattr(mark, "box")]  # type: ignore[attr-defined]
    assert max(box[2] for box in boxes) <= width and max(box[3] for box in boxes) <= height
    length = max(math.dist(m.start, m.end) for m in marks(room) if isinstance(m, Line) and m.name == "ray-0")
    assert length > 0.3 * height


def test_a_kind_of_rays_that_is_hidden_is_not_in_the_picture(room: Driver) -> None:
    show(room, hit.PANEL)
    room.session.select(0)
    room.frames(2)
    row = room.session.tree.find("R")  # type: ignore[union-attr]
    assert f"ray-{row}" in {mark.name for mark in marks(room)}
    room.session.shown.toggle_kind("reflection")
    room.frames(2)
    assert f"ray-{row}" not in {mark.name for mark in marks(room)}


def test_without_a_hit_it_says_so(room: Driver) -> None:
    show(room, hit.PANEL)
    room.session.pick(2, 2)  # the sky
    room.frames(3)
    assert room.session.tree and shown_row(room.session.tree, 0) is None
    room.unpick()

"""The panels in the window: sharing, closing, borders, all of the room, lecture mode; the figure that is on show."""

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tests.viewer.driver import Driver, viewer
from viewer.base.theme import FONT_SIZE, PANEL_TEXT
from viewer.figures.marks import Box, Line
from viewer.figures.writers.imgui import EM
from viewer.panels import PANELS
from viewer.session.layout import Corner
from viewer.session.saving import export_figure
from viewer.session.view_state import Pointer
from viewer.window import bar
from viewer.window.bindings import PANEL_KEYS
from viewer.window.overlays.pointer import DIM, SPOT

Key = imgui.Key
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def room() -> Iterator[Driver]:
    with viewer() as driver:
        driver.open("glass-ball")
        driver.frames(3)
        yield driver


def on_show() -> set[str]:
    windows = ((panel.name, internal.find_window_by_name(panel.title)) for panel in PANELS)
    return {name for name, window in windows if window and window.active}


def zoom() -> float:
    return imgui.get_style().font_scale_main


def middle(driver: Driver, place: Corner) -> tuple[float, float]:
    left, top, width, height = driver.app.tiles.places[place]
    return (left + 0.5 * width, top + 0.5 * height)


def test_each_key_gives_its_panel_all_of_the_room(room: Driver) -> None:
    usual = on_show()
    assert len(usual) == 4
    for key, panel in zip(PANEL_KEYS, PANELS, strict=False):
        room.press(key)
        assert on_show() == {panel.name}
        ((_, top, width, height),) = room.app.tiles.places.values()
        display = imgui.get_io().display_size
        assert width == display.x and top + height == display.y - bar.height()
        room.press(key)
        assert on_show() == usual
    room.move(*middle(room, Corner.TOP_RIGHT))
    room.type("z")
    assert on_show() == {"image"}
    room.move(5.0, 300.0)
    room.type("z")
    assert on_show() == usual


def test_a_double_click_on_a_title_and_a_click_on_another(room: Driver) -> None:
    left, top, _, _ = room.app.tiles.places[Corner.BOTTOM_LEFT]
    room.click(left + 30.0, top + 14.0)
    assert len(on_show()) == 4
    room.frames(30)  # half a second: the next click is no second one
    for _ in range(2):
        room.click(left + 30.0, top + 14.0)
    assert on_show() == {"tree"}
    room.press(Key.f4)
    left, top, _, _ = room.app.tiles.places[Corner.BOTTOM_RIGHT]
    seen = set()
    for x in range(10, 420, 20):
        room.click(left + x, top + 14.0)
        seen |= on_show()
        room.session.layout.maximised = None
    assert seen >= {"ray", "hit", "lesson", "error", "recursion"}


def test_borders_are_dragged_and_put_back(room: Driver) -> None:
    before = dict(room.app.tiles.places)
    left, top, width, height = before[Corner.TOP_LEFT]
    border = (left + width + 2.0, top + 0.5 * height)
    room.drag([border, (border[0] - 100.0, border[1]), (border[0] - 200.0, border[1])])
    moved = room.app.tiles.places[Corner.TOP_LEFT]
    assert abs(moved[2] - (width - 200.0)) <= 3.0
    assert room.aims_at(*room.session.pixel)  # type: ignore[misc]  # nothing was picked
    for _ in range(2):
        room.click(left + moved[2] + 2.0, border[1])
    assert room.app.tiles.places == before


def test_lecture_mode(room: Driver) -> None:
    """Capitals of 17 pixels, two panels, the image as an inset that can be clicked, the menu when the mouse is at the
    top.
    """
    room.press(Key.tab)
    room.frames(4)
    assert on_show() == {"scene", "tree"}
    capital = 1456 / 2048  # of Roboto's em
    assert PANEL_TEXT * zoom() * capital == pytest.approx(17.0, abs=0.1)  # of figures
    assert EM * FONT_SIZE * zoom() * capital == pytest.approx(17.0, abs=0.1)
    room.click(*room.pixel_at(300, 60))
    assert room.aims_at(300, 60)
    menu = internal.find_window_by_name("##MainMenuBar")
    assert menu and not menu.active
    room.move(300.0, 1.0)
    room.frames(2)
    assert menu.active and set(room.app.tiles.places) == {Corner.TOP_LEFT, Corner.BOTTOM_RIGHT}
    room.move(300.0, 300.0)
    room.frames(2)
    assert not menu.active


def test_lecture_type_grows_with_the_window() -> None:
    heights = []
    for size in ((1280, 720), (1920, 1080)):
        with viewer(size) as driver:
            driver.open("glass-ball")
            driver.press(Key.tab)
            driver.frames(4)
            heights.append(zoom())
    assert heights[1] == pytest.approx(1.5 * heights[0])


def test_the_figure_under_the_mouse_is_exported_as_it_stands_there(
    room: Driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each box and each line of the tree has the place in the file that it has in the panel."""
    monkeypatch.chdir(tmp_path)
    session = room.session
    session.select(session.tree.find("TR"))  # type: ignore[union-attr]
    session.shown.toggle_kind("shadow")
    room.move(*middle(room, Corner.BOTTOM_LEFT))
    room.frames(3)
    export_figure(session)
    assert session.export.making
    session.export.making.result()
    (path,) = tmp_path.glob("*_tree_*.svg")
    root = ElementTree.fromstring(path.read_bytes())
    boxes, lines = {}, {}
    for group in root.iter(f"{SVG}g"):
        name = group.get("id") or ""
        for rect in group.iter(f"{SVG}rect"):
            x, y, w, h = (float(rect.get(key) or "nan") for key in ("x", "y", "width", "height"))
            boxes[name] = (x + 0.5 * w, y + 0.5 * h)
        for line in group.iter(f"{SVG}path"):
            lines.setdefault(name, [float(n) for n in re.findall(r"-?[\d.]+", line.get("d") or "")][:2])
    shown = room.tree_marks()
    mine = {mark.name: mark.center for mark in shown if isinstance(mark, Box) and mark.name.startswith("hit-")}
    assert len(mine) == 7
    for name, center in mine.items():
        assert np.abs(np.subtract(boxes[name], center)).max() < 0.02
    rays = {mark.name: mark.start for mark in shown if isinstance(mark, Line) and mark.name.startswith("ray-")}
    for name, start in rays.items():
        assert np.abs(np.subtract(lines[name], start)).max() < 0.01


def test_pointer_and_spotlight(room: Driver) -> None:
    """The disc is at the mouse; the spotlight darkens all but what is around it; X again ends them."""
    room.move(640.0, 300.0)
    before = room.picture().astype(int)
    room.type("x")
    assert room.session.pointer is Pointer.DISC
    disc = room.picture().astype(int)
    changed = np.argwhere(np.abs(disc - before).max(axis=2) > 30)
    assert len(changed) and np.abs(changed - (300, 640)).max() <= 16
    room.type("x")
    light = room.picture().astype(int)
    assert (light[290:310, 630:650] == before[290:310, 630:650]).all()
    away = np.hypot(*np.ogrid[-300 : 720 - 300, -640 : 1280 - 640]) > SPOT + 5.0
    assert np.abs(light - (1.0 - DIM) * before)[away].max() <= 2.0  # evenly, without seams
    room.type("x")
    assert room.session.pointer is Pointer.NONE


def test_a_notice_lies_over_the_panels_and_takes_no_click(room: Driver) -> None:
    room.session.notice.say("what has happened " * 20)
    room.frames(3)
    notice = internal.find_window_by_name("##notice")
    assert notice and notice.active and notice.pos.x >= 0.0 and notice.size.x <= imgui.get_io().display_size.x
    x, y = notice.rect().get_center()
    room.click(x, y)
    assert room.session.notice.text

"""Readability of panels: every letter has a glyph, every line fits, the right panel is in front."""

import ast
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tests import ROOT
from tests.conftest import LESSONS
from tests.viewer.driver import Driver, are_equal, body, viewer
from viewer.base.orbit import project
from viewer.lessons.lesson import read
from viewer.lessons.moments import Moment
from viewer.panels import ray
from viewer.panels.lessons import lesson
from viewer.session import actions
from viewer.session.lecture.ahead import LAST

Key = imgui.Key


@pytest.fixture
def room():
    with viewer() as driver:
        driver.open("two-lights")
        yield driver


def window(title: str) -> internal.Window:
    found = internal.find_window_by_name(title)
    assert found is not None
    return found


def written() -> str:
    """All strings of the viewer and of the texts that it shows, and the lessons' texts."""
    sources = [
        *(ROOT / "viewer").rglob("*.py"),
        ROOT / "tracer" / "tree" / "text.py",
        *(ROOT / "tracer").glob("shapes/*.py"),
    ]
    texts = [
        node.value
        for path in sources
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    texts += [path.read_text("utf-8") for path in (ROOT / "lessons").glob("*/lesson.md")]
    return "".join(texts)


def test_every_character_is_in_the_fonts(room: Driver) -> None:
    font = imgui.get_io().fonts.fonts[0]
    beyond = {
        character for character in written() if ord(character) > 127
    }  # 127, a control character, is written escaped
    assert {"ᵖ", "θ", "₁", "−", "Σ"} <= beyond
    assert sorted(character for character in beyond if not font.is_glyph_in_font(ord(character))) == []


@pytest.mark.parametrize(
    "size", [(900, 600), *(pytest.param(size, marks=pytest.mark.slow) for size in ((1280, 720), (1600, 900)))]
)
def test_lesson_texts_stay_inside_their_panel(room: Driver, size: tuple[int, int]) -> None:
    room.resize(size)
    for name in LESSONS:
        actions.open_lesson(room.session, name)
        room.app.settle(4)
        panel = body(lesson.PANEL.title)
        assert panel.content_size.x <= panel.size.x


def test_a_piece_that_takes_the_rest_of_the_panel_needs_no_scroll_bar(room: Driver) -> None:
    found = read("ray-sphere")
    room.session.appearance.toggle_lecture_size()
    room.session.player.show(found, Moment(0, LAST))
    room.app.settle(4)
    panel = body(lesson.PANEL.title)
    assert panel.content_size.y > 0.9 * panel.size.y and panel.scroll_max.y == 0.0


def test_selected_ray_comes_to_the_front_and_begins_at_its_top(room: Driver) -> None:
    actions.open_lesson(room.session, "glass-ball")
    room.app.settle()
    room.press(Key.mod_alt, Key.down_arrow)
    place = body(ray.PANEL.title).rect().get_center()
    room.wheel(place.x, place.y, -20)
    assert body(ray.PANEL.title).scroll.y > 0
    room.press(Key.mod_alt, Key.down_arrow)
    assert body(ray.PANEL.title).scroll.y == 0


def test_lecture_size_and_back_leaves_no_trace(room: Driver) -> None:
    room.frames(12)  # imgui's tables and scroll bars need some
    before = room.picture()
    for _ in range(5):
        room.press(Key.tab)
        room.press(Key.tab)
    room.frames(3)
    assert are_equal(room.picture(), before)


def test_however_many_faults_all_can_be_reached(room: Driver, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text("format = 1\n" + '[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = -1\n' * 80)
    room.open_file(path)
    room.frames(4)
    assert len(room.session.faults) == 80
    box = window("This cannot be shown")
    width, height = imgui.get_io().display_size
    assert box.pos.x >= 0 and box.pos.x + box.size.x <= width
    assert box.pos.y >= 0 and box.pos.y + box.size.y <= height
    assert box.scroll_max.y > 0


def test_notice_goes_by_itself(room: Driver) -> None:
    room.session.notice.say("wrote a file")
    room.frames()
    assert room.session.notice.text == "wrote a file"
    room.session.notice.ends = 0.0
    assert room.session.update()
    assert room.session.notice.text == ""


def test_escape_closes_an_open_menu_and_nothing_else(room: Driver) -> None:
    pixel = room.session.pixel
    room.click(70, 10)
    any_popup = imgui.PopupFlags_.any_popup
    assert internal.is_popup_open(0, any_popup | imgui.PopupFlags_.any_popup_level)
    room.press(Key.escape)
    assert not internal.is_popup_open(0, any_popup | imgui.PopupFlags_.any_popup_level)
    assert room.session.pixel == pixel


def test_scene_of_ones_own_is_seen_with_its_camera(room: Driver, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(
        "format = 1\n[camera]\nposition = [0, 2, 30]\nlook_at = [0, 0, 0]\n"
        '[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n'
    )
    room.open_file(path)
    session = room.session
    assert session.world
    points = np.stack([session.frame.inside(session.world.view().eye), np.zeros(3)])
    _, _, width, height = room.canvas.stage_place
    places, depths = project(points, session.orbit.framed(width / height).matrix(width / height), (1.0, 1.0))
    assert (depths > 0).all()
    assert ((places > 0.0) & (places < 1.0)).all()

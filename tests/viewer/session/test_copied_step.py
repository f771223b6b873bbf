"""The view on show, copied as a step of a lesson, is the same view when the lesson is given."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

from tests.viewer.driver import Driver, are_equal, viewer
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.moments import Moment
from viewer.lessons.skeleton import SCENE
from viewer.lessons.step import LessonView, State
from viewer.lessons.step_text import step_text
from viewer.reopen.view_state import INSETS
from viewer.session.layout import Corner
from viewer.session.restore.view import state_of

K = imgui.Key
HEAD = """\
+++
title = "Mine"
question = "Why?"
pixel = [3, 4]
set = { object = { ball = { radius = 0.7 } } }
+++
## Another
```step
depth = 1
model = "fresnel"
show = ["shadow"]
panels = ["image"]
view = { azimuth = -50, elevation = 60, distance = 3 }
```
"""


def lesson_of(folder: Path, text: str) -> Lesson:
    (folder / "lesson.md").write_text(text, "utf-8")
    return read_file(folder / "lesson.md")


def show(driver: Driver, lesson: Lesson, step: int) -> None:
    driver.session.player.show(lesson, Moment(step))
    driver.app.settle()


def scene_picture(driver: Driver) -> np.ndarray:
    """The window's left part without its bar: the panels beside the text."""
    driver.app.settle()
    driver.session.notice.text = ""
    driver.frames(4)
    left, *_ = driver.app.tiles.places[Corner.TOP_RIGHT]  # of the lesson
    return driver.picture()[:-40, : round(left)].copy()


def test_a_copied_step_leads_back_to_the_view(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    copied: list[str] = []
    monkeypatch.setattr("viewer.session.saving.copy_to_clipboard", copied.append)
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    shutil.copy(tmp_path / "scene.toml", tmp_path / "other scene.toml")
    start = '## Start\n```step\nscene = "other scene.toml"\nset = { material.mirror.ior = 1.5, camera.fov = 41 }\n```\n'
    with viewer() as driver:
        session = driver.session
        show(driver, lesson_of(tmp_path, HEAD + start), 1)
        session.pick(171, 147)
        session.set_depth(2)
        session.set_model("whitted")
        session.shown.kinds = {"camera", "reflection"}
        session.select(session.tree.find("R") if session.tree else None)
        session.orbit.turn(0.3, 0.1)
        session.inset = INSETS[1]
        session.layout.teach(("scene", "hit", "tree"))
        driver.press(K.mod_ctrl, K.mod_shift, K.l)
        (block,) = copied
        before, seen = state_of(session), scene_picture(driver)
        lesson = lesson_of(tmp_path, HEAD + "## Copied\n" + block)
        show(driver, lesson, 0)
        assert state_of(session) != before
        show(driver, lesson, 1)
        assert state_of(session) == before and before.pixel == (171, 147) and before.select == "R"
        assert are_equal(scene_picture(driver), seen)
        assert lesson.steps[1].state.set == {"material": {"mirror": {"ior": 1.5}}, "camera": {"fov": 41}}


def test_any_state_is_read_back(tmp_path: Path) -> None:
    """Names with every sign that TOML treats in its own way."""
    odd = 'pool "tiles" \\ = #, \t\x7f é 😀'
    state = State(
        scene="a'b.toml", set={"material": {odd: {"ior": 1.5, "color": [0.1, 1e-9, 1.0]}}, "x": {"y": {"z": odd}}},
        pixel=(0, 7), sample=3, depth=0, model="fresnel", show=(), view=LessonView(-0.25, 0.0, 1e-3, (0.0, -3.0, 1e9)),
        panels=("hit",), hit="TR.L(key)",
    )  # fmt: skip
    lesson = lesson_of(tmp_path, HEAD + "## Copied\n" + step_text(state))
    assert lesson.steps[1].state == state
    plain = replace(state, sample=None, view=LessonView(), hit=None, set={})
    assert lesson_of(tmp_path, HEAD + "## Copied\n" + step_text(plain)).steps[1].state == plain

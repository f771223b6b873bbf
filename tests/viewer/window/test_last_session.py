"""The last session comes back at the next start: real windows, real processes, real keys."""

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings, strategies as st

from tests.viewer.desk import LINUX_ONLY, Desk, start_screen
from tests.viewer.driver import are_equal, viewer
from tests.viewer.screen import bare_screen, hand
from tests.viewer.session.test_opening import write_ball
from tests.viewer.session.test_reopening import change_everything, fresh, still
from tests.viewer.window.test_window import pasted
from viewer.cli import view
from viewer.cli.options import ViewOptions
from viewer.lessons import lesson
from viewer.reopen.view_state import ViewState
from viewer.session.restore.last_session import LastSession, SessionKeeper, WindowPlace, read_last, write_last
from viewer.session.restore.view import state_of
from viewer.window.screens import is_reachable, screen_of

pytestmark = [pytest.mark.early, LINUX_ONLY]

# The program, which tells when it has kept its session.
PROGRAM = """
import sys
from viewer.session.restore import last_session
write = last_session.write_last
def told(path, last):
    write(path, last)
    print("kept", last.scene, last.state.depth, last.state.theme, last.window, flush=True)
last_session.write_last = told
from viewer.cli.main import program
program()
"""
PLACE = WindowPlace(40, 60, 900, 600)


class Running:
    """The program in a process of its own."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.ahead = [self._read()]  # its window is there then
        self.window = hand("search", "--onlyvisible", "--name", "raytree$").splitlines()[-1]

    def until_kept(self, pattern: str) -> str:
        """Wait until it keeps a session that matches."""
        while not re.search(pattern, line := self.ahead.pop() if self.ahead else self._read()):
            pass
        return line

    def _read(self) -> str:
        assert self.process.stdout and self.process.stderr
        line = self.process.stdout.readline()
        assert line, self.process.stderr.read()
        return line

    def press(self, key: str) -> None:
        hand("windowfocus", "--sync", self.window, "key", key)

    def quit(self) -> None:
        self.press("ctrl+q")
        _, complained = self.process.communicate(timeout=60)
        assert (self.process.returncode, complained) == (0, "")

    def geometry(self) -> dict[str, int]:
        lines = hand("getwindowgeometry", "--shell", self.window).splitlines()
        return {name: int(value) for name, value in (line.split("=") for line in lines)}


@contextmanager
def program(folder: Path, *words: str, display: str | None = None) -> Iterator[Running]:
    """Run `raytree` with its settings in this folder."""
    start_screen()
    environment = {**os.environ, "XDG_CONFIG_HOME": str(folder), "PYTHONPATH": str(Path(__file__).parents[3])}
    if display:
        environment["DISPLAY"] = display
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    before = os.environ["DISPLAY"]
    os.environ["DISPLAY"] = environment["DISPLAY"]  # for xdotool
    with subprocess.Popen([sys.executable, "-c", PROGRAM, *words], cwd=folder, env=environment, **streams) as process:
        try:
            yield Running(process)
        finally:
            process.kill()
            os.environ["DISPLAY"] = before


def kept_in(folder: Path) -> LastSession:
    last, note = read_last(folder / "raytree" / "session.json")
    assert last and not note
    return last


def test_the_window_comes_back_as_it_was(tmp_path: Path) -> None:
    with program(tmp_path, "view", "two-lights", "--size", "900x600") as first:
        first.until_kept("two-lights . dark")
        hand("windowmove", "--sync", first.window, 123, 145)
        for key in ("t", "Tab", "2", "Right"):
            first.press(key)
        first.until_kept("two-lights 2 light.*x=123, y=145")
        place = first.geometry()
        first.quit()
    last = kept_in(tmp_path)
    assert last.scene == "two-lights" and last.window and not last.window.full_screen
    assert (last.state.depth, last.state.theme, last.state.type_size) == (2, "light", "lecture")
    found = lesson.read("two-lights").first.state.pixel
    assert found and last.state.pixel == (found[0] + 1, found[1])
    with program(tmp_path) as second:
        assert second.geometry() == {**place, "WINDOW": second.geometry()["WINDOW"]}
        assert (place["WIDTH"], place["HEIGHT"]) == (900, 600)
        second.until_kept("two-lights 2 light")
        second.quit()
    assert kept_in(tmp_path) == last
    with program(tmp_path, "view", "plates") as third:  # a scene that is given takes nothing from the last session
        third.until_kept("plates 5 dark")
        assert third.geometry()["WIDTH"] == view.SIZE[0]
        third.quit()


def test_a_killed_program_has_kept_what_was_on_show(tmp_path: Path) -> None:
    with program(tmp_path, "view", "plates") as first:
        first.until_kept("plates 5")
        first.press("1")
        first.until_kept("plates 1")
        first.process.kill()
    assert kept_in(tmp_path).state.depth == 1
    assert sorted(path.name for path in (tmp_path / "raytree").iterdir() if path.suffix != ".ini") == ["session.json"]


@pytest.mark.parametrize(
    "manager", [True, pytest.param(False, marks=pytest.mark.slow)], ids=["with a window manager", "without"]
)
def test_full_screen_and_back(tmp_path: Path, manager: bool) -> None:
    with program(tmp_path, "view", "plates", "--size", "900x600", display=None if manager else bare_screen()) as first:
        first.until_kept("plates 5 dark")
        hand("windowmove", "--sync", first.window, 123, 145)
        first.until_kept("x=123, y=145.*full_screen=False")
        before = first.geometry()
        for _ in range(2):
            first.press("F11")
            first.until_kept("full_screen=True")
            place = first.geometry()
            assert (place["X"], place["Y"], place["WIDTH"], place["HEIGHT"]) == (0, 0, 1600, 1000)
            first.press("Escape")
            first.press("t")
            first.until_kept("full_screen=True")
            assert first.geometry() == place  # Esc does not leave it
            first.press("F11")
            first.until_kept("full_screen=False")
            assert first.geometry() == before
        first.press("F11")
        first.until_kept("full_screen=True")
        first.quit()
    with program(tmp_path, display=None if manager else bare_screen()) as second:
        second.until_kept("full_screen=True")
        assert second.geometry() == {**place, "WINDOW": second.geometry()["WINDOW"]}
        second.press("F11")
        second.until_kept("full_screen=False")
        assert second.geometry() == {**before, "WINDOW": second.geometry()["WINDOW"]}
        second.quit()


@pytest.mark.parametrize("name", ["glass-ball", "scene.toml"])
def test_every_part_of_the_view_is_restored(tmp_path: Path, name: str) -> None:
    (tmp_path / "raytree").mkdir()
    with viewer() as driver:
        if name == "scene.toml":
            write_ball(tmp_path / name, "1")
            driver.open_file(tmp_path / name)
        else:
            driver.open(name)
        change_everything(driver)
        keeper = SessionKeeper(tmp_path / "session.json", driver.session, lambda: PLACE)
        keeper.close()
        state, picture = state_of(driver.session), still(driver)
        last, opening = view._with_last_session(ViewOptions(), tmp_path)
        assert last and last.window == PLACE
        other = fresh(driver)
        other.session.loader.load(opening)
        other.app.settle()
        assert state_of(other.session) == state
        assert are_equal(still(other), picture)


def opened(folder: Path, **given_options: object) -> tuple[str, ViewState, str]:
    """The scene, the state and the note that a start opens with."""
    _, opening = view._with_last_session(ViewOptions(**given_options), folder)  # type: ignore[arg-type]
    return opening.lesson.name if opening.lesson else str(opening.path), opening.state, opening.note


def test_what_is_given_goes_before_the_last_session(tmp_path: Path) -> None:
    own = ViewState(pixel=(3, 4), depth=1, theme="light", camera=(1.5, 2.5, 3.5))
    write_last(tmp_path / "session.json", LastSession("plates", own, PLACE))
    assert opened(tmp_path) == ("plates", own, "")
    assert opened(tmp_path, depth=2) == ("plates", replace(own, depth=2), "")
    assert opened(tmp_path, pixel=(9, 9)) == (lesson.names()[0], ViewState(pixel=(9, 9)), "")
    assert opened(tmp_path, scene="drop") == ("drop", ViewState(), "")


def test_a_session_that_cannot_be_used_opens_the_first_lesson_with_a_notice(tmp_path: Path) -> None:
    first, path = lesson.names()[0], tmp_path / "session.json"
    assert opened(tmp_path) == (first, ViewState(), "")
    good = {"format": "raytree-session/1", "scene": "plates", "view": {}, "window": None}
    for change in (
        {"format": "raytree-session/2"}, {"scene": 3}, {"scene": "a\0"}, {"view": []}, {"view": {"pixel": "no"}},
        {"window": {"x": 1}}, {"window": {"x": 1, "y": 1, "width": 0, "height": 5, "full_screen": False}},
    ):  # fmt: skip
        path.write_text(json.dumps({**good, **change}))
        name, state, note = opened(tmp_path)
        assert (name, state) == (first, ViewState())
        assert note.startswith("the last session is not restored: session.json cannot be used (") and note.isprintable()
    path.write_text(json.dumps({**good, "scene": str(tmp_path / "gone.toml")}))
    assert opened(tmp_path)[::2] == (first, f"the last scene is not restored: {tmp_path}/gone.toml: file not found")
    path.write_text(json.dumps({**good, "scene": str(tmp_path / "gone.svg")}))  # a figure whose copy was on show
    assert opened(tmp_path)[::2] == (first, f"the last scene is not restored: {tmp_path}/gone.svg: file not found")
    path.write_text(json.dumps({**good, "scene": "no-such-lesson"}))
    assert opened(tmp_path)[0] == first and 'no lesson "no-such-lesson"' in opened(tmp_path)[2]


def test_a_last_scene_with_faults_opens_the_first_lesson_without_a_window_of_faults(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    write_ball(scene, "-1")
    write_last(tmp_path / "session.json", LastSession(str(scene), ViewState(theme="light"), None))
    _, opening = view._with_last_session(ViewOptions(), tmp_path)
    with viewer() as driver:
        driver.session.loader.load(opening)
        driver.app.settle()
        driver.frames()
        assert driver.session.lesson and driver.session.lesson.name == lesson.names()[0]
        assert not driver.session.faults
        assert driver.session.notice.text == (
            f'the last scene is not restored: {scene}: object[0] "ball": radius must be > 0, got -1'
        )


NAMES = st.sampled_from(["format", "scene", "view", "window", "x", "pixel"])
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(NAMES, inner),
)


@settings(max_examples=300, deadline=None)
@given(st.binary(max_size=60) | JSON.map(lambda found: json.dumps(found).encode()))
def test_any_file_is_read_without_an_exception(content: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "session.json"
        path.write_bytes(content)
        last, note = read_last(path)
        assert (last is None) == bool(note) and note.isprintable()


def test_nothing_is_kept_before_a_scene_is_on_show_and_a_file_that_cannot_be_written_is_left(tmp_path: Path) -> None:
    path = tmp_path / "session.json"
    with viewer() as driver:
        SessionKeeper(path, driver.session, lambda: PLACE).close()
        assert not path.exists()
        driver.open("plates")
        path.write_text("mine")
        path.chmod(0o444)
        SessionKeeper(path, driver.session, lambda: PLACE).close()
        assert path.read_text() == "mine"


def test_a_window_is_placed_only_where_it_can_be_reached() -> None:
    screens = [(0, 0, 1600, 1000), (1600, 200, 800, 600)]
    assert is_reachable((100, 80, 1280, 720), screens) and is_reachable((2200, 300, 400, 900), screens)
    assert not is_reachable((2350, 300, 400, 300), screens)  # 50 pixels of it
    assert not is_reachable((100, -300, 1280, 720), screens) and not is_reachable((100, 990, 1280, 720), screens)
    assert not is_reachable((-1279, 0, 1280, 720), screens) and not is_reachable((0, 0, 9, 9), [])
    assert screen_of((1500, 300, 700, 300), screens) == 1 and screen_of((-5000, 0, 9, 9), screens) == 0


def test_a_window_that_stood_on_a_screen_that_is_gone_is_placed_anew(tmp_path: Path) -> None:
    (tmp_path / "raytree").mkdir()
    far = WindowPlace(5000, 4000, 900, 600)
    write_last(tmp_path / "raytree" / "session.json", LastSession("plates", ViewState(), far))
    with program(tmp_path) as running:
        place = running.geometry()
        assert is_reachable((place["X"], place["Y"], place["WIDTH"], place["HEIGHT"]), [(0, 0, 1600, 1000)])
        assert (place["WIDTH"], place["HEIGHT"]) == (900, 600)


def test_the_view_is_copied_by_its_key_and_a_drop_opens_a_file(tmp_path: Path) -> None:
    """The command line in the clipboard is that of this window; the drop comes as GLFW calls it."""
    desk = Desk("glass-ball")
    try:
        hand("windowactivate", "--sync", desk.id)
        hand("key", "ctrl+l")
        desk.until(lambda: "of this view is copied" in desk.session.notice.text, "the copy")
        words = shlex.split(pasted("text").decode())
        assert words[:3] == ["raytree", "view", "glass-ball"] and words[-2:] == ["--size", "1280x720"]
        assert words[words.index("--pixel") + 1] == "248,180"
        scene = tmp_path / "scene.toml"
        write_ball(scene, "1")
        desk.window._drop(None, [str(scene)])
        desk.until(lambda: desk.session.path == scene, "the dropped scene")
    finally:
        desk.app.close()

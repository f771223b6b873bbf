"""Ctrl+S in the window: the figure on show, and a command line that makes the same bytes."""

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from imgui_bundle import imgui

import tracer
from tests.viewer.driver import Driver, viewer
from viewer.cli import main
from viewer.figures.catalogue import FIGURE_NAMES
from viewer.session.figure_export import SHOWN, FigureExport, free_path

pytestmark = pytest.mark.early


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Driver]:
    monkeypatch.chdir(tmp_path)
    with viewer() as driver:
        yield driver


def press_save(room: Driver) -> None:
    """Press Ctrl+S and wait until it has succeeded or failed."""
    room.press(imgui.Key.mod_ctrl, imgui.Key.s)
    while room.session.export.making:
        room.session.export.making.exception()
        room.frames()
    room.frames()


def save(room: Driver) -> Path:
    """Press Ctrl+S and return the file."""
    before = set(Path().iterdir())
    press_save(room)
    (path,) = set(Path().iterdir()) - before
    return path


@pytest.mark.parametrize("figure", FIGURE_NAMES)
def test_the_command_line_makes_the_same_file(room: Driver, figure: str, tmp_path: Path) -> None:
    room.open("glass-ball")
    room.session.orbit.turn(0.3, 0.1)
    room.type("2")
    room.session.export.figure = figure
    if figure == "hit":
        room.session.select(4)
    path = save(room)
    assert path.name == f"glass-ball_248_180_{figure}_d2.svg"
    assert f"wrote {path.resolve()}" in room.session.notice.text
    command = shlex.split(room.session.export.command)
    assert command[0] == "raytree"
    assert main.main([*command[1:], "-o", "again.svg"]) == 0
    assert Path("again.svg").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("figure", "order", "keys"),
    [
        ("both", "breadth", "g"),
        ("tree", "recursion", "o"),
        pytest.param("both", "breadth", "", marks=pytest.mark.slow),
        pytest.param("tree", "breadth", "", marks=pytest.mark.slow),
        pytest.param("both", "recursion", "o", marks=pytest.mark.slow),
    ],
)
def test_a_step_on_show_is_the_exported_page(room: Driver, figure: str, order: str, keys: str) -> None:
    """Ctrl+S writes the step on show, its command line the same bytes, and all pages at once have the same marks."""
    room.open("mirror-balls")
    session, reveal = room.session, room.session.reveal
    session.export.figure = figure
    room.type(keys)
    granularity, count = reveal.granularity, len(reveal.steps or ())
    reveal.go_to(0)
    save(room).unlink()
    command = shlex.split(session.export.command)
    place = command.index("--page")
    assert command[place + 1] == "0" and {"--step", granularity} <= set(command)
    assert ("--order" in command) == (order != "breadth")
    assert main.main([*command[1:place], *command[place + 2 :], "-o", "all/"]) == 0
    pages = sorted(Path("all").iterdir())
    assert len(pages) == count
    for k in range(0, count, 3):
        reveal.go_to(k)
        path = save(room)
        assert session.step and path.stem.endswith(f"_{session.step.name}") and path.name == pages[k].name
        command = shlex.split(session.export.command)
        assert main.main([*command[1:], "-o", "again.svg"]) == 0
        assert Path("again.svg").read_bytes() == path.read_bytes()
        assert drawn(path) == drawn(pages[k])


def drawn(path: Path) -> str:
    """An SVG without the command that makes it."""
    return re.sub(r"<metadata>.*?</metadata>", "", path.read_text("utf-8"), flags=re.DOTALL)


def test_an_earlier_figure_is_never_lost(room: Driver) -> None:
    room.open("mirror-balls")
    first, second = save(room), save(room)
    assert second.name == first.with_stem(f"{first.stem}-2").name
    assert first.read_bytes() == second.read_bytes()
    assert free_path(first).name == f"{first.stem}-3.svg"


def test_without_a_clipboard_that_is_said() -> None:
    """In a process of its own: the library looks for a screen once. With one: tests/viewer/window/test_window.py."""
    code = "from viewer.base.clipboard import copy_to_clipboard; copy_to_clipboard('words')"
    bare = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    run = subprocess.run([sys.executable, "-c", code], env=bare, capture_output=True, text=True)
    said = run.stderr.strip().splitlines()[-1]
    assert said.startswith("viewer.base.files.Unusable: cannot copy to the clipboard: ")
    assert said.endswith("; Ctrl+S writes the figure to a file")


def test_the_choice_is_kept(room: Driver, tmp_path: Path) -> None:
    """From one start to the next. An invalid choice is ignored."""
    kept = tmp_path / "kept" / "figure.json"
    kept.parent.mkdir()
    room.open("mirror-balls")
    mine = room.session.export
    mine.remember(kept)
    mine.figure, mine.format, mine.theme = "tree", "tikz", "mono"
    save(room)
    later = FigureExport(room.session.calls.post)
    later.remember(kept)
    assert (later.figure, later.format, later.theme) == ("tree", "tikz", "mono")
    for text in ("", "[]", '{"figure": "cake"}', '{"figure": "cake", "format": "svg", "theme": ""}'):
        kept.write_text(text)
        fresh = FigureExport(room.session.calls.post)
        fresh.remember(kept)
        assert (fresh.figure, fresh.format, fresh.theme) == (SHOWN, "svg", "")


def test_without_a_pixel_there_is_nothing_to_export(room: Driver, tmp_path: Path) -> None:
    room.open("mirror-balls")
    room.unpick()
    press_save(room)
    assert room.session.notice.text == "nothing to export yet: pick a pixel"
    assert list(tmp_path.iterdir()) == []


def test_a_hit_that_is_none_is_said(room: Driver, tmp_path: Path) -> None:
    """The selected ray leaves the scene: there is no hit to show."""
    room.open("glass-ball")
    tree = room.session.tree
    assert tree
    room.session.select(next(i for i in range(len(tree)) if tree.end(i) == "background"))
    room.session.export.figure = "hit"
    press_save(room)
    known = "E, T (T2), TR (R3), TT (T4), TRR (R5), TRT (T6)"
    assert room.session.faults == [f"--node R must be the path or the label of a ray that meets a surface: {known}"]
    assert list(tmp_path.iterdir()) == []


def test_notebooks_show_the_figure(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["glass-ball"], (248, 180), depth=2)
    text = tree._repr_svg_()
    assert text is not None
    assert text.startswith("<?xml")
    assert "glass ball" in text

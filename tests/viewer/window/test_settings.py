"""The places of the panels are kept from one start to the next, in a file that is replaced as a whole."""

import os
import sys
from pathlib import Path

import pytest

from tests.viewer.pseudo_terminal import on_a_terminal
from tests.viewer.screen import hand, missing, screen
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import Window

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="X servers without a monitor are Linux's")


@pytest.fixture(scope="module", autouse=True)
def display() -> str:
    assert not missing(), f"these tests need the Debian packages {', '.join(missing())}"
    return screen()


def open_and_close(ini: Path) -> None:
    app = App(Window("raytree", (800, 600), ini), Session())
    try:
        for _ in range(3):
            app.session.update()
            app.frame()
    finally:
        app.close()


def test_the_layout_is_read_and_stored(tmp_path: Path) -> None:
    kept, ini = tmp_path / "kept.ini", tmp_path / "panels.ini"
    ini.symlink_to("kept.ini")
    open_and_close(ini)
    first = kept.read_text("utf-8")
    assert "[Docking][Data]" in first
    kept.write_text(first.replace("[Docking]", "[Window][Far away]\nPos=123,77\nSize=50,60\n\n[Docking]", 1), "utf-8")
    before = kept.stat().st_ino
    open_and_close(ini)
    assert kept.stat().st_ino != before  # it was replaced, not written over
    assert "[Window][Far away]\nPos=123,77\nSize=50,60\n" in kept.read_text("utf-8")
    assert ini.is_symlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["kept.ini", "panels.ini"]


def test_a_layout_that_cannot_be_read_or_stored_is_left_alone(tmp_path: Path) -> None:
    ini = tmp_path / "panels.ini"
    ini.write_bytes(b"\xff\xfe\0 no layout")
    ini.chmod(0o444)
    open_and_close(ini)
    assert ini.read_bytes() == b"\xff\xfe\0 no layout"


def test_the_viewer_opens_where_no_settings_can_be_kept(tmp_path: Path) -> None:
    options = {"XDG_CONFIG_HOME": "/dev/null", "DISPLAY": os.environ["DISPLAY"]}
    with on_a_terminal(["view", "two-lights"], tmp_path, **options) as terminal:
        hand("search", "--sync", "--onlyvisible", "--name", "raytree")
        terminal.process.terminate()
        assert terminal.wait() == 128 + 15
    assert "Traceback" not in terminal.said

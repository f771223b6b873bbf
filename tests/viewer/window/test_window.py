"""A real window on a real X server: the mouse moves, keys are pressed, the window is resized and minimised."""

import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

import tracer
from tests.viewer.desk import LINUX_ONLY, Desk, start_screen
from tests.viewer.screen import hand
from viewer.cli import main

pytestmark = LINUX_ONLY


@pytest.fixture
def desk() -> Iterator[Desk]:
    made = Desk("glass-ball")
    yield made
    assert made.window.ctx.error == "GL_NO_ERROR"
    made.app.close()


def shows_tree_of(desk: Desk, world: tracer.World) -> bool:
    """True if the node table on show is the tracer's own for the pixel and depth on show."""
    session = desk.session
    assert session.tree
    expected = tracer.trace(world, session.pixel, depth=session.depth, model=session.model)
    return session.tree.nodes.tobytes() == expected.nodes.tobytes()


def test_click_keys_and_drag(desk: Desk, worlds: dict[str, tracer.World]) -> None:
    world, session = worlds["glass-ball"], desk.session
    before = session.pixel
    hand("mousemove", *desk.pixel_at(640, 320), "click", 1)
    desk.until(lambda: session.pixel != before, "the click")
    assert session.pixel and np.abs(np.subtract(session.pixel, (640, 320))).max() <= 2
    assert shows_tree_of(desk, world)

    for key, depth in (("0", 0), ("2", 2), ("plus", 3), ("minus", 2), ("1", 1)):
        hand("key", key)
        desk.until(lambda depth=depth: session.depth == depth, f"depth {depth} by key {key}")
        assert shows_tree_of(desk, world)
    desk.until(desk.is_quiet, "the image of depth 1")
    picture = session.image.picture
    assert picture
    assert picture.pixels.tobytes() == tracer.render(world, depth=1).pixels.tobytes()

    picked = session.pixel
    hand("key", "Right")
    desk.until(lambda: session.pixel == (picked[0] + 1, picked[1]), "the arrow key")
    seen = []
    for x in (200, 240, 280, 320, 360):
        last = session.pixel
        hand("mousemove", *desk.pixel_at(x, 300), *(("mousedown", 1) if x == 200 else ()))
        desk.until(lambda last=last: session.pixel != last, f"the drag to {x}")
        seen.append(session.pixel)
        assert shows_tree_of(desk, world)
    hand("mouseup", 1)
    assert np.abs(np.array(seen)[:, 0] - (200, 240, 280, 320, 360)).max() <= 2
    hand("key", "t")
    desk.until(lambda: not session.appearance.theme.dark, "the light theme")


def test_tree_panel_takes_clicks(desk: Desk) -> None:
    left, top = desk.place()
    for row in (0, 2, 4):
        x, y = desk.app.canvas.nodes[row]
        hand("mousemove", round(left + x), round(top + y), "click", 1)
        desk.until(lambda row=row: desk.session.selected == row, f"the click on node {row}")


def test_sizes_tiny_and_large(desk: Desk, worlds: dict[str, tracer.World]) -> None:
    session = desk.session
    for width, height in ((480, 320), (1500, 900), (700, 330), (1280, 720)):
        hand("windowsize", desk.id, width, height)
        desk.until(lambda width=width, height=height: desk.size() == (width, height), f"the size {width}x{height}")
        desk.until(lambda: True, "a frame")
    before = session.pixel
    hand("mousemove", *desk.pixel_at(520, 310), "click", 1)
    desk.until(lambda: session.pixel != before, "the click")
    assert session.pixel and np.abs(np.subtract(session.pixel, (520, 310))).max() <= 2
    assert shows_tree_of(desk, worlds["glass-ball"])


def test_minimised_and_back(desk: Desk, worlds: dict[str, tracer.World]) -> None:
    hand("windowminimize", desk.id)
    desk.until(lambda: desk.window.minimised, "the window going")
    desk.session.set_depth(1)  # by the program, while the window is minimised
    desk.session.image.wait()
    hand("windowmap", desk.id)
    desk.until(lambda: not desk.window.minimised, "the window coming back")
    desk.until(desk.is_quiet, "the image")
    assert shows_tree_of(desk, worlds["glass-ball"])


def test_program_runs_by_itself_and_ends_on_its_key(
    tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The command as a user starts it: a window comes up, Ctrl+Q closes it, the status is 0."""
    start_screen()
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("settings")))
    command = [str(Path(sys.executable).parent / "raytree"), "view", "two-lights", "--pixel", "300,300"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        window = hand("search", "--sync", "--onlyvisible", "--name", "A room with two lights").splitlines()[0]
        hand("windowactivate", "--sync", window)
        hand("key", "ctrl+q")
        said, complained = process.communicate(timeout=60)
    assert process.returncode == 0
    assert (said, complained) == ("", "")
    assert list(tmp_path.iterdir()) == []


PASTE = """
import sys
import copykitten
if sys.argv[1] == "text":
    sys.stdout.buffer.write(copykitten.paste().encode("utf-8"))
else:
    pixels, width, height = copykitten.paste_image()
    sys.stdout.buffer.write(f"{width} {height} ".encode() + pixels)
"""


def pasted(what: str) -> bytes:
    """The content of the clipboard, as another program reads it."""
    return subprocess.run([sys.executable, "-c", PASTE, what], capture_output=True, check=True).stdout


def test_a_copied_figure_is_pasted_elsewhere(desk: Desk, tmp_path: Path) -> None:
    """The picture in the clipboard equals the one that the copied command line writes; TikZ is copied as text."""
    home = desk.session.export
    home.figure, home.theme = "tree", "light"
    hand("windowactivate", "--sync", desk.id)
    hand("key", "ctrl+c")
    desk.until(lambda: "copied as a picture" in desk.session.notice.text, "the copy")
    hand("key", "ctrl+shift+c")
    desk.until(lambda: "command line is copied" in desk.session.notice.text, "the command line")
    command = shlex.split(pasted("text").decode("utf-8"))
    assert command == shlex.split(home.command)
    hand("key", "ctrl+c")
    desk.until(lambda: "copied as a picture" in desk.session.notice.text, "the copy")
    out = tmp_path / "a.png"
    assert main.main([*command[1:], "-o", str(out)]) == 0
    with PIL.Image.open(out) as picture:
        width, height, pixels = pasted("picture").split(b" ", 2)
        assert (int(width), int(height)) == picture.size and picture.width == 1920
        copied = np.frombuffer(pixels, np.uint8).reshape(picture.height, picture.width, 4)
        written = np.asarray(picture.convert("RGBA"))
    seen = written[..., 3] > 0
    assert seen.any()
    assert (copied[seen] == written[seen]).all()
    assert (copied[..., 3] == written[..., 3]).all()
    home.format = "tikz"
    hand("key", "ctrl+c")
    desk.until(lambda: "copied as TikZ" in desk.session.notice.text, "the copy as TikZ")
    out = tmp_path / "a.tex"
    assert main.main([*shlex.split(home.command)[1:], "-o", str(out)]) == 0
    assert pasted("text") == out.read_bytes()

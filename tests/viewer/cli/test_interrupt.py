"""Ctrl-C and SIGTERM during a command: it ends with the signal's status and leaves no file behind."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.viewer.pseudo_terminal import on_a_terminal
from tracer.processes import python_command
from viewer.lessons import lesson

pytestmark = [
    pytest.mark.early,
    pytest.mark.skipif(sys.platform == "win32", reason="a terminal for programs is Unix's"),
]

INT, TERM = signal.SIGINT, signal.SIGTERM
BIG = ["--size", "8000x6000", "--samples", "64"]  # would take many minutes
ENDLESS = ["--size", "16x16", "--samples", "9", "--tolerance", "0"]  # one tile, which takes minutes

FEW = ["--size", "2x2", "--samples", "2000000000"]  # a pixel would take ten minutes

CASES = {
    "image": (["render", "glass-ball", "-o", "old.png", *BIG], r"render glass-ball \d+ %, \d+ min left", INT),
    "image, SIGTERM": (["render", "glass-ball", "-o", "old.png", *BIG], r"render glass-ball \d+ %", TERM),
    "several": (["render", "two-lights", "glass-ball", "-o", "new/", *BIG], r"two-lights \(1 of 2\) \d+ %", INT),
    "one tile": (["render", "glass-ball", "-o", "old.npy", *ENDLESS], r"render glass-ball \(\d s\)", TERM),
    "few pixels": (["render", "glass-ball", "-o", "old.png", *FEW], r"render glass-ball \(\d s\)", INT),
    "few pixels, bounds": (["render", "glass-ball", "-o", "old.npy", "--bounds", *FEW], r"bounds of \S+ \(\d s\)", INT),
    "bounds": (["render", "mirror-balls", "--bounds", "-o", "old.npy"], r"bounds of mirror-balls \d+ %", TERM),
    "long file": (["trace", "long.nff", "--pixel", "1,1", "-o", "old.png"], r"load long.nff \d+ %, \d+ s left", INT),
    "measuring": (["plan", "glass-ball", "--measure"], r"measuring \d+ %, \d+ s left", TERM),
    "screenshot": (["view", "large.toml", "--screenshot", "old.png"], r"render the image \d+ %", INT),
    "screenshot, SIGTERM": (["view", "long.nff", "--screenshot", "old.png"], r"load the scene", TERM),
}


# The same paths through the program as the others, with the other signal or in another command.
SLOW = ("image", "image, SIGTERM", "several", "few pixels, bounds", "bounds", "measuring", "screenshot, SIGTERM")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in CASES]
)
def test_signal_ends_a_command_that_leaves_nothing_behind(name: str, tmp_path: Path) -> None:
    arguments, said, number = CASES[name]
    if "long.nff" in arguments:
        (tmp_path / "long.nff").write_text(
            "f 1 1 1 1 0 0 0 1\n" + "p 3 0 0 0 1 0 0 0 1 0\n" * 600_000
        )  # takes seconds to read
    if "large.toml" in arguments:
        scene = lesson.read("two-lights").scene.read_text().replace("width = 800", "width = 8000")
        (tmp_path / "large.toml").write_text(scene.replace("height = 600", "height = 6000"))
    for old in ("old.png", "old.npy"):
        (tmp_path / old).write_text("old")
    (tmp_path / "tmp").mkdir()
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    with on_a_terminal(arguments, tmp_path, TMPDIR=str(tmp_path / "tmp")) as terminal:
        terminal.wait_for(said)
        terminal.process.send_signal(number)
        assert terminal.wait() == 128 + number
    assert "Traceback" not in terminal.said
    assert terminal.said.endswith("stopped\r\n")
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before
    assert not (tmp_path / "new").exists()


def test_signal_ends_the_compiler(tmp_path: Path) -> None:
    """At the first start. The next start compiles again, and never loads an incomplete file."""
    with on_a_terminal(["trace", "two-lights", "--pixel", "1,1"], tmp_path, XDG_CACHE_HOME=str(tmp_path)) as terminal:
        terminal.wait_for(r"only at the first start.*\([3-9] s\)")
        terminal.process.send_signal(INT)
        assert terminal.wait() == 128 + INT
    assert "Traceback" not in terminal.said
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_what_is_ignored_from_outside_stays_ignored(tmp_path: Path) -> None:
    """As under nohup: a signal that is ignored by the parent process does not end the command."""
    before = signal.signal(INT, signal.SIG_IGN)
    try:
        arguments = ["render", "glass-ball", "-o", "new.npy", "--size", "3200x2400"]
        with on_a_terminal(arguments, tmp_path) as terminal:
            terminal.wait_for(r"render glass-ball \d+ %")
            terminal.process.send_signal(INT)
            assert terminal.wait() == 0
    finally:
        signal.signal(INT, before)
    assert (tmp_path / "new.npy").stat().st_size > 3200 * 2400 * 24


def test_a_signal_during_a_callback_of_the_window_is_not_lost() -> None:
    """glfw calls Python from C, where an exception is lost. Before glfw is initialised, every call is an error, which
    is called back.
    """
    code = """
import signal, threading, glfw
from viewer.base.interruption import Interrupted, interruptible
glfw.set_error_callback(lambda code, text: signal.raise_signal(signal.SIGTERM))
try:
    with interruptible():
        glfw.get_time()
        threading.Event().wait()
except Interrupted as end:
    print(end.status)
"""
    run = subprocess.run(python_command(code), capture_output=True, text=True, check=True, timeout=60.0)
    assert (run.stdout, run.stderr) == (f"{128 + TERM}\n", "")

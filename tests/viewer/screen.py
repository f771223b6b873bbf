"""A screen for tests: an X server without a monitor, a window manager, and xdotool to move the mouse."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

# With the Debian packages they are in.
PROGRAMS = {"Xvfb": "xvfb", "xdotool": "xdotool", "openbox": "openbox", "setxkbmap": "x11-xkb-utils"}


def missing() -> list[str]:
    return [package for program, package in PROGRAMS.items() if shutil.which(program) is None]


@cache
def screen(width: int = 1600, height: int = 1000) -> str:
    """Start a display, make it the default one, and return its name. It lives as long as this process.

    The GL library keeps a connection to it that cannot be closed, and Xlib ends a process whose server is gone. The
    window manager runs when this returns: if a window is mapped while a manager takes over, glfw may wait forever.
    """
    display = _server(width, height)
    os.environ["DISPLAY"] = display
    with tempfile.TemporaryDirectory() as folder:
        told = Path(folder) / "told"
        os.mkfifo(told)
        with_us("openbox", "--startup", f"sh -c 'echo up > {told}'")
        told.read_text()
    return display


@cache
def bare_screen(width: int = 1600, height: int = 1000) -> str:
    """Start a display without a window manager, and return its name."""
    return _server(width, height)


def _server(width: int, height: int) -> str:
    """Start an X server, and return the name of its display."""
    read_end, write_end = os.pipe()
    # Without -noreset the server restarts when its last window closes, and the next window may not find it.
    options = ["-displayfd", str(write_end), "-screen", "0", f"{width}x{height}x24", "-noreset", "-nolisten", "tcp"]
    with_us("Xvfb", *options, keep=[write_end])
    os.close(write_end)
    with os.fdopen(read_end) as told:
        return f":{told.readline().strip()}"


def with_us(*command: str, keep: Sequence[int] = ()) -> None:
    """Start a program that ends when this process does.

    It inherits none of our streams: a reader of our output would wait until every process has closed them.
    """
    none = subprocess.DEVNULL
    subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *command], pass_fds=keep, stdin=none, stdout=none, stderr=none)


def hand(*arguments: object) -> str:
    """One xdotool command: the X server itself sends the events."""
    run = subprocess.run(["xdotool", *map(str, arguments)], capture_output=True, text=True, check=True)
    return run.stdout.strip()

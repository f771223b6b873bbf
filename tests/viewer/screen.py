"""A screen for tests: an X server without a monitor, a window manager, and a hand that really moves the mouse."""

import os
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

PROGRAMS = {"Xvfb": "xvfb", "xdotool": "xdotool", "openbox": "openbox"}  # and the Debian packages they are in

# Whoever reads what this process says waits until nobody can say any more: the server and the manager hold none of it.
SILENT = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def missing() -> list[str]:
    return [package for program, package in PROGRAMS.items() if shutil.which(program) is None]


@cache
def screen(width: int = 1600, height: int = 1000) -> str:
    """A display of our own, made the default one; its name. It lives as long as this process.

    Not a moment shorter: the GL library keeps a connection to it that cannot be closed, and Xlib ends a process whose
    server has gone. The window manager is at work when this returns: for a window that is mapped while a manager takes
    over, glfw may wait without end.
    """
    with_us = ["setpriv", "--pdeathsig", "TERM"]
    read_end, write_end = os.pipe()
    # Without -noreset the server starts afresh when its last window closes, and the next one may not find it.
    options = ["-displayfd", str(write_end), "-screen", "0", f"{width}x{height}x24", "-noreset", "-nolisten", "tcp"]
    subprocess.Popen([*with_us, "Xvfb", *options], pass_fds=[write_end], **SILENT)
    os.close(write_end)
    with os.fdopen(read_end) as told:
        display = f":{told.readline().strip()}"
    os.environ["DISPLAY"] = display
    with tempfile.TemporaryDirectory() as folder:
        told = Path(folder) / "told"
        os.mkfifo(told)
        subprocess.Popen([*with_us, "openbox", "--startup", f"sh -c 'echo up > {told}'"], **SILENT)
        told.read_text()
    return display


def hand(*arguments: object) -> str:
    """One xdotool command: the X server itself then sends the events."""
    run = subprocess.run(["xdotool", *map(str, arguments)], capture_output=True, text=True, check=True)
    return run.stdout.strip()

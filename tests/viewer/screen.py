"""A screen for tests: an X server without a monitor, a window manager, and a hand that really moves the mouse."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

PROGRAMS = {"Xvfb": "xvfb", "xdotool": "xdotool", "openbox": "openbox"}  # and the Debian packages they are in


def missing() -> list[str]:
    return [package for program, package in PROGRAMS.items() if shutil.which(program) is None]


@contextmanager
def screen(width: int = 1600, height: int = 1000) -> Iterator[str]:
    """A display's name, set as DISPLAY meanwhile."""
    read_end, write_end = os.pipe()
    # Without -noreset the server starts afresh when its last window closes, and the next one may not find it.
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{width}x{height}x24", "-noreset", "-nolisten", "tcp"],
        pass_fds=[write_end],
        stderr=subprocess.DEVNULL,
    )
    os.close(write_end)
    with os.fdopen(read_end) as told:
        number = told.readline().strip()
    display, before = f":{number}", os.environ.get("DISPLAY")
    os.environ["DISPLAY"] = display
    manager = subprocess.Popen(["openbox"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield display
    finally:
        manager.terminate()
        manager.wait()
        server.terminate()
        server.wait()
        if before is None:
            del os.environ["DISPLAY"]
        else:
            os.environ["DISPLAY"] = before


def hand(*arguments: object) -> str:
    """One xdotool command: the X server itself then sends the events."""
    run = subprocess.run(["xdotool", *map(str, arguments)], capture_output=True, text=True, check=True)
    return run.stdout.strip()

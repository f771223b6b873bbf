"""A program on a pseudo-terminal; tests wait for its output."""

import contextlib
import os
import pty
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

RAYTREE = str(Path(sys.executable).parent / "raytree")


class Terminal:
    """The output of a raytree command on a terminal, in order."""

    def __init__(self, arguments: list[str], cwd: Path, environment: dict[str, str]) -> None:
        self.end, far = pty.openpty()
        command = [RAYTREE, *arguments]
        self.process = subprocess.Popen(
            command, stdin=far, stdout=far, stderr=far, cwd=cwd, env={**os.environ, **environment}
        )
        os.close(far)
        self.said = ""

    def read(self) -> str:
        """The next part of the output; empty once the program has ended."""
        try:
            more = os.read(self.end, 4096).decode("utf-8", "replace")
        except OSError:  # on Linux: the other end is closed
            return ""
        self.said += more
        return more

    def wait_for(self, pattern: str) -> None:
        while not re.search(pattern, self.said):
            assert self.read(), f"ended without {pattern!r}, having said {self.said!r}"

    def wait(self) -> int:
        while self.read():
            pass
        return self.process.wait()


@contextlib.contextmanager
def on_a_terminal(arguments: list[str], cwd: Path, **environment: str) -> Iterator[Terminal]:
    terminal = Terminal(arguments, cwd, environment)
    try:
        yield terminal
    finally:
        if terminal.process.poll() is None:
            terminal.process.kill()
            terminal.process.wait()
        os.close(terminal.end)

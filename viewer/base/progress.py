"""How far something is that takes over a second: one line on a terminal, kept up to date; in a log a few lines.

A thread of its own writes, so that whoever works only notes a number, and time goes by on the screen even where what is
waited for (a compiler, a mesh library) says nothing.
"""

import sys
import threading
import time
from typing import TextIO

SHORT = 1.0  # seconds for which nothing is said on a terminal
LONG = 5.0  # and elsewhere: in a log, a line is there to stay
TICK = 0.2  # seconds between looks
STEP = 10  # percent between lines in a log
CLEAR = "\r\x1b[K"


class Progress:
    """While its context lasts: what is being done, the share of it that is, and the time left."""

    def __init__(self, doing: str, at_once: bool = False) -> None:
        self.terminal = sys.stderr.isatty()
        self.patience = 0.0 if at_once else SHORT if self.terminal else LONG
        self.writing = threading.Lock()
        self.over = threading.Event()
        self.shown = False  # a line that can be cleared
        self.say(doing)
        self.thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> "Progress":
        self.thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self.over.set()
        self.thread.join()
        self._clear()

    def say(self, doing: str) -> None:
        """Now something else begins, of which no share is known."""
        self.doing = doing
        self.began = self.told = time.perf_counter()
        self.share = 0.0
        self.logged = -1  # percent, of the last line in a log

    def __call__(self, share: float) -> None:
        """So much is done."""
        self.told = time.perf_counter()
        self.share = share

    def put(self, line: str, stream: TextIO | None = None) -> None:
        """A line that stays, on stderr where nothing else is said."""
        with self.writing:
            self._clear()
            print(line, file=stream or sys.stderr, flush=True)

    def line(self, now: float) -> str:
        """`render glass-ball 43 %, 12 s left`; without a share the time it has taken."""
        share = self.share
        if share == 0.0:
            passed = now - self.began
            return f"{self.doing} ({duration(passed)})" if passed >= SHORT else self.doing
        left = (self.told - self.began) * (1.0 - share) / share - (now - self.told)
        return f"{self.doing} {100 * share:.0f} %, {duration(max(0.0, left))} left"

    def _run(self) -> None:
        while True:
            now = time.perf_counter()
            if now - self.began >= self.patience:
                with self.writing:
                    self.show(now)
            if self.over.wait(TICK):
                return

    def show(self, now: float) -> None:
        """On a terminal in place of the line before; in a log where another tenth is done."""
        if self.terminal:
            self._write(CLEAR + self.line(now))
            self.shown = True
            return
        percent = int(100 * self.share) // STEP * STEP
        if percent > self.logged and self.share < 1.0:
            self.logged = percent
            self._write(f"{self.line(now)}\n")

    def _clear(self) -> None:
        if self.shown:
            self._write(CLEAR)
            self.shown = False

    def _write(self, text: str) -> None:
        sys.stderr.write(text)
        sys.stderr.flush()


def duration(seconds: float) -> str:
    """In the largest unit of which there are some."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 99.5 * 60 else f"{seconds / 3600:.0f} h"

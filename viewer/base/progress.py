"""The progress of work that takes more than a second: one line on a terminal that is updated, a few lines in a log.

A thread of its own writes the line. So a worker only stores a number, and the elapsed time is updated even while a
compiler or a library reports nothing.
"""

import sys
import threading
import time

from tracer.printable import printable
from viewer.base.streams import put, put_error, put_raw_error

SHORT = 1.0  # seconds before anything is shown on a terminal
LONG = 5.0  # the same elsewhere: a line in a log stays
TICK = 0.2  # seconds between updates
STEP = 10  # percent between lines in a log
CLEAR = "\r\x1b[K"


class Progress:
    """A context that shows what is being done, the share that is done, and the time left."""

    def __init__(self, doing: str, at_once: bool = False) -> None:
        self.terminal = sys.stderr is not None and sys.stderr.isatty()
        self.patience = 0.0 if at_once else SHORT if self.terminal else LONG
        self.writing = threading.Lock()
        self.over = threading.Event()
        self.shown = False  # whether there is a line to be cleared
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
        """Start another activity, whose progress is not known yet."""
        self.doing = doing
        self.began = self.told = time.perf_counter()
        self.share = 0.0
        self.logged = -1  # percent in the last line of a log

    def __call__(self, share: float) -> None:
        """Set the share that is done."""
        self.told = time.perf_counter()
        self.share = share

    def put(self, line: str) -> None:
        """Write a line that stays, to standard error."""
        with self.writing:
            self._clear()
            put_error(line)

    def put_result(self, line: str) -> None:
        """Write a line that stays, to standard output."""
        with self.writing:
            self._clear()
            put(f"{printable(line)}\n")

    def line(self, now: float) -> str:
        """For example `render glass-ball 43 %, 12 s left`; the time so far if no share is known."""
        share, doing = self.share, printable(self.doing)
        if share == 0.0:
            passed = now - self.began
            return f"{doing} ({duration(passed)})" if passed >= SHORT else doing
        left = (self.told - self.began) * (1.0 - share) / share - (now - self.told)
        return f"{doing} {100 * share:.0f} %, {duration(max(0.0, left))} left"

    def _run(self) -> None:
        while True:
            now = time.perf_counter()
            if now - self.began >= self.patience:
                with self.writing:
                    self.show(now)
            if self.over.wait(TICK):
                return

    def show(self, now: float) -> None:
        """Update the line on a terminal; in a log, write a line after every tenth."""
        if self.terminal:
            put_raw_error(CLEAR + self.line(now))
            self.shown = True
            return
        percent = int(100 * self.share) // STEP * STEP
        if percent > self.logged and self.share < 1.0:
            self.logged = percent
            put_error(self.line(now))

    def _clear(self) -> None:
        if self.shown:
            put_raw_error(CLEAR)
            self.shown = False


def duration(seconds: float) -> str:
    """A time in seconds, minutes or hours."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 99.5 * 60 else f"{seconds / 3600:.0f} h"

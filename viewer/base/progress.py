"""The progress of work that takes more than a second: one line on a terminal that is updated, a few lines in a log.

A thread of its own writes the line. So a worker only stores a number, and the elapsed time is updated even while a
compiler or a library reports nothing.
"""

import sys
import threading
import time
from collections.abc import Callable

from tracer.printable import printable
from viewer.base.streams import put, put_error, put_raw_error

SHORT = 1.0  # seconds before anything is shown on a terminal
LONG = 5.0  # seconds that an activity must have taken elsewhere: a line in a log stays
TICK = 0.2  # seconds between updates
TELLING = 0.1  # share that must be done before the time left is shown: the first parts are no fair sample
LONG_ENOUGH = 10.0  # seconds after which they are one, if a hundredth is done
STEP = 10  # percent between lines in a log
CLEAR = "\r\x1b[K"


class Progress:
    """A context that shows what is being done, the share that is done, and the time left."""

    def __init__(self, doing: str, at_once: bool = False, clock: Callable[[], float] = time.perf_counter) -> None:
        self.terminal = sys.stderr is not None and sys.stderr.isatty()
        self.patience = 0.0 if at_once else SHORT if self.terminal else LONG
        self.clock = clock
        self.writing = threading.Lock()
        self.over = threading.Event()
        self.shown = False  # whether there is a line to be cleared
        self.say(doing)
        self.entered = self.began
        self.thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> "Progress":
        self.thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self.over.set()
        self.thread.join()
        self._clear()

    def say(self, doing: str, only: str = "") -> None:
        """Start another activity, whose progress is not known yet.

        `only` says what the share and the time left are of, if they are not those of the whole work.
        """
        self.doing, self.only = doing, only
        self.began = self.told = self.clock()
        self.share = 0.0
        self.logged = -1  # percent in the last line of a log

    def __call__(self, share: float) -> None:
        """Set the share of the expected time that is done. A share of 0 says that the work begins only now."""
        self.told = self.clock()
        self.share = share
        if share == 0.0:
            self.began = self.told

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
        """For example `render glass-ball 43 %, 12 s left`; the time so far until enough is done to tell the rest."""
        passed, left, doing = now - self.began, self.left(now), printable(self.doing)
        share = f" {100 * self.share:.0f} %" if self.share >= 0.005 else ""
        if left is not None:
            only = f" {self.only}" if self.only else ""
            return f"{doing}{share}, {duration(left)} left{only}"
        return f"{doing}{share} ({duration(passed)})" if passed >= SHORT else f"{doing}{share}"

    def left(self, now: float) -> float | None:
        """The seconds that are left, at the mean speed so far; None if too little is done to tell.

        Until the next share is set, time passes. But a step that takes long never halves what was left before it.
        """
        share, passed = self.share, self.told - self.began
        if share < TELLING and (passed < LONG_ENOUGH or share < 0.1 * TELLING):
            return None
        left = passed * (1.0 - share) / share
        return max(0.5 * left, left - (now - self.told))

    def _run(self) -> None:
        while True:
            now = self.clock()
            if now - (self.entered if self.terminal else self.began) >= self.patience:
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

"""Ctrl-C and SIGTERM as an exception, so that half-done work is cleaned up.

A second signal ends the process at once.
"""

import contextlib
import os
import signal
import threading
from collections.abc import Iterator
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interrupted(KeyboardInterrupt):
    """The process was asked to end."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.status = 128 + number  # the exit status that shells report for a signal


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """Within this context, either signal raises Interrupted. A signal that is ignored from outside (nohup) stays
    ignored.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        for number in SIGNALS:
            if before[number] is not signal.SIG_IGN:
                signal.signal(number, _interrupt)
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _interrupt(number: int, frame: FrameType | None) -> None:
    for each in SIGNALS:
        signal.signal(each, _leave)
    raise Interrupted(number)


def _leave(number: int, frame: FrameType | None) -> None:
    os._exit(128 + number)

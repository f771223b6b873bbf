"""Ctrl-C and SIGTERM as an exception, so that whatever is half done is cleaned up on the way out.

The second one, should the way out take too long, ends the process where it stands.
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
        self.status = 128 + number  # as shells have it


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """While this lasts either signal raises Interrupted; one that is ignored from outside (nohup) stays so."""
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

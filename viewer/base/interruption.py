"""Ctrl-C and SIGTERM as an exception, so that half-done work is cleaned up.

A second signal ends the process at once.
"""

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Iterator
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)

# Functions that C code calls, glfw's and llvmlite's, and finalizers: an exception out of them is lost.
LOSING = {"callback_wrapper", "_raw_object_cache_notify", "_raw_object_cache_getbuffer", "__del__"}
AGAIN = 0.01  # seconds until a signal that arrived in such a function is raised again


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
    if _is_lost_in(frame):
        threading.Timer(AGAIN, _send_again, (number,)).start()
        return
    for each in SIGNALS:
        signal.signal(each, _leave)
    raise Interrupted(number)


def _send_again(number: int) -> None:
    """Send the signal to the main thread, which may sleep."""
    if sys.platform == "win32":
        signal.raise_signal(number)
    else:
        signal.pthread_kill(threading.main_thread().ident or 0, number)


def _is_lost_in(frame: FrameType | None) -> bool:
    """Whether an exception that is raised in this frame is lost on the way."""
    while frame:
        if frame.f_code.co_name in LOSING:
            return True
        frame = frame.f_back
    return False


def _leave(number: int, frame: FrameType | None) -> None:
    os._exit(128 + number)

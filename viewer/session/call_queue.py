"""Calls that background threads post to the window's thread, the only one that changes the session."""

from collections.abc import Callable
from queue import Empty, SimpleQueue

from viewer.session.guard import Guard

Call = Callable[[], object]


class CallQueue:
    """A queue of calls."""

    def __init__(self, guard: Guard, wake: Call = lambda: None) -> None:
        self.guard = guard
        self.wake = wake  # ends the window's sleep. Called from any thread
        self._calls: SimpleQueue[Call] = SimpleQueue()

    def post(self, call: Call = lambda: None) -> None:
        """Post `call` to the window's thread, which runs it before its next frame. Without a call, only a frame is
        drawn.
        """
        self._calls.put(call)
        self.wake()

    def run_posted(self) -> bool:
        """Run the calls that have been posted. Returns whether there were any."""
        some = False
        while True:
            try:
                call = self._calls.get_nowait()
            except Empty:
                return some
            self.guard.run("a task in the background", call, closes=False)
            some = True

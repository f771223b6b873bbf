"""The recursion of `tracer.whitted` for the picked pixel, line by line, in step with the depth-first steps of the tree.

Its run is recorded when it is asked for, in a thread of its own. A step of the tree sets the line, and a line the step.
"""

from collections.abc import Callable
from dataclasses import dataclass
from threading import Thread

from tracer.tree.raytree import RayTree
from viewer.base.cached import Changed
from viewer.explain.recursion import Recording, record
from viewer.figures.catalogue import RECURSION
from viewer.session.stepping.reveal import Place, Reveal


@dataclass(frozen=True)
class Line:
    """The line that was gone to last. It counts as long as the tree and the step are the same."""

    recording: Recording
    place: Place | None
    moment: int


class Recursion:
    """The recorded run, and the current line. Only the window's thread changes it."""

    def __init__(self, reveal: Reveal, post: Callable[[Callable[[], object]], object]) -> None:
        self.reveal, self.post = reveal, post
        self.tree: RayTree | None = None  # the one asked for last
        self.found: Recording | None = None  # the last one that was recorded
        self._begun = False  # whether the run for `tree` has been started, or waits for the end of another
        self._running: Thread | None = None
        self._line: Line | None = None
        self.scrolled = Changed()  # whether the source text has to scroll to another line

    # --- the record ---------------------------------------------------------------------------------------------------

    @property
    def recording(self) -> Recording | None:
        """The record of the tree on show; None until it has been asked for and made."""
        return self.found if self.found and self.found.tree is self.reveal.tree else None

    def ask(self) -> None:
        """Record the run for the tree on show. A run for another tree ends.

        Called in each frame that shows the recursion. It begins in the second frame of a tree, so that a pick is shown
        before, and while the mouse is dragged from pixel to pixel there is none.
        """
        if self.reveal.tree is not self.tree:
            self.tree, self._begun = self.reveal.tree, False
        elif not self._begun:
            self._begun = True
            self._start()

    def wait(self) -> None:
        """Wait until the run is recorded; the result comes with the next posted call."""
        if self._running is not None:
            self._running.join()

    def _start(self) -> None:
        tree = self.tree
        if self._running is not None or tree is None:
            return

        def work() -> None:
            try:
                found = record(tree, lambda: self.tree is tree)
            except Exception as error:  # by the page's plain formulas, in a degenerate scene
                found = Recording(tree, [], [], f"The run failed: {error!r}.")
            self.post(lambda: self._finish(tree, found))

        self._running = Thread(target=work, daemon=True, name="recursion")
        self._running.start()

    def _finish(self, tree: RayTree, found: Recording) -> None:
        self._running = None
        if tree is not self.tree:
            if self._begun:
                self._start()
        else:
            self.found = found

    # --- the current line ---------------------------------------------------------------------------------------------

    @property
    def moment(self) -> int | None:
        """The moment of the record that is on show: the line that was gone to last, or the first one of the current
        step. None without a depth-first step, without a record, and where it ends before this step.
        """
        recording, step = self.recording, self.reveal.step
        if not recording or not step or self.reveal.order != RECURSION:
            return None
        line = self._line
        if line and line.recording is recording and line.place == self.reveal.place:
            return line.moment
        return recording.find(min(step.current), step.sum is not None)

    def go(self, by: int) -> None:
        """Go `by` lines on, or back. Without a depth-first step, begin at the first line."""
        self.ask()
        recording, moment = self.recording, self.moment
        if self.reveal.order != RECURSION or not self.reveal.step:
            self.reveal.set_order(RECURSION)
            self.reveal.first()
        elif recording and recording.moments:
            last = len(recording.moments) - 1
            k = last if moment is None else min(max(moment + by, 0), last)
            self.reveal.show(recording.moments[k].row, recording.moments[k].sums)
            self._line = Line(recording, self.reveal.place, k)

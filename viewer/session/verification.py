"""The verification of the picked pixel's tree, in a thread of its own: a tree may take some tenths of a second.

It starts once no other pixel has been picked for a moment. The thread runs Python, which takes turns with the window's
thread: a pick would be shown later by some tens of milliseconds.
"""

import math
import time
from collections.abc import Callable
from threading import Thread

import tracer
from tracer.extras import MissingExtra
from tracer.tree.raytree import RayTree
from tracer.tree.verified.enclosures import VerifiedTree
from tracer.tree.verified.text import decisions_text
from viewer.base.wording import format_number

MOST_ROWS = 2000  # of a tree that the window verifies: about a second
REST = 0.2  # seconds without another pick


class Verification:
    """The verified form of one tree. Only the window's thread changes it."""

    def __init__(self, post: Callable[[Callable[[], object]], object]) -> None:
        self.post = post
        self.tree: RayTree | None = None  # the one asked for last
        self.found: VerifiedTree | None = None  # of `tree`
        self.failure = ""
        self._running: Thread | None = None
        self._asked = math.inf  # when `tree` was asked for, of time.monotonic; inf: it is started, or too large

    @property
    def is_running(self) -> bool:
        """Whether a tree is being verified, or is about to be."""
        return self._running is not None or self._asked < math.inf

    def wait(self) -> None:
        """Wait until the tree asked for is verified; the result comes with the next posted call."""
        self._start()
        if self._running is not None:
            self._running.join()

    def ask(self, tree: RayTree) -> None:
        """Verify this tree. Called again and again; one tree is verified at a time, the last one asked for."""
        if tree is not self.tree:
            self.tree, self.found = tree, None
            self._asked = time.monotonic() if len(tree) <= MOST_ROWS else math.inf
        elif time.monotonic() - self._asked >= REST:
            self._start()

    def _start(self) -> None:
        tree = self.tree
        if self._running is not None or tree is None or self._asked == math.inf:
            return
        self._asked = math.inf

        def work() -> None:
            found, failure = None, "not verified: the verification has failed"
            try:
                found, failure = tracer.verify(tree.world, tree), ""
            except MissingExtra:
                failure = "not verified: needs the extra raytree[verify]"
            finally:
                self.post(lambda: self._finish(tree, found, failure))

        self._running = Thread(target=work, daemon=True, name="verification")
        self._running.start()

    def _finish(self, tree: RayTree, found: VerifiedTree | None, failure: str) -> None:
        self._running, self.failure = None, failure
        if tree is self.tree:
            self.found = found

    def text(self, row: int) -> str:
        """The state in a sentence, with what is not certain of this row."""
        if self.tree is None:
            return ""
        if len(self.tree) > MOST_ROWS:
            return f"Not verified here: more than {MOST_ROWS} rays. See raytree trace --verify."
        if self.failure:
            return self.failure[0].upper() + self.failure[1:] + "."
        if self.found is None:
            return "The tree is being verified …"
        found = self.found
        doubts = found.rows[row].doubts if row < len(found.rows) else ()
        verified = "Verified" if found.certified == found.decisions else "Verified in part"
        if not doubts:
            others = [(self.tree.label(i), one.doubts[0]) for i, one in enumerate(found.rows) if one.doubts]
            open_ones = f" Not certified: {others[0][0]}, {others[0][1]}." if others else ""
            return f"{verified}: {accuracy_text(found)}, {decisions_text(found)}.{open_ones}"
        return f"{verified}: {accuracy_text(found)}, {decisions_text(found)}. Not certified here: {'; '.join(doubts)}."


def accuracy_text(found: VerifiedTree) -> str:
    """The width of the colour's enclosure, in words."""
    off = max(high - low for low, high in found.color)
    if math.isinf(off):
        return f"no upper end for the colour, because of the material {found.unbounded}"
    colour = "the colour, without the rays that were cut," if found.cut > 0.0 else "the colour"
    return f"{colour} is exact" if off == 0.0 else f"{colour} is known to within {format_number(off, 2)}"

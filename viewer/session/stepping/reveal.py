"""The tree on show, revealed step by step: its position, and an animation of it.

The position is a ray, not a number: the ray that appears, or whose hit is summed up, by its path. So another pixel,
depth, order or granularity goes to the step of the same ray, or of its nearest ancestor that the tree has; by level, to
the same level, or the deepest. The state is absolute: a step is the same however it was reached.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from tracer.tree.raytree import RayTree
from viewer.base.cached import Cached
from viewer.figures.catalogue import BREADTH, RECURSION
from viewer.figures.steps import Step, Steps, by_level, by_ray
from viewer.reopen.view_state import GRANULARITIES

LEVELS, RAYS = GRANULARITIES
ORDER_WORDS = {
    BREADTH: "breadth-first, as the kernel does it",
    RECURSION: "depth-first, as the recursive procedure does it",
}
SPEEDS = (0.5, 1.0, 2.0, 4.0, 8.0)  # steps per second


@dataclass(frozen=True)
class Place:
    """A step of any tree: the one on which a ray appears, or (`sums`) its hit is summed up."""

    path: str
    sums: bool

    @property
    def level(self) -> int:
        letters = self.path.partition(".")[0]
        return 0 if letters == "E" else len(letters)


class Reveal:
    """The steps of the tree on show, and the current one. Without a place, the whole tree is on show."""

    def __init__(self, tree: Callable[[], RayTree | None], has_lights: Callable[[], bool]) -> None:
        """`tree` returns the tree on show, and `has_lights` whether its shadow rays are drawn."""
        self._tree, self._has_lights = tree, has_lights
        self.place: Place | None = None
        self.asked: int | None = None  # the step to go to as soon as there is a tree
        self.granularity, self.order = LEVELS, BREADTH
        self.loops = False
        self.speed = SPEEDS[1]
        self.is_playing = False
        self._due = math.inf  # the time of the next step; -inf: it is set when the time is known
        self._steps: Cached[Steps] = Cached()
        self._step: Cached[Step] = Cached()

    # --- the current step ---------------------------------------------------------------------------------------------

    @property
    def tree(self) -> RayTree | None:
        """The tree on show."""
        return self._tree()

    @property
    def steps(self) -> Steps | None:
        """All steps of the tree on show."""
        tree, lights = self.tree, self._has_lights()
        if tree is None:
            return None

        def make() -> Steps:
            return by_level(tree, lights) if self.granularity == LEVELS else by_ray(tree, self.order, lights)

        return self._steps.get((tree, self.granularity, self.order, lights), make)

    @property
    def position(self) -> int | None:
        """The index of the current step; None if the whole tree is on show."""
        if self.place is None:  # the steps are made only if they are looked at
            return None
        steps = self.steps
        return self._find(steps, self.place) if steps else None

    @property
    def step(self) -> Step | None:
        """The current step; None if the whole tree is on show."""
        position = self.position
        steps = None if position is None else self.steps
        if not steps or position is None:
            return None
        return self._step.get((steps, position), lambda: steps[position])

    def _find(self, steps: Steps, place: Place) -> int:
        if self.granularity == LEVELS and not place.sums:
            return min(place.level, int(steps.tree.nodes["depth"].max()))
        path = place.path
        while True:
            row = steps.tree.find(path)
            found = None if row is None else steps.find(row, place.sums)
            if found is not None:
                return found
            path = path.partition(".")[0] if "." in path else path[:-1] or steps.tree.path(0)

    # --- going on -----------------------------------------------------------------------------------------------------

    def go(self, by: int) -> None:
        """Go `by` steps on, or back; not beyond the first and the last. A whole tree comes before the first step, and
        on the way back after the last one. An animation pauses.
        """
        self.pause()
        steps, position = self.steps, self.position
        if steps:
            before = (-1 if by > 0 else len(steps)) if position is None else position
            self.go_to(before + by)

    def go_to(self, position: int) -> None:
        """Go to a step, from 0; a negative number is the first, one that is too large the last."""
        steps = self.steps
        if steps:
            step = steps[min(max(position, 0), len(steps) - 1)]
            self.place = Place(steps.tree.path(max(step.current)), step.sum is not None)

    def ask(self, granularity: str | None, order: str | None, page: int | None) -> None:
        """Show this step of the next tree, or, without one, the whole tree. None of the others: as it is."""
        self.pause()
        self.place, self.asked = None, page
        if granularity:
            self.set_granularity(granularity)
        if order:
            self.set_order(order)

    def go_to_asked(self) -> None:
        """Go to the step that was asked for, if there is a tree now."""
        if self.asked is not None and self.steps:
            self.go_to(self.asked)
            self.asked = None

    def show(self, row: int, sums: bool) -> None:
        """Go to the step that adds a row of the tree on show, or with `sums` to the one that sums it up."""
        self.pause()
        if self.tree:
            self.place = Place(self.tree.path(row), sums)

    def first(self) -> None:
        self.pause()
        self.go_to(0)

    def last(self) -> None:
        self.pause()
        self.go_to(len(self.steps or ()) - 1)

    def leave(self) -> bool:
        """Show the whole tree. Returns whether it was not on show."""
        was_stepping = self.place is not None
        self.pause()
        self.place = None
        return was_stepping

    # --- how ----------------------------------------------------------------------------------------------------------

    def set_granularity(self, granularity: str) -> None:
        """By level or by ray. Levels are breadth-first."""
        self.granularity = granularity
        if granularity == LEVELS:
            self.order = BREADTH

    def set_order(self, order: str) -> None:
        """Breadth-first or depth-first. The latter is by ray."""
        self.order = order
        if order == RECURSION:
            self.granularity = RAYS

    def toggle_granularity(self) -> None:
        self.set_granularity(RAYS if self.granularity == LEVELS else LEVELS)

    def toggle_order(self) -> None:
        self.set_order(RECURSION if self.order == BREADTH else BREADTH)

    @property
    def words(self) -> str:
        """Granularity and order in words."""
        return f"steps by {self.granularity[:-1]}, {ORDER_WORDS[self.order]}"

    @property
    def speed_words(self) -> str:
        return f"{self.speed:g} steps per second"

    # --- the animation ------------------------------------------------------------------------------------------------

    def toggle_play(self) -> None:
        """Play from the current step on, or pause. From the last step on, and from the whole tree, it begins anew."""
        if self.is_playing:
            self.pause()
        elif self.steps:
            if self.position in (None, len(self.steps) - 1):
                self.go_to(0)
            self.is_playing, self._due = True, -math.inf

    def pause(self) -> None:
        self.is_playing, self._due = False, math.inf

    def change_speed(self, by: int) -> None:
        """The next faster speed, or with -1 the next slower one."""
        self.speed = SPEEDS[min(max(SPEEDS.index(self.speed) + by, 0), len(SPEEDS) - 1)]

    def toggle_loop(self) -> None:
        self.loops = not self.loops

    def advance(self, now: float) -> bool:
        """Go on with an animation at the time `now`, in seconds of any clock that does not go back. At most one step a
        call: after a delay, none is skipped. Returns whether the step has changed.
        """
        steps, position = self.steps, self.position
        if not self.is_playing or not steps or position is None or now < self._due:
            return False
        begins, self._due = self._due == -math.inf, now + 1.0 / self.speed
        if begins:
            return True  # the first step was set when it began
        if position < len(steps) - 1:
            self.go_to(position + 1)
        elif self.loops:
            self.go_to(0)
        else:
            self.pause()
        return True

    def wait(self, now: float) -> float:
        """Seconds until an animation goes on; inf if none is playing."""
        return max(0.0, self._due - now) if self.is_playing and self.steps else math.inf

"""The work of an image, cut into tiles: a tile is a pure function of it, whichever thread or machine computes it.

A `Task` is what all tiles of an image have in common; it travels to other processes once. Threads of this process write
their pixels into the image where they belong; other processes send them back.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple

import numpy as np

from tracer.compile.bundle import Bundle
from tracer.compile.jit import versions
from tracer.formulas.camera import View
from tracer.formulas.sampler import CENTER, Samples
from tracer.kernel.entry import NOTHING, Area, Begun, Counts, Workspace, run
from tracer.kernel.limits import Limits
from tracer.kernel.nodes import KINDS
from tracer.kernel.world import World
from tracer.tree.raytree import solids_at

TILE = 64  # pixels a side: some milliseconds of work, so that cancelling is quick and threads end together
COARSE_TO_FINE = (8, 4, 2, 1)  # steps of the passes of an image that is watched
SMALL_TILE = 16  # where trees are followed to a tolerance: a pixel may then take a second

Cancelled = Callable[[], bool]


def never() -> bool:
    return False


class Mismatch(RuntimeError):
    """A task has come to a process of other versions, which would trace other bits."""


def difference(ours: dict[str, str], theirs: dict[str, str]) -> str:
    """What is not the same there as here, for people; empty where all is."""
    if theirs == ours:
        return ""
    return ", ".join(
        f"{name} {theirs.get(name)} (here {ours[name]})" for name in ours if ours[name] != theirs.get(name)
    )


class Remote(Executor, ABC):
    """An executor whose calls run in other processes, and what can be done to make that cheap."""

    threads: int  # that can work for it at a time
    abandoned: Cancelled  # a function of a module, asked there: whether nobody waits for the call any more

    @abstractmethod
    def share(self, task: "Task") -> Any:
        """Send a task ahead; what is then to be given to each call in its place."""


@dataclass(frozen=True, eq=False)
class Task:
    """All that is needed to trace any tile of one image."""

    arrays: Bundle  # of the world
    view: View
    limits: Limits
    samples: Samples
    eye_solids: np.ndarray
    made_by: dict[str, str] = field(default_factory=versions)
    spaces: SimpleQueue[Workspace] = field(default_factory=SimpleQueue)  # of threads that are done with one

    def __reduce__(self) -> tuple[Any, ...]:
        return (_received, (self.arrays, self.view, self.limits, self.samples, self.eye_solids, self.made_by))


def _received(arrays: Bundle, view: View, limits: Limits, samples: Samples, eye_solids: np.ndarray, by: Any) -> Task:
    """What came over a wire may be read-only, for which the kernel would be compiled once more."""
    return Task(arrays, view, limits, samples, np.array(eye_solids), by)


class Traced(NamedTuple):
    """A finished tile."""

    area: Area
    counts: Counts
    pixels: np.ndarray | None  # None: they are where they belong


def trace_tiles(
    task: Task,
    areas: Sequence[Area],
    image: np.ndarray | None = None,
    cancelled: Cancelled = never,
    begun: Sequence[Begun] = (),
) -> list[Traced]:
    """Trace these tiles into the image or, without one, into arrays of their own; those that are finished.

    `begun`: of pixels that have samples already, tile by tile; with an image one, for all of it.
    """
    if found := difference(task.made_by, versions()):
        raise Mismatch(found)
    try:
        space = task.spaces.get_nowait()
    except Empty:
        space = Workspace(len(task.eye_solids))
    done = []
    for k, area in enumerate(areas):
        pixels, corner, before = image, (0, 0), begun[0 if image is not None else k] if begun else NOTHING
        if pixels is None:
            pixels = np.zeros((area.bottom - area.top, area.right - area.left, 4 if begun else 3))
            corner = (area.left, area.top)
        counts = None
        if not cancelled():
            counts = run(
                *(task.arrays, task.view, task.limits, task.samples, area, task.eye_solids),
                *(pixels, space, corner, before, cancelled),
            )
        if counts is None:
            break
        done.append(Traced(area, counts, pixels if image is None else None))
    task.spaces.put(space)
    return done


class Job:
    """An image in the making: what is to be traced, and the pixels so far.

    Of one whose pixels are `begun`, `pixels` are sums over samples (`kernel.entry.Begun`), where there are new ones.
    """

    begun: Begun | None = None

    def __init__(self, world: World, view: View, limits: Limits, samples: Samples = CENTER) -> None:
        self.view = view
        self.task = Task(world.arrays, view, limits, samples, solids_at(world, view.eye))
        self.pixels = np.zeros((view.height, view.width, 3))
        self.rays = np.zeros(len(KINDS), np.int64)
        self.tests = 0
        self.residuals: list[np.ndarray] = []
        self._shared: Any = None

    def shared_with(self, executor: Remote) -> Any:
        """The task as that executor's calls are given it; an image of several rounds sends it once."""
        if self._shared is None:
            self._shared = executor.share(self.task)
        return self._shared

    def ways_on(self, areas: Sequence[Area], here: bool) -> Sequence[Begun]:
        """What tiles have begun with, as `trace_tiles` takes it: elsewhere each needs its own part only."""
        if self.begun is None or here:
            return (self.begun,) if self.begun else ()
        sums, plan = self.begun
        parts = [np.s_[area.top : area.bottom, area.left : area.right] for area in areas]
        return [Begun(sums[part].copy(), plan[part].copy()) for part in parts]

    def keep(self, traced: Traced) -> None:
        """Take in a finished tile."""
        area = traced.area
        self.rays += traced.counts.rays
        self.tests += int(traced.counts.tests[0])
        self.residuals.append(traced.counts.residuals)
        if traced.pixels is not None:
            self.pixels[area.top : area.bottom, area.left : area.right] = traced.pixels

    def residual(self) -> dict[str, float]:
        """Of the weight that was cut: the largest of a pixel, and the mean."""
        total = math.fsum(figure[1] for figure in self.residuals)
        largest = float(max(figure[0] for figure in self.residuals))
        return {"max": largest, "mean": total / (self.view.width * self.view.height)}


def passes(width: int, height: int, steps: Sequence[int] = (1,), side: int = TILE) -> list[list[Area]]:
    """The tiles of an image, pass by pass; `steps` halve from one to the next, down to 1.

    Those of a coarse pass are larger by its step: there is as much to do in each of them as in a fine one's.
    """
    before = (0, *steps)
    return [tiles(width, height, side * step, step, traced) for step, traced in zip(steps, before, strict=False)]


def tiles(width: int, height: int, side: int, step: int, traced: int) -> list[Area]:
    """Those of one pass, in reading order."""
    return [
        Area(left, top, min(left + side, width), min(top + side, height), step, traced)
        for top in range(0, height, side)
        for left in range(0, width, side)
    ]

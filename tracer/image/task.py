"""The work of an image as functions of picklable data, for threads of this process or for other processes.

A `Task` is what all tiles of an image have in common. It is sent to other processes once.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple

import numpy as np

from tracer.compile.kernel_cache import versions
from tracer.formulas.camera import View
from tracer.formulas.sampler import Sampler
from tracer.image.film import Traced, write_pixels
from tracer.image.tiles import Tile, pixel_list
from tracer.kernel.arrays import Arrays
from tracer.kernel.entry import trace_list
from tracer.kernel.limits import Limits
from tracer.kernel.workspace import Eye, Workspace
from tracer.kernel.world import World

Cancelled = Callable[[], bool]


def never() -> bool:
    """For work that is never cancelled."""
    return False


class Mismatch(RuntimeError):
    """A task has come to a process with other versions, which would trace other bits."""


def difference(ours: dict[str, str], theirs: dict[str, str]) -> str:
    """The versions that differ, as text; empty if none does."""
    if theirs == ours:
        return ""
    return ", ".join(
        f"{name} {theirs.get(name)} (here {ours[name]})" for name in ours if ours[name] != theirs.get(name)
    )


@dataclass(frozen=True, eq=False)
class Task:
    """All that is needed to trace any tile of one image."""

    arrays: Arrays
    view: View
    limits: Limits
    sampler: Sampler
    eye: Eye
    made_by: dict[str, str] = field(default_factory=versions)
    workspaces: SimpleQueue[Workspace] = field(default_factory=SimpleQueue)  # unused workspaces, for the next call

    @staticmethod
    def of(world: World, view: View, limits: Limits, sampler: Sampler) -> "Task":
        """The task of a world's image."""
        return Task(world.arrays, view, limits, sampler, world.eye(view.eye))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_received, (self.arrays, self.view, self.limits, self.sampler, self.eye, self.made_by))


def _received(arrays: Arrays, view: View, limits: Limits, sampler: Sampler, eye: Eye, by: Any) -> Task:
    """Rebuild a task. Its arrays are copied: received ones may be read-only, which would compile other kernels."""
    return Task(arrays, view, limits, sampler, Eye(*map(np.array, eye)), by)


class Work(NamedTuple):
    """One tile to be traced, with the samples of its pixels as `pixel_list` takes them."""

    tile: Tile
    first: np.ndarray | int = 0
    end: np.ndarray | int = 1
    before: np.ndarray | None = None  # (height, width, 4): sums over the samples so far, of pixels that get more


class RemoteExecutor(Executor, ABC):
    """An executor whose calls run in other processes."""

    threads: int  # number of calls that can run at the same time
    abandoned: Cancelled  # a module-level function, called in the other process: whether the call was cancelled

    @abstractmethod
    def share(self, task: Task) -> Any:
        """Send a task to the other processes. Returns a handle to pass to calls."""


def shared(task: Task, executor: Executor) -> Any:
    """The task, or its handle for the calls of a RemoteExecutor."""
    return executor.share(task) if isinstance(executor, RemoteExecutor) else task


def trace_works(
    task: Task, works: Sequence[Work], image: np.ndarray | None = None, cancelled: Cancelled = never
) -> list[Traced]:
    """Trace tiles, and return those that are finished.

    With an `image` (height, width, 3), the colours go there; otherwise they are returned.
    """
    if found := difference(task.made_by, versions()):
        raise Mismatch(found)
    try:
        workspace = task.workspaces.get_nowait()
    except Empty:
        workspace = Workspace(task.eye)
    done = []
    for work in works:
        traced = None if cancelled() else _trace(task, work, image, workspace, cancelled)
        if traced is None:
            break
        done.append(traced)
    task.workspaces.put(workspace)
    return done


def _trace(
    task: Task, work: Work, image: np.ndarray | None, workspace: Workspace, cancelled: Cancelled
) -> Traced | None:
    tile = work.tile
    pixels = pixel_list(tile, work.first, work.end)
    before = None
    if work.before is not None:
        before = work.before[pixels["y"] - tile.top, pixels["x"] - tile.left]
    found = trace_list(task.arrays, task.view, task.limits, task.sampler, pixels, workspace, before, cancelled)
    if found is None:
        return None
    sums, counts = found
    if before is not None:
        return Traced(tile, counts, sums=sums)
    colors, left, top = image, 0, 0
    if colors is None:
        colors, left, top = np.zeros((tile.bottom - tile.top, tile.right - tile.left, 3)), tile.left, tile.top
    residual = write_pixels(pixels, sums, tile.step, left, top, colors)
    return Traced(tile, counts, residual, colors if image is None else None)

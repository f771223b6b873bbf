"""The image: every pixel's tree, tile by tile on a pool of threads, of each tree only the colour kept.

Tiles write disjoint pixels and no sum crosses a tile's border, so the image has the same bits for any number of threads
and any order of tiles. Passes from coarse to fine trace no pixel twice.
"""

import math
import os
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue

import numpy as np

from tracer.bound import brightest
from tracer.bvh import FLAT
from tracer.camera import View
from tracer.jit import is_compiled
from tracer.limits import MAX_NODES, Limits, make_limits
from tracer.nodes import KINDS
from tracer.scene import Material, Object, Scene
from tracer.shapes.sphere import Sphere
from tracer.tile import CENTER, Area, Samples, Workspace, run, trace_area
from tracer.tree import checked_size, solids_at, trace, words
from tracer.world import World, prepare

TILE = 64  # pixels a side: some milliseconds of work, so that cancelling is quick and threads end together
COARSE_TO_FINE = (8, 4, 2, 1)

Progress = Callable[[float], None]
Finished = Callable[[Area, float], None]
Cancelled = Callable[[], bool]


class Stopped(Exception):
    """The rendering was cancelled; its image is incomplete."""


@dataclass(eq=False, repr=False)
class Image:
    """A finished image and what it took."""

    pixels: np.ndarray  # (height, width, 3) float64, linear RGB
    seconds: dict[str, float]  # compile, trace
    rays: dict[str, int]  # traced, by kind
    residual: dict[str, float]  # max, mean over the pixels
    threads: int
    size: tuple[int, int]
    samples: int
    depth: int | None  # None: no limit but the tolerance
    tolerance: float | None
    bound: float  # no component of a pixel lacks more than this; infinite where nothing bounds it
    left_out: list[str]

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Image {width}x{height}: {sum(self.rays.values())} rays in {self.seconds['trace']:.3f} s>"


@dataclass(eq=False)
class Job:
    """An image in the making: what is to be traced, and the pixels so far."""

    world: World
    view: View
    limits: Limits
    samples: Samples = CENTER
    pixels: np.ndarray = field(init=False)
    rays: np.ndarray = field(init=False)
    residuals: dict[Area, np.ndarray] = field(init=False)
    eye_solids: np.ndarray = field(init=False)
    spaces: SimpleQueue[Workspace] = field(init=False)

    def __post_init__(self) -> None:
        self.pixels = np.zeros((self.view.height, self.view.width, 3))
        self.rays = np.zeros(len(KINDS), np.int64)
        self.residuals = {}
        self.eye_solids = solids_at(self.world, self.view.eye)
        self.spaces = SimpleQueue()

    def work(self, waiting: deque[Area], finished: SimpleQueue[Area | None], cancelled: Cancelled) -> Workspace:
        """Trace one waiting tile after another, on whatever thread; None is the last that `finished` is told."""
        try:
            space = self.spaces.get_nowait()
        except Empty:
            space = Workspace(words(self.world))
        try:
            while waiting and not cancelled():
                try:
                    area = waiting.popleft()
                except IndexError:  # another thread was faster
                    break
                residuals = space.arrays.residuals
                residuals[:] = 0.0
                run(self.world.arrays, self.view, self.limits, self.samples, area, self.eye_solids, self.pixels, space)
                self.residuals[area] = residuals.copy()
                finished.put(area)
        finally:
            finished.put(None)
        return space

    def keep(self, space: Workspace) -> None:
        """Add what a thread has counted; its workspace is free for the next."""
        self.rays += space.arrays.rays
        space.arrays.rays[:] = 0
        self.spaces.put(space)


def passes(width: int, height: int, steps: Sequence[int] = (1,)) -> list[list[Area]]:
    """The tiles of an image, pass by pass; `steps` halve from one to the next, down to 1."""
    before = (0, *steps)
    return [
        [
            Area(left, top, min(left + TILE, width), min(top + TILE, height), step, traced)
            for top in range(0, height, TILE)
            for left in range(0, width, TILE)
        ]
        for step, traced in zip(steps, before, strict=False)
    ]


def trace_passes(
    job: Job,
    all_passes: Sequence[Sequence[Area]],
    executor: Executor,
    threads: int,
    finished: Finished = lambda area, share: None,
    cancelled: Cancelled = lambda: False,
) -> None:
    """Trace the tiles of each pass in their order; Stopped where `cancelled` turns true.

    A pass begins when the one before has ended: a coarse square must not fall onto a finer one. `finished` is told of
    each tile and of the share done, on this thread.
    """
    total = sum(len(areas) for areas in all_passes)
    done = 0
    for areas in all_passes:
        waiting = deque(areas)
        news: SimpleQueue[Area | None] = SimpleQueue()
        workers = [executor.submit(job.work, waiting, news, cancelled) for _ in range(min(threads, len(areas)))]
        running = len(workers)
        try:
            while running:
                area = news.get()
                if area is None:
                    running -= 1
                else:
                    done += 1
                    finished(area, done / total)
        finally:
            waiting.clear()  # where this thread is interrupted the others are to end, too
        for worker in workers:
            job.keep(worker.result())
        if done < total and cancelled():
            raise Stopped


def render(
    world: World,
    size: tuple[int, int] | None = None,
    samples: int = 1,
    depth: int | None = None,
    threads: int | None = None,
    *,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    max_nodes: int = MAX_NODES,
    model: str | None = None,
    progress: Progress = lambda share: None,
    cancelled: Cancelled = lambda: False,
) -> Image:
    """The scene's image. Size, depth and model are the scene's by default, threads as many as there are processors.

    One sample is the pixel's centre; more are the mean of the sampler's first points. `progress` gets the finished
    share, and where `cancelled` turns true, Stopped is raised within a tile's time. With a `tolerance` the rays that a
    pixel lacks weigh no more than that in sum; the depth counts only if it is given.
    """
    if samples < 1:
        raise ValueError(f"samples must be >= 1, got {samples}")
    threads = threads or processors()
    compiling = warm()
    view = world.view(checked_size(size))
    limits = make_limits(world, depth, min_weight, tolerance, max_nodes, model, records=False)
    job = Job(world, view, limits, CENTER if samples == 1 else Samples(0, samples))
    began = time.perf_counter()
    with ThreadPoolExecutor(threads) as executor:
        trace_passes(
            job, passes(view.width, view.height), executor, threads, lambda area, share: progress(share), cancelled
        )
    tracing = time.perf_counter() - began
    figures = list(job.residuals.values())
    largest = float(max(figure[0] for figure in figures))
    return Image(
        pixels=job.pixels,
        seconds={"compile": compiling, "trace": tracing},
        rays={kind: int(n) for kind, n in zip(KINDS, job.rays, strict=True)},
        residual={
            "max": largest,
            "mean": math.fsum(figure[1] for figure in figures) / (view.width * view.height),
        },
        threads=threads,
        size=(view.width, view.height),
        samples=samples,
        depth=limits.depth if depth is not None or tolerance is None else None,
        tolerance=tolerance,
        bound=largest * brightest(world.scene) if largest > 0.0 else 0.0,
        left_out=world.left_out,
    )


def warm() -> float:
    """Get the kernel compiled, or loaded from the cache; the seconds it took, 0 where it was at hand."""
    if is_compiled(trace_area):
        return 0.0
    began = time.perf_counter()
    trace(prepare(_balls(1)), ray=((0.0, 0.0, 0.0), (0.0, 0.0, -1.0)))
    return time.perf_counter() - began


def fill_cache() -> None:
    """Compile everything that any scene may need, for later starts to load."""
    warm()
    prepare(_balls(FLAT + 1))


def _balls(count: int) -> Scene:
    return Scene(tuple(Object(Sphere((float(k), 0.0, -1.0), 0.5), Material()) for k in range(count)))


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

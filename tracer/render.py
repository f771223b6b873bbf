"""The image: every pixel's tree, tile by tile on a pool of threads or a cluster, of each tree only the colour kept.

Tiles write disjoint pixels and no sum crosses a tile's border, so the image has the same bits for any number of threads
and any order of tiles. Passes from coarse to fine trace no pixel twice.
"""

import math
import os
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass
from queue import SimpleQueue

import numpy as np

from tracer.bound import brightest
from tracer.jit import is_compiled
from tracer.job import SMALL_TILE, TILE, Cancelled, Job, Remote, Traced, never, passes, trace_tiles
from tracer.limits import MAX_NODES, make_limits
from tracer.nodes import KINDS
from tracer.sampler import SAMPLERS, SOBOL
from tracer.scene import Material, Object, Scene
from tracer.shapes.sphere import Sphere
from tracer.tile import Area, make_samples, trace_area
from tracer.tree import checked_size, trace
from tracer.world import World, prepare

BALL = Scene((Object(Sphere((0.0, 0.0, -1.0), 0.5), Material()),))  # what kernels are warmed up with
COARSE_TO_FINE = (8, 4, 2, 1)
AHEAD = 2  # calls a thread: one it works on, one that waits
MOST_TILES = 16  # that another process is sent at a time, for a message costs a millisecond
MOST_HERE = 8  # and a thread, for a call costs a tenth of that

Progress = Callable[[float], None]
Finished = Callable[[Area, float], None]


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


def trace_passes(
    job: Job,
    all_passes: Sequence[Sequence[Area]],
    executor: Executor,
    threads: int,
    finished: Finished = lambda area, share: None,
    cancelled: Cancelled = never,
) -> None:
    """Trace the tiles of each pass in their order; Stopped where `cancelled` turns true.

    A pass begins when the one before has ended: a coarse square must not fall onto a finer one. `finished` is told of
    each tile and of the share done, on this thread.
    """
    here = isinstance(executor, ThreadPoolExecutor)
    if not here and len(all_passes) > 1:
        raise ValueError("several passes need threads of this process: a finer pass leaves the pixels of a coarser one")
    total = sum(len(areas) for areas in all_passes)
    done = due = 0
    ended = threading.Event()  # where this thread is interrupted the others are to end, too
    task = executor.share(job.task) if isinstance(executor, Remote) else job.task
    if here:
        ways = (job.pixels, lambda: ended.is_set() or cancelled())
    else:
        ways = (None, executor.abandoned if isinstance(executor, Remote) else never)
    for areas in all_passes:
        due += len(areas)
        waiting = deque(shared_out(areas, threads, MOST_HERE if here else MOST_TILES))
        news: SimpleQueue[Future[list[Traced]]] = SimpleQueue()
        running: set[Future[list[Traced]]] = set()
        try:
            while True:
                if isinstance(executor, Remote):
                    threads = max(threads, executor.threads)
                while waiting and len(running) < AHEAD * threads and not cancelled():
                    future = executor.submit(trace_tiles, task, waiting.popleft(), *ways)
                    running.add(future)
                    future.add_done_callback(news.put)
                if not running:
                    break
                future = news.get()
                running.remove(future)
                for traced in future.result():
                    job.keep(traced)
                    done += 1
                    finished(traced.area, done / total)
        finally:
            if running:
                ended.set()
            for future in running:
                future.cancel()
        if done < due:
            raise Stopped


def shared_out(areas: Sequence[Area], threads: int, most: int) -> Iterator[Sequence[Area]]:
    """The tiles a call is given, fewer and fewer, so that all threads end together (guided self-scheduling:
    Polychronopoulos & Kuck, IEEE Trans. Computers 36(12), 1987)."""
    first = 0
    while first < len(areas):
        count = min(most, -(-(len(areas) - first) // (4 * threads)))
        yield areas[first : first + count]
        first += count


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
    sampler: str = SAMPLERS[SOBOL],
    executor: Executor | None = None,
    progress: Progress = lambda share: None,
    cancelled: Cancelled = never,
) -> Image:
    """The scene's image. Size, depth and model are the scene's by default, threads as many as there are processors.

    Tiles go to an `executor` where one is given, `threads` calls at a time: any of `concurrent.futures`, or a cluster
    (`tracer.cluster`). The pixels are the same.

    One sample is the pixel's centre; more are the mean of the sampler's first points: Sobol's, or at random, or
    jittered, whose number must be a square. `progress` gets the finished share, and where `cancelled` turns true,
    Stopped is raised within a tile's time. With a `tolerance` the rays that a pixel lacks weigh no more than that in
    sum; the depth counts only if it is given.
    """
    points = make_samples(samples, sampler)
    elsewhere = isinstance(executor, Remote)
    threads = threads or (executor.threads if elsewhere else processors())
    compiling = 0.0 if elsewhere else warm()
    view = world.view(checked_size(size))
    limits = make_limits(world, depth, min_weight, tolerance, max_nodes, model, records=False)
    job = Job(world, view, limits, points)
    began = time.perf_counter()
    tiles = passes(view.width, view.height, side=TILE if tolerance is None else SMALL_TILE)
    with nullcontext(executor) if executor else ThreadPoolExecutor(threads) as pool:
        trace_passes(job, tiles, pool, threads, lambda area, share: progress(share), cancelled)
    tracing = time.perf_counter() - began
    largest = float(max(figure[0] for figure in job.residuals))
    return Image(
        pixels=job.pixels,
        seconds={"compile": compiling, "trace": tracing},
        rays={kind: int(n) for kind, n in zip(KINDS, job.rays, strict=True)},
        residual={
            "max": largest,
            "mean": math.fsum(figure[1] for figure in job.residuals) / (view.width * view.height),
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
    trace(prepare(BALL), ray=((0.0, 0.0, 0.0), (0.0, 0.0, -1.0)))
    return time.perf_counter() - began


def fill_cache() -> None:
    """Compile everything that any scene may need, for later starts to load."""
    warm()
    prepare(BALL, hierarchy=True)


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

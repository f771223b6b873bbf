"""The image: every pixel's tree, tile by tile on a pool of threads or a cluster, of each tree only the colour kept."""

import math
import os
import time
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from numbers import Real

import numpy as np

from tracer.compile.jit import is_compiled
from tracer.formulas.sampler import JITTERED, SAMPLERS, SOBOL, make_samples
from tracer.image.converge import MAX_SAMPLES, ConvergingImage, RoundStats
from tracer.image.job import SMALL_TILE, TILE, Cancelled, Job, Remote, never, passes
from tracer.image.passes import Stopped, trace_passes
from tracer.kernel.entry import trace_area
from tracer.kernel.limits import MAX_NODES, make_limits
from tracer.kernel.nodes import KINDS
from tracer.kernel.world import World, prepare
from tracer.scene import Material, Object, Scene
from tracer.shapes.sphere import Sphere
from tracer.tree.bounds import radiance_bound
from tracer.tree.raytree import checked_size, trace

BALL = Scene((Object(Sphere((0.0, 0.0, -1.0), 0.5), Material()),))  # what kernels are warmed up with

Progress = Callable[[float], None]


@dataclass(eq=False, repr=False)
class Image:
    """A finished image and what it took."""

    pixels: np.ndarray  # (height, width, 3) float64, linear RGB
    seconds: dict[str, float]  # compile, trace
    rays: dict[str, int]  # traced, by kind
    tests: int  # of a ray against a surface
    residual: dict[str, float]  # max, mean over the pixels
    threads: int
    size: tuple[int, int]
    samples: int  # of a pixel; where they differ, the most
    depth: int | None  # None: no limit but the tolerance
    tolerance: float | None
    bound: float  # no component of a pixel lacks more than this for rays that were cut; infinite: nothing bounds it
    left_out: list[str]
    counts: np.ndarray | None = None  # (height, width) samples, where pixels have as many as their error asks for
    reached: RoundStats | None = None  # and how far they came
    ended: str = ""  # by what: "error", "seconds", or "samples" where no pixel could have any more

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Image {width}x{height}: {sum(self.rays.values())} rays in {self.seconds['trace']:.3f} s>"


@dataclass(frozen=True)
class Goal:
    """When an image that converges is good enough; whichever comes first."""

    error: float | None = None  # estimated: root mean square over pixels and components, linear
    seconds: float | None = None
    began: float = field(default_factory=time.perf_counter)

    def __post_init__(self) -> None:
        for name, value in (("until_error", self.error), ("until_seconds", self.seconds)):
            if value is not None and not (isinstance(value, Real) and 0.0 < value < math.inf):
                raise ValueError(f"{name} must be a number > 0, got {value!r}")

    def __bool__(self) -> bool:
        return self.error is not None or self.seconds is not None

    @property
    def is_late(self) -> bool:
        return self.seconds is not None and time.perf_counter() - self.began >= self.seconds

    def share(self, error: float) -> float:
        """How much is done; an edge's error falls as N^-3/4."""
        shares = [0.0]
        if self.error is not None and error >= self.error:
            shares.append((self.error / error) ** (4.0 / 3.0))
        if self.seconds is not None:
            shares.append((time.perf_counter() - self.began) / self.seconds)
        return min(1.0, max(shares))


def render(
    world: World,
    size: tuple[int, int] | None = None,
    samples: int | None = None,
    depth: int | None = None,
    threads: int | None = None,
    *,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    max_nodes: int = MAX_NODES,
    model: str | None = None,
    sampler: str = SAMPLERS[SOBOL],
    until_error: float | None = None,
    until_seconds: float | None = None,
    executor: Executor | None = None,
    progress: Progress = lambda share: None,
    cancelled: Cancelled = never,
) -> Image:
    """The scene's image. Size, depth and model are the scene's by default, threads as many as there are processors.

    Tiles go to an `executor` where one is given, `threads` calls at a time: any of `concurrent.futures`, or a cluster
    (`tracer.image.cluster`). The pixels are the same.

    One sample, the default, is the pixel's centre; more are the mean of the sampler's first points: Sobol's, or at
    random, or jittered, whose number must be a square. `until_error` and `until_seconds` give each pixel as many as its
    error asks for (`adaptive`), until that error is estimated for the image or so much time has passed, but
    `samples` of a pixel at most and two at least. With a `tolerance` the rays that a pixel lacks weigh no more than
    that in sum; the depth counts only if it is given. `progress` gets the finished share, and where `cancelled` turns
    true, Stopped is raised within a tile's time. ValueError for what can be none of these.
    """
    goal = Goal(until_error, until_seconds)
    points = make_samples(1 if goal else samples or 1, sampler)
    if goal and points.sampler == JITTERED:
        raise ValueError("jittered samples cannot be added to: an image that converges needs sobol or random ones")
    if goal and samples is not None and samples < 2:
        raise ValueError(f"samples must be >= 2 in an image that converges, got {samples}")
    elsewhere = isinstance(executor, Remote)
    threads = threads or (executor.threads if elsewhere else processors())
    compiling = 0.0 if elsewhere else warm()
    view = world.view(checked_size(size))
    limits = make_limits(world, depth, min_weight, tolerance, max_nodes, model, records=False)
    began = time.perf_counter()
    with nullcontext(executor) if executor else ThreadPoolExecutor(threads) as pool:
        if goal:
            made = ConvergingImage(world, view, limits, points.sampler, most=samples or MAX_SAMPLES)
            ended = _converge(made, replace(goal, began=began), pool, threads, progress, cancelled)
            job, pixels, residual, reached = made.job, made.sampled.means(), made.residual(), made.reached
        else:
            job, made, ended, reached = Job(world, view, limits, points), None, "", None
            tiles = passes(view.width, view.height, side=TILE if tolerance is None else SMALL_TILE)
            trace_passes(job, tiles, pool, threads, lambda area, share: progress(share), cancelled)
            pixels, residual = job.pixels, job.residual()
    return Image(
        pixels=pixels,
        seconds={"compile": compiling, "trace": time.perf_counter() - began},
        rays={kind: int(n) for kind, n in zip(KINDS, job.rays, strict=True)},
        tests=job.tests,
        residual=residual,
        threads=threads,
        size=(view.width, view.height),
        samples=reached.most if reached else points.count,
        depth=limits.depth if depth is not None or tolerance is None else None,
        tolerance=tolerance,
        bound=residual["max"] * radiance_bound(world.scene) if residual["max"] > 0.0 else 0.0,
        left_out=world.left_out,
        counts=made.sampled.counts if made else None,
        reached=reached,
        ended=ended,
    )


def _converge(
    made: ConvergingImage, goal: Goal, executor: Executor, threads: int, progress: Progress, cancelled: Cancelled
) -> str:
    """Round after round up to the goal; by what it ended. Time is up when it is, but every pixel has two samples."""

    def stops() -> bool:
        return cancelled() or (goal.is_late and made.sampled.counts.min() > 1)

    error = math.nan

    def told(*_: object) -> None:
        progress(goal.share(error))

    try:
        for reached in made.rounds(executor, threads, told, stops):
            error = reached.error
            if goal.error is not None and reached.error <= goal.error:
                return "error"
            if goal.is_late and reached.least > 1:
                return "seconds"
    except Stopped:
        if cancelled():
            raise
        return "seconds"
    return "samples"


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

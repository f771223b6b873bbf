"""Renders an image: traces every pixel's tree and keeps its colour."""

import math
import os
import time
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from numbers import Real

import numpy as np

from tracer.choices import JITTERED, SAMPLERS, SOBOL
from tracer.formulas.sampler import make_samples
from tracer.image.film import Film, Traced
from tracer.image.passes import Stopped, trace_passes
from tracer.image.progressive import MAX_SAMPLES, ProgressiveImage, RoundStats
from tracer.image.task import Cancelled, RemoteExecutor, Task, Work, never, shared
from tracer.image.tiles import scattered, tiles_of
from tracer.image.warmup import warm_up
from tracer.kernel.limits import BREADTH_FIRST, default_max_rays, image_max_nodes, make_limits
from tracer.kernel.nodes import KINDS
from tracer.kernel.world import World
from tracer.progress import Progress, ignore
from tracer.scene.radiance_bound import radiance_bound


@dataclass(eq=False, repr=False)
class Image:
    """A rendered image and its statistics."""

    pixels: np.ndarray  # (height, width, 3) float64, linear RGB
    seconds: dict[str, float]  # of "compile" and "trace"
    rays: dict[str, int]  # by kind
    tests: int  # ray-surface intersection tests
    residual: dict[str, float]  # weight that was cut: "max" of a pixel, "mean" over the pixels
    threads: int
    size: tuple[int, int]  # width, height
    samples: int  # per pixel; the maximum if they differ
    depth: int | None  # None: limited by the tolerance only
    tolerance: float | None  # of the weight that a pixel lacks
    missing_allowed: float | None  # of the light that a pixel lacks; `tolerance` follows from it
    max_rays: int | None  # the limit of rays in total; None: that of each tree was given
    max_nodes: int  # the limit of rows of each tree that follows: give it to `tracer.trace` for the tree of a pixel
    limited: int  # trees that this limit ended
    bound: float  # no component of a pixel lacks more than this because rays were cut; inf where there is no bound
    unbounded: str  # the material because of which there is no bound; empty if there is one
    left_out: list[str]  # capabilities that the scene does not need
    counts: np.ndarray | None = None  # (height, width) samples of each pixel, of an image that converged
    stats: RoundStats | None = None  # statistics of the last round, of an image that converged
    ended: str = ""  # what ended it: "error", "seconds", or "samples" if no pixel may have more

    @property
    def trees(self) -> int:
        """The number of trees: one for each sample of a pixel."""
        return self.size[0] * self.size[1] * self.samples if self.counts is None else int(self.counts.sum())

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Image {width}x{height}: {sum(self.rays.values())} rays in {self.seconds['trace']:.3f} s>"


@dataclass(frozen=True)
class Goal:
    """The stopping criterion of an image that converges: an error or a time, whichever is reached first."""

    error: float | None = None  # estimated root mean square over pixels and components, linear light
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
        """Whether the time is up."""
        return self.seconds is not None and time.perf_counter() - self.began >= self.seconds

    def share(self, error: float, growth: float = 1.0) -> float:
        """The share of the work that is done, if the error falls as N^-3/4, like that of an edge.

        `growth` is the number of samples now, relative to that when the error was estimated.
        """
        shares = [0.0]
        if self.error is not None and error >= self.error:
            shares.append((self.error / error) ** (4.0 / 3.0) * growth)
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
    missing: float | None = None,
    max_rays: int | None = None,
    max_nodes: int | None = None,
    model: str | None = None,
    sampler: str = SAMPLERS[SOBOL],
    until_error: float | None = None,
    until_seconds: float | None = None,
    executor: Executor | None = None,
    progress: Progress = ignore,
    cancelled: Cancelled = never,
) -> Image:
    """Render the scene's image.

    `size` (width, height), `samples`, `depth` and `model` are the scene's by default; `threads` as many as there are
    processors. With an `executor` (of `concurrent.futures`, or a `tracer.cluster`), the tiles are traced there,
    `threads` calls at a time. The pixels have the same bits.

    A pixel is the mean over the first `samples` points of the `sampler`; a single Sobol point is the pixel's centre.
    The number of jittered points must be a square. `until_error` and `until_seconds` give each pixel as many samples
    as its error asks for, until the image's estimated error is that low or so much time has passed; each gets two at
    least, and `samples` at most, or 4096 if that is not given: the scene's number does not count then.

    `min_weight` cuts rays whose largest weight is below it. With a `tolerance`, the weights of the rays that a pixel
    lacks sum up to no more than that; the depth is then limited only if it is given. With `missing` in its place, the
    light that a pixel lacks is no more than that in any channel.

    `max_rays` limits the rays of the image in total, which ends images of scenes that reflect without end. Every tree
    gets an equal share as its limit of rows, `Image.max_nodes`, before the first ray is traced. A share counts all
    shadow rays that a hit could have, and is at least one hit with its shadow rays. By default it is 10^10 for each
    sample that a pixel can get. `max_nodes` gives the limit of each tree itself.

    `progress` is called with the share that is done. If `cancelled` returns true, Stopped is raised after at most
    the time of one tile. ValueError for a value that is not allowed; MissingBoundError, a ValueError, for `missing`
    where the light of a ray has no bound.
    """
    goal = Goal(until_error, until_seconds)
    points = make_samples(1 if goal else world.scene.image.samples if samples is None else samples, sampler)
    if goal and points.sampler.kind == JITTERED:
        raise ValueError("until_error and until_seconds need sobol or random samples, got jittered")
    if goal and samples is not None and samples < 2:
        raise ValueError(f"samples must be >= 2 with until_error or until_seconds, got {samples}")
    elsewhere = isinstance(executor, RemoteExecutor)
    threads = threads or (executor.threads if elsewhere else processors())
    view = world.view(size)
    area, most = view.width * view.height, (samples or MAX_SAMPLES) if goal else points.count
    if max_rays is None and max_nodes is None:
        max_rays = default_max_rays(area, most)
    max_nodes = image_max_nodes(world, area, most, max_rays, max_nodes)
    limits = make_limits(world, depth, min_weight, tolerance, max_nodes, model, missing=missing, records=False)
    best_first = limits.tolerance != BREADTH_FIRST
    compiling = 0.0 if elsewhere else warm_up()
    began = time.perf_counter()
    with nullcontext(executor) if executor else ThreadPoolExecutor(threads) as pool:
        if goal:
            image = ProgressiveImage(world, view, limits, SAMPLERS.index(sampler), most=most)
            ended = _converge(image, replace(goal, began=began), pool, threads, progress, cancelled)
            totals, pixels, residual = image.totals, image.statistics.means(), image.residual()
            stats, counts = image.stats, image.statistics.counts
        else:
            film, ended, stats, counts = Film(view.width, view.height), "", None, None
            task = Task.of(world, view, limits, points.sampler)
            tiles = tiles_of(view.width, view.height, limits.depth)
            works = [Work(tile, points.first, points.first + points.count) for tile in scattered(tiles)]

            def finished(traced: Traced, share: float) -> None:
                film.add(traced)
                progress(share)

            trace_passes(shared(task, pool), [works], pool, threads, finished, film.pixels, cancelled)
            totals, pixels, residual = film.totals, film.pixels, film.residual()
    bound = radiance_bound(world.scene)
    return Image(
        pixels=pixels,
        seconds={"compile": compiling, "trace": time.perf_counter() - began},
        rays={kind: int(n) for kind, n in zip(KINDS, totals.rays, strict=True)},
        tests=totals.tests,
        residual=residual,
        threads=threads,
        size=(view.width, view.height),
        samples=stats.most if stats else points.count,
        depth=None if best_first and depth is None else limits.depth,
        tolerance=limits.tolerance if best_first else None,
        missing_allowed=missing,
        max_rays=max_rays,
        max_nodes=limits.max_nodes,
        limited=totals.limited,
        bound=max(bound.missing(residual["max"])),
        unbounded=bound.reason,
        left_out=world.left_out,
        counts=counts,
        stats=stats,
        ended=ended,
    )


def _converge(
    image: ProgressiveImage, goal: Goal, executor: Executor, threads: int, progress: Progress, cancelled: Cancelled
) -> str:
    """Trace rounds until the goal is reached. Returns what ended it. Every pixel gets at least two samples."""
    error, samples = math.nan, 1

    def is_over() -> bool:
        return cancelled() or (goal.is_late and image.statistics.counts.min() > 1)

    def finished(*_: object) -> None:
        progress(goal.share(error, image.statistics.counts.sum() / samples))

    try:
        for stats in image.rounds(executor, threads, finished, is_over):
            error, samples = stats.error, image.statistics.counts.sum()
            if goal.error is not None and stats.error <= goal.error:
                return "error"
            if goal.is_late and stats.least > 1:
                return "seconds"
    except Stopped:
        if cancelled():
            raise
        return "seconds"
    return "samples"


def processors() -> int:
    """The number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

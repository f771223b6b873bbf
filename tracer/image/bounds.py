"""Guaranteed bounds of every pixel of an image: the verified tree of each sample, and the most that its cut rays bring.

The bounds hold for the mean of the samples' exact colours. How far that mean is from the mean over the whole pixel is
the sampling error: it can only be estimated, stands beside the bounds, and is no part of them.
"""

import math
import os
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context, parent_process
from multiprocessing.synchronize import Event
from threading import Thread
from typing import Any

import numpy as np

from tracer.choices import SAMPLERS, SOBOL
from tracer.formulas.sampler import CENTER, make_samples
from tracer.image.passes import Stopped
from tracer.image.task import Cancelled, never
from tracer.image.warmup import warm_up
from tracer.kernel.limits import image_max_nodes
from tracer.kernel.world import World, prepare
from tracer.processes import safe_path
from tracer.progress import Progress, ignore
from tracer.scene import Scene
from tracer.tree.trace import trace
from tracer.tree.verified.balls import flint
from tracer.tree.verified.verified import verify

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


@dataclass(eq=False, repr=False)
class Bounds:
    """Bounds of an image, and how they were reached."""

    low: np.ndarray  # (height, width, 3) float64, linear RGB
    high: np.ndarray  # inf where no bound is known
    decisions: int
    certified: int  # of the decisions
    sampling_error: float  # estimated root mean square over pixels and channels, as of independent samples; nan for one
    seconds: float
    samples: int
    max_nodes: int

    def __repr__(self) -> str:
        height, width, _ = self.low.shape
        return f"<Bounds {width}x{height}: {self.certified} of {self.decisions} decisions certified>"


def render_bounds(
    world: World,
    size: tuple[int, int] | None = None,
    samples: int | None = None,
    depth: int | None = None,
    processes: int = 1,
    *,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    missing: float | None = None,
    max_rays: int | None = None,
    model: str | None = None,
    sampler: str = SAMPLERS[SOBOL],
    progress: Progress = ignore,
    cancelled: Cancelled = never,
) -> Bounds:
    """Bounds of the image that `tracer.render` makes with the same arguments. Slow: about 0.3 ms for each ray.

    With several `processes`, the calling module must be importable, as `multiprocessing` asks for. MissingExtra if
    python-flint is not installed; ValueError as of `tracer.render`; Stopped if `cancelled` returns true.
    """
    flint()
    began = time.perf_counter()
    view, points = world.view(size), make_samples(world.scene.image.samples if samples is None else samples, sampler)
    max_nodes = image_max_nodes(world, view.width * view.height, points.count, max_rays)
    options: dict[str, Any] = {
        "size": (view.width, view.height),
        "depth": depth,
        "min_weight": min_weight,
        "tolerance": tolerance,
        "missing": missing,
        "max_nodes": max_nodes,
        "model": model,
        "sampler": sampler,
        "samples": points.count,
    }
    numbers = (None,) if points.sampler.kind == CENTER else range(points.count)
    low, high = (np.zeros((view.height, view.width, 3)) for _ in range(2))
    decisions = certified = 0
    variances: list[float] = []
    order = spread(view.height)
    with row_maker(world, processes, options, numbers, cancelled) as rows:
        progress(0.0)  # only now: processes take seconds to start
        for done, (y, row) in enumerate(zip(order, rows(order), strict=True), 1):
            low[y], high[y] = row.low, row.high
            decisions, certified = decisions + row.decisions, certified + row.certified
            variances.append(row.variance)
            progress(done / view.height)
            if cancelled():
                raise Stopped
    error = math.sqrt(math.fsum(variances) / low.size) if points.count > 1 else math.nan
    return Bounds(low, high, decisions, certified, error, time.perf_counter() - began, points.count, max_nodes)


def spread(height: int) -> list[int]:
    """The rows of an image in an order whose first ones, however many, are spread evenly over it. So the share of the
    rows that are done is about the share of the work. The order is that of the multiples of the golden ratio, modulo 1.
    """
    return sorted(range(height), key=lambda y: y * GOLDEN % 1.0)


@dataclass
class Row:
    """One row of pixels."""

    low: np.ndarray  # (width, 3)
    high: np.ndarray
    decisions: int
    certified: int
    variance: float  # of the means, summed over pixels and channels


@contextmanager
def row_maker(
    world: World, processes: int, options: dict[str, Any], numbers: Sequence[int | None], cancelled: Cancelled
) -> Iterator[Any]:
    """A function of the numbers of rows that gives these rows in this order, made here or in other processes."""
    if processes == 1:
        yield lambda order: map(partial(bound_row, world, options, numbers, cancelled), order)
        return
    processes_of = get_context("spawn")
    with safe_path():
        stop = processes_of.Event()

    with ProcessPoolExecutor(processes, processes_of, _prepare, (world.scene, options, numbers, stop)) as pool:
        try:
            with safe_path():
                list(pool.map(_started, range(processes)))
            yield lambda order: pool.map(_row, order)
        except BaseException:
            stop.set()  # a row may take minutes
            pool.shutdown(cancel_futures=True)
            raise


_here: dict[str, Any] = {}  # in a process that makes rows: the function that its calls share


def _prepare(scene: Scene, options: dict[str, Any], numbers: Sequence[int | None], stop: Event) -> None:
    Thread(target=_end_with_parent, daemon=True).start()
    warm_up()
    _here["row"] = partial(bound_row, prepare(scene), options, numbers, stop.is_set)


def _end_with_parent() -> None:
    """End this process when its parent has ended, however that was."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _started(_: int) -> None:
    """Do nothing: once this was called, a process has started."""


def _row(y: int) -> Row:
    return _here["row"](y)


def bound_row(world: World, options: dict[str, Any], numbers: Sequence[int | None], stopped: Cancelled, y: int) -> Row:
    """The bounds of row y: of each pixel, the means of its samples' lowest and highest colours, rounded outwards.

    Stopped if `stopped` returns true.
    """
    width = options["size"][0]
    row = Row(np.zeros((width, 3)), np.zeros((width, 3)), 0, 0, 0.0)
    for x in range(width):
        lows, highs, colors = [], [], []
        for number in numbers:
            if stopped():
                raise Stopped
            tree = trace(world, (x, y), sample=number, **options)
            found = verify(world, tree)
            row.decisions += found.decisions
            row.certified += found.certified
            lows.append([low for low, _ in found.color])
            pairs = zip(found.color, found.missing, strict=True)
            highs.append([math.nextafter(high + more, math.inf) for (_, high), more in pairs])
            colors.append(tree.radiance)
        row.low[x] = [mean_beyond(c, -math.inf) for c in zip(*lows, strict=True)]
        row.high[x] = [mean_beyond(c, math.inf) for c in zip(*highs, strict=True)]
        if len(numbers) > 1:
            row.variance += float(np.var(colors, axis=0, ddof=1).sum()) / len(numbers)
    np.maximum(row.low, 0.0, out=row.low)
    return row


def mean_beyond(numbers: Sequence[float], side: float) -> float:
    """The mean, rounded towards `side`, which is infinite: never short of the exact mean.

    Sum and quotient are each rounded by half a unit of their own last place, in all by less than two units of the
    mean's.
    """
    mean = math.fsum(numbers) / len(numbers)
    return math.nextafter(math.nextafter(mean, side), side)

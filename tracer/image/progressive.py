"""Progressive rendering: each round estimates errors, selects pixels and samples them, until an error or a time is
reached.

A round may be stopped between two tiles; the finished ones count.
"""

import math
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from typing import Any, NamedTuple

from tracer.formulas.camera import View
from tracer.formulas.sampler import Sampler
from tracer.image.adaptive import PixelStatistics
from tracer.image.film import Totals, Traced
from tracer.image.passes import Finished, trace_passes
from tracer.image.task import Cancelled, Task, never, shared
from tracer.image.tiles import SMALL_SIDE, make_tiles
from tracer.kernel.limits import Limits
from tracer.kernel.world import World

MAX_SAMPLES = 4096  # of a pixel, unless asked otherwise
SIDE = 2 * SMALL_SIDE  # of a tile: pixels that get many samples lie together


class RoundStats(NamedTuple):
    """The state of an image after a round."""

    seconds: float  # of tracing and choosing
    rays: int  # of all kinds
    samples: float  # mean per pixel
    least: int  # smallest number of samples of a pixel
    most: int
    error: float  # estimated root mean square over pixels and components, linear light; NaN: not known yet


class ProgressiveImage:
    """An image that gets more samples in each round: in the pixels with the largest errors, or in all."""

    def __init__(
        self,
        world: World,
        view: View,
        limits: Limits,
        sampler: int,
        adaptive: bool = True,
        most: int = MAX_SAMPLES,
    ) -> None:
        self.world, self.view, self.limits = world, view, limits
        self.sampler, self.most = sampler, most
        self.statistics = PixelStatistics(view.width, view.height, sampler, adaptive)
        self.totals = Totals()
        self.tiles = make_tiles(view.width, view.height, SIDE)
        self.seconds = 0.0
        self._sent: tuple[Any, Any] = (None, None)  # the grid of jittered points, and the task as the executor has it

    @property
    def stats(self) -> RoundStats:
        """The state so far."""
        counts = self.statistics.counts
        rays = int(self.totals.rays.sum())
        return RoundStats(
            self.seconds, rays, float(counts.mean()), int(counts.min()), int(counts.max()), self.statistics.error
        )

    def rounds(
        self,
        executor: Executor,
        threads: int,
        finished: Finished = lambda traced, share: None,
        cancelled: Cancelled = never,
    ) -> Iterator[RoundStats]:
        """Trace rounds until no pixel gets more samples. Raises Stopped if `cancelled` returns true."""
        while True:
            began = time.perf_counter()
            if not self.statistics.plan_round(self.most):
                return

            def add_tile(traced: Traced, share: float) -> None:
                self.totals.add(traced.counts)
                assert traced.sums is not None
                self.statistics.update(traced.tile, traced.sums)
                finished(traced, share)

            try:
                works = self.statistics.works(self.tiles)
                trace_passes(self._task(executor), [works], executor, threads, add_tile, cancelled=cancelled)
            finally:
                self.seconds += time.perf_counter() - began
            yield self.stats

    def _task(self, executor: Executor) -> Any:
        """The task of this round. Only jittered points need a new one, for their finer grid."""
        side = math.isqrt(int(self.statistics.wanted.max())) if self.statistics.restarts else 1
        if self._sent[0] != side:
            task = Task.of(self.world, self.view, self.limits, Sampler(self.sampler, side))
            self._sent = (side, shared(task, executor))
        return self._sent[1]

    def residual(self) -> dict[str, float]:
        """The weight that was cut: the largest of a pixel, and the mean over the pixels."""
        lost = self.statistics.sums[..., 3] / self.statistics.counts
        return {"max": float(lost.max()), "mean": float(lost.mean())}

"""An image that converges, round by round: estimate, choose, sample, until an error or a time is reached, or forever.

A round may be broken off between two tiles: those that are finished count.
"""

import math
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from typing import NamedTuple

import numpy as np

from tracer.formulas.camera import View
from tracer.formulas.sampler import Samples
from tracer.image.adaptive import PixelStatistics, unfinished_tiles
from tracer.image.job import SMALL_TILE, Cancelled, Job, never, tiles
from tracer.image.passes import Finished, trace_passes
from tracer.kernel.entry import Area
from tracer.kernel.limits import Limits
from tracer.kernel.world import World

MAX_SAMPLES = 4096  # samples of a pixel, where no one asks for more or fewer
SIDE = 2 * SMALL_TILE  # of a tile: pixels with many samples lie together


class RoundStats(NamedTuple):
    """How far an image has come."""

    seconds: float  # of tracing and choosing
    rays: int  # of all kinds
    samples: float  # a pixel, in the mean
    least: int
    most: int
    error: float  # estimated: root mean square over pixels and components, in linear light; NaN: not yet known


class ConvergingImage:
    """An image that gets more samples from round to round: where its error is, or everywhere."""

    def __init__(
        self, world: World, view: View, limits: Limits, sampler: int, adaptive: bool = True, most: int = MAX_SAMPLES
    ) -> None:
        self.world, self.view, self.limits = world, view, limits
        self.sampler, self.most = sampler, most
        self.sampled = PixelStatistics(view.width, view.height, sampler, adaptive)
        self.job = self._job(1)
        self.all = tiles(view.width, view.height, SIDE, 1, 0)
        self.seconds = 0.0

    def _job(self, side: int) -> Job:
        job = Job(self.world, self.view, self.limits, Samples(0, 1, self.sampler, side))
        job.pixels = np.zeros((self.view.height, self.view.width, 4))
        return job

    @property
    def reached(self) -> RoundStats:
        counts = self.sampled.counts
        rays = int(self.job.rays.sum())
        return RoundStats(
            self.seconds, rays, float(counts.mean()), int(counts.min()), int(counts.max()), self.sampled.error
        )

    def rounds(
        self,
        executor: Executor,
        threads: int,
        finished: Finished = lambda area, share: None,
        cancelled: Cancelled = never,
    ) -> Iterator[RoundStats]:
        """Round after round, until nothing is to be gained. Stopped where `cancelled` turns true."""
        while True:
            began = time.perf_counter()
            begun = self.sampled.next(self.most)
            if begun is None:
                return
            plan = begun.plan
            if self.sampled.renews:
                before, self.job = self.job, self._job(math.isqrt(int(plan[..., 1].max())))
                self.job.rays, self.job.tests = before.rays, before.tests
            self.job.begun = begun

            def take_in(area: Area, share: float, plan: np.ndarray = plan) -> None:
                self.sampled.take_in(area, plan, self.job.pixels)
                finished(area, share)

            try:
                trace_passes(self.job, [unfinished_tiles(self.all, plan)], executor, threads, take_in, cancelled)
            finally:
                self.seconds += time.perf_counter() - began
            yield self.reached

    def residual(self) -> dict[str, float]:
        """Of the weight that was cut: the largest of a pixel, and the mean."""
        lost = self.sampled.sums[..., 3] / self.sampled.counts
        return {"max": float(lost.max()), "mean": float(lost.mean())}

"""Renders the image in the background: coarse at once, then finer. An outdated image is stopped within a tile.

If pixels have several samples, their centres are shown first, and then the mean of the samples, tile by tile.
"""

import os
import threading
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Container, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from tracer.formulas.sampler import PIXEL_CENTER, make_samples
from tracer.image.film import Traced
from tracer.image.passes import Stopped, trace_passes
from tracer.image.progressive import SIDE, ProgressiveImage, RoundStats
from tracer.image.render import processors
from tracer.image.task import Task, Work
from tracer.image.tiles import COARSE_TO_FINE, Tile, make_passes
from tracer.kernel.limits import Limits
from tracer.kernel.world import World
from viewer.base.srgb import srgb

Job = tuple[World, Limits, tuple[int, int]]  # an image: its world, the limits of its trees, its size

BLACK = (0, 0, 0, 255)
MAX_KEPT = 12  # finished images, so that stepping the depth back and forth shows them at once
NICENESS = 10  # of rendering threads, so that the window has priority


@dataclass(eq=False)
class Picture:
    """One image, finished or not."""

    shown: np.ndarray  # 8-bit sRGB (height, width, 4), opaque: graphics cards take this format as it is
    pixels: np.ndarray  # linear RGB (height, width, 3); finished, the mean of `samples` samples
    samples: int = 1  # of a pixel; 1: its centre
    share: float = 0.0  # of its tiles that are finished, over all passes
    seconds: float = 0.0
    max_nodes: int = 0  # the limit of rows of each of its trees
    limited: int = 0  # trees that this limit ended
    cancelled: threading.Event = field(default_factory=threading.Event)
    tiles: list[Tile] = field(default_factory=list)  # finished so far, for those who show what is new
    is_endless: bool = False  # it is refined until it is stopped
    follows: bool = False  # another one, which is seen until its tiles are there

    @property
    def is_blank(self) -> bool:
        """Whether there is nothing to see yet."""
        return not (self.tiles or self.follows)

    @property
    def finished(self) -> bool:
        return self.share >= 1.0

    @property
    def is_preview(self) -> bool:
        """Whether it shows pixel centres, in part or everywhere, until the mean of the samples is there."""
        return self.samples > 1 and not self.finished and not self.is_endless

    @property
    def least_refined(self) -> int:
        """The number of samples from which on a refined pixel is shown: fewer look worse than what is shown already."""
        return max(2, self.samples)


class ImageRenderer:
    """Renders one image at a time. Finished ones are kept as long as their world is shown."""

    def __init__(self, finished: Callable[[], object] = lambda: None) -> None:
        self.finished = finished  # called in another thread when an image ends
        self.progress: Callable[[], object] = lambda: None  # called in another thread after each tile
        self.picture: Picture | None = None
        self.kept: OrderedDict[Job, Picture] = OrderedDict()
        self.threads = processors()
        self.pool = ThreadPoolExecutor(self.threads, initializer=lower_priority)
        self.runner = ThreadPoolExecutor(1)
        self.running: Future[None] | None = None
        self.ahead: deque[Job] = deque()  # images to render while no other is
        self.aside: tuple[Job, Picture, Future[None]] | None = None  # that of them which renders
        self.lock = threading.Lock()  # of the two

    def show(self, world: World, limits: Limits, size: tuple[int, int]) -> None:
        """Show this image: at once if it is kept, otherwise as it renders. The image in progress is dropped."""
        job = (world, limits, size)
        self.pause()
        if job in self.kept:
            self.kept.move_to_end(job)
            self.picture = self.kept[job]
            return
        with self.lock:
            aside, self.aside = self.aside, None
            if aside and aside[0] == job:
                _, self.picture, self.running = aside
                return
            if aside:
                aside[1].cancelled.set()
            self.picture = _new_picture(job, self.picture)
            self.running = self.runner.submit(self._render, self.picture, job)

    def prepare(self, jobs: Iterable[Job]) -> None:
        """Render these images when no other is, so that they are kept when they are to be shown."""
        with self.lock:
            self.ahead = deque(job for job in jobs if job not in self.kept)
        self.runner.submit(self._go_ahead)

    def _go_ahead(self) -> None:
        """Start the next image that is rendered ahead. Called in the runner's thread."""
        with self.lock:
            while self.ahead and self.aside is None:
                job = self.ahead.popleft()
                if job not in self.kept:
                    picture = _new_picture(job, None)
                    self.aside = (job, picture, self.runner.submit(self._render, picture, job))

    def refine(self, image: ProgressiveImage, picture: Picture, noted: Callable[[RoundStats | None], None]) -> None:
        """Continue an image that converges, and show it, until it is paused or another image is shown.

        `noted` is called in another thread after each round, with None once no pixel gets more samples.
        """
        self.pause()
        picture.cancelled, picture.share = threading.Event(), 0.0
        self.picture = picture
        self.running = self.runner.submit(self._refine, image, picture, picture.cancelled, noted)

    def pause(self) -> None:
        """Stop the image in progress."""
        if self.picture and not self.picture.finished:
            self.picture.cancelled.set()

    def forget(self, keeping: Container[World] = ()) -> None:
        """Drop the images, for another world, except those of some worlds."""
        if self.picture:
            self.picture.cancelled.set()
        self.picture = None
        with self.lock:
            self.ahead.clear()
            if self.aside and self.aside[0][0] not in keeping:
                self.aside[1].cancelled.set()
                self.aside = None
            for job in [job for job in self.kept if job[0] not in keeping]:
                del self.kept[job]

    def wait(self) -> None:
        """Wait until the shown image is finished, unless it is endless."""
        if self.running and self.picture and not self.picture.finished and not self.picture.is_endless:
            self.running.result()

    def close(self) -> None:
        self.forget()
        self.runner.shutdown()
        self.pool.shutdown()

    def _render(self, picture: Picture, job: Job) -> None:
        world, limits, (width, height) = job
        pixels = picture.pixels
        if picture.cancelled.is_set():
            return
        began = time.perf_counter()
        stages = [(PIXEL_CENTER, make_passes(width, height, COARSE_TO_FINE))]
        if picture.samples > 1:
            stages.append((make_samples(picture.samples), make_passes(width, height, side=SIDE)))
        total, done = sum(points.count for points, _ in stages), 0

        def finished(traced: Traced, share: float) -> None:
            _show(picture, traced.tile, pixels[traced.tile.part])
            picture.seconds = time.perf_counter() - began
            picture.limited += int(traced.counts.limited[0])
            picture.tiles.append(traced.tile)
            picture.share = (done + share * points.count) / total
            self.progress()

        try:
            for points, passes in stages:
                picture.limited = 0
                task = Task.of(world, world.view((width, height)), limits, points.sampler)
                works = [[Work(tile, points.first, points.first + points.count) for tile in tiles] for tiles in passes]
                trace_passes(task, works, self.pool, self.threads, finished, pixels, picture.cancelled.is_set)
                done += points.count
        except Stopped:
            return
        if not picture.cancelled.is_set():
            self.kept[job] = picture
            while len(self.kept) > MAX_KEPT:
                self.kept.popitem(last=False)
            self.finished()
            with self.lock:
                if self.aside and self.aside[1] is picture:
                    self.aside = None
            self._go_ahead()

    def _refine(
        self,
        image: ProgressiveImage,
        picture: Picture,
        cancelled: threading.Event,
        noted: Callable[[RoundStats | None], None],
    ) -> None:
        before = image.seconds
        began = time.perf_counter()

        def finished(traced: Traced, share: float) -> None:
            part = traced.tile.part
            sums, counts = image.statistics.sums[part], image.statistics.counts[part]
            enough = counts >= picture.least_refined
            if enough.any():
                mean = sums[..., :3] / np.maximum(counts, 1)[..., None]
                _show(picture, traced.tile, np.where(enough[..., None], mean, picture.pixels[part]))
                picture.tiles.append(traced.tile)
            picture.seconds = before + time.perf_counter() - began
            picture.limited = image.totals.limited
            picture.share = min(share, 0.999)
            self.progress()

        try:
            for stats in image.rounds(self.pool, self.threads, finished, cancelled.is_set):
                noted(stats)
            noted(None)
        except Stopped:
            pass
        if picture.cancelled is cancelled:  # otherwise it has been continued since
            picture.share = 1.0
            self.finished()


def _new_picture(job: Job, before: Picture | None) -> Picture:
    """An image to be rendered. Until its first tiles are there, the image before is shown: a black one would flash."""
    world, limits, (width, height) = job
    follows = before is not None and before.shown.shape == (height, width, 4) and not before.is_blank
    shown = before.shown.copy() if before and follows else np.full((height, width, 4), BLACK, np.uint8)
    pixels, samples = np.zeros((height, width, 3)), world.scene.image.samples
    return Picture(shown, pixels, samples, max_nodes=limits.max_nodes, follows=follows)


def _show(picture: Picture, tile: Tile, linear: np.ndarray) -> None:
    """Encode the pixels that a tile's pass has traced, each over the square that it stands for."""
    height, width = linear.shape[:2]
    traced = srgb(linear[:: tile.step, :: tile.step])
    picture.shown[tile.part][..., :3] = traced.repeat(tile.step, 0).repeat(tile.step, 1)[:height, :width]


def lower_priority() -> None:
    """Lower the priority of this thread, on systems where threads have one.

    Relative to the process, since a process that was started with a low priority may not raise it.
    """
    if hasattr(os, "setpriority") and os.uname().sysname == "Linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), os.getpriority(os.PRIO_PROCESS, 0) + NICENESS)

"""The image as it renders: coarse at once, then finer, on threads of its own; stopped within a tile when outdated."""

import os
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from tracer.image.converge import ConvergingImage, RoundStats
from tracer.image.job import COARSE_TO_FINE, Job, passes
from tracer.image.passes import Stopped, trace_passes
from tracer.image.render import processors
from tracer.kernel.entry import Area
from tracer.kernel.limits import Limits
from tracer.kernel.world import World
from viewer.base.pictures import srgb

BLACK = (0, 0, 0, 255)
KEPT = 8  # finished images, so that stepping the depth back and forth shows them at once


@dataclass(eq=False)
class Picture:
    """One image, finished or not."""

    job: Job
    shown: np.ndarray  # 8-bit sRGB (height, width, 4): opaque, a form that graphics cards take as it is
    share: float = 0.0  # of its tiles, over all passes
    seconds: float = 0.0
    cancelled: threading.Event = field(default_factory=threading.Event)
    tiles: list[Area] = field(default_factory=list)  # finished so far, for whoever shows what is new
    endless: bool = False  # gets finer for as long as it may

    @property
    def finished(self) -> bool:
        return self.share >= 1.0


class Progressive:
    """Renders one image at a time; finished ones are kept for as long as their world is on show."""

    def __init__(self, changed: Callable[[], None] = lambda: None) -> None:
        self.changed = changed  # called from another thread when there is more to see
        self.picture: Picture | None = None
        self.kept: OrderedDict[tuple, Picture] = OrderedDict()
        self.threads = processors()
        self.pool = ThreadPoolExecutor(self.threads, initializer=_step_back)
        self.runner = ThreadPoolExecutor(1)
        self.last: object = None

    def show(self, world: World, limits: Limits, size: tuple[int, int]) -> None:
        """Make this the image to be seen: at once where it is kept, else begin it and drop the one in the making."""
        key = (id(world), limits, size)
        self.pause()
        if key in self.kept:
            self.kept.move_to_end(key)
            self.picture = self.kept[key]
            return
        job = Job(world, world.view(size), limits)
        picture = Picture(job, np.full((size[1], size[0], 4), BLACK, np.uint8))
        self.picture = picture
        self.last = self.runner.submit(self._run, picture, key)

    def refine(self, made: ConvergingImage, picture: Picture, noted: Callable[[RoundStats | None], None]) -> None:
        """Go on with an image that converges, as the one to be seen, until another is to be seen or it is paused.

        `noted` is told, on another thread, how far each round has come; None: nothing more is to be gained.
        """
        self.pause()
        picture.cancelled, picture.share = threading.Event(), 0.0
        self.picture = picture
        self.last = self.runner.submit(self._refine, made, picture, picture.cancelled, noted)

    def pause(self) -> None:
        """Stop what is being rendered where it is."""
        if self.picture and not self.picture.finished:
            self.picture.cancelled.set()

    def forget(self) -> None:
        """Drop every image: another world is on show."""
        if self.picture:
            self.picture.cancelled.set()
        self.picture = None
        self.kept.clear()

    def wait(self) -> None:
        """Until the image to be seen is finished, if it ever is."""
        if self.picture and not self.picture.finished and not self.picture.endless:
            self.last.result()  # type: ignore[attr-defined]

    def close(self) -> None:
        self.forget()
        self.runner.shutdown()
        self.pool.shutdown()

    def _run(self, picture: Picture, key: tuple) -> None:
        if picture.cancelled.is_set():
            return
        began = time.perf_counter()
        width, height = picture.job.view.width, picture.job.view.height

        def finished(area: Area, share: float) -> None:
            _show(picture, area, _part(picture.job.pixels, area))
            picture.seconds = time.perf_counter() - began
            picture.tiles.append(area)
            picture.share = share
            self.changed()

        try:
            trace_passes(
                picture.job,
                passes(width, height, COARSE_TO_FINE),
                self.pool,
                self.threads,
                finished,
                picture.cancelled.is_set,
            )
        except Stopped:
            return
        if not picture.cancelled.is_set():
            self.kept[key] = picture
            while len(self.kept) > KEPT:
                self.kept.popitem(last=False)

    def _refine(
        self,
        made: ConvergingImage,
        picture: Picture,
        cancelled: threading.Event,
        noted: Callable[[RoundStats | None], None],
    ) -> None:
        before = made.seconds
        began = time.perf_counter()

        def finished(area: Area, share: float) -> None:
            sums, counts = _part(made.sampled.sums, area), _part(made.sampled.counts, area)
            if counts.min() > 1:  # the first samples are worse than the centres that are seen already
                _show(picture, area, sums[..., :3] / counts[..., None])
                picture.tiles.append(area)
            picture.seconds = before + time.perf_counter() - began
            picture.share = min(share, 0.999)
            self.changed()

        try:
            for reached in made.rounds(self.pool, self.threads, finished, cancelled.is_set):
                noted(reached)
            noted(None)
        except Stopped:
            pass
        if picture.cancelled is cancelled:  # and it has not been gone on with since
            picture.share = 1.0
            self.changed()


def _part(image: np.ndarray, area: Area) -> np.ndarray:
    return image[area.top : area.bottom, area.left : area.right]


def _show(picture: Picture, area: Area, linear: np.ndarray) -> None:
    """Encode the pixels that this tile's pass has traced, each over the square that it stands for."""
    step = area.step
    height, width = area.bottom - area.top, area.right - area.left
    traced = srgb(linear[::step, ::step])
    _part(picture.shown, area)[..., :3] = traced.repeat(step, 0).repeat(step, 1)[:height, :width]


def _step_back() -> None:
    """Let the window go first: a lower priority for this thread, where the system has one for threads.

    Lower than the process has: one that was started with a low priority may not raise it.
    """
    if hasattr(os, "setpriority") and os.uname().sysname == "Linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), os.getpriority(os.PRIO_PROCESS, 0) + 10)

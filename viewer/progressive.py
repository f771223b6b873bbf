"""The image as it renders: coarse at once, then finer, on threads of its own; stopped within a tile when outdated."""

import os
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from tracer.job import COARSE_TO_FINE, Job, passes
from tracer.limits import Limits
from tracer.passes import Stopped, trace_passes
from tracer.render import processors
from tracer.tile import Area
from tracer.world import World
from viewer.picture import srgb

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
        if self.picture and not self.picture.finished:
            self.picture.cancelled.set()
        if key in self.kept:
            self.kept.move_to_end(key)
            self.picture = self.kept[key]
            return
        job = Job(world, world.view(size), limits)
        picture = Picture(job, np.full((size[1], size[0], 4), BLACK, np.uint8))
        self.picture = picture
        self.last = self.runner.submit(self._run, picture, key)

    def forget(self) -> None:
        """Drop every image: another world is on show."""
        if self.picture:
            self.picture.cancelled.set()
        self.picture = None
        self.kept.clear()

    def wait(self) -> None:
        """Until the image to be seen is finished."""
        if self.picture and not self.picture.finished:
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
            _show(picture, area)
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


def _show(picture: Picture, area: Area) -> None:
    """Encode the pixels that this tile's pass has traced, each over the square that it stands for."""
    step = area.step
    height, width = area.bottom - area.top, area.right - area.left
    inside = np.s_[area.top : area.bottom, area.left : area.right]
    traced = srgb(picture.job.pixels[inside][::step, ::step])
    picture.shown[inside][..., :3] = traced.repeat(step, 0).repeat(step, 1)[:height, :width]


def _step_back() -> None:
    """Let the window go first: a lower priority for this thread, where the system has one for threads.

    Lower than the process has: one that was started with a low priority may not raise it.
    """
    if hasattr(os, "setpriority") and os.uname().sysname == "Linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), os.getpriority(os.PRIO_PROCESS, 0) + 10)

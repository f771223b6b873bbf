"""Loads scenes in the background, and again when their files are saved."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import tracer
from tracer.formats import UP_AXES
from tracer.kernel.world import World
from tracer.printable import shown_path
from viewer.base.files import Unusable
from viewer.lessons.lesson import Lesson, read_file
from viewer.session.call_queue import CallQueue
from viewer.session.file_watch import FileWatch
from viewer.session.warmup import Warmup


class Opening(NamedTuple):
    """A scene to open, with depth, pixel and model; None: the value of the lesson or of the scene."""

    path: Path
    lesson: Lesson | None = None
    depth: int | None = None
    pixel: tuple[int, int] | None = None
    model: str | None = None
    up: str = UP_AXES[0]
    selection: str | None = None  # the path of the ray to select
    is_return: bool = False  # to a place that was looked at before


class SceneLoader:
    """Loads one scene at a time. A later one takes the place of an earlier one that is not loaded yet."""

    def __init__(
        self,
        calls: CallQueue,
        warmup: Warmup,
        loaded: Callable[[World, Opening], object],
        failed: Callable[[list[str]], object],
    ) -> None:
        self.calls, self.warmup = calls, warmup
        self.loaded, self.failed = loaded, failed  # called in the window's thread
        self.opening: Opening | None = None  # the last one, with success or not
        self.loading: Future[World] | None = None
        self.worker = ThreadPoolExecutor(1)
        self.watch = FileWatch()

    def open(
        self,
        path: Path,
        lesson: Lesson | None = None,
        depth: int | None = None,
        pixel: tuple[int, int] | None = None,
        model: str | None = None,
        up: str = UP_AXES[0],
    ) -> None:
        """Load a scene in the background. The scene on show stays until it is there, or if it has faults."""
        if lesson:
            depth = lesson.depth if depth is None else depth
            pixel = pixel or lesson.pixel
        self.load(Opening(path, lesson, depth, pixel, model, up))

    def load(self, opening: Opening) -> None:
        """`open`, where depth and pixel are those of the opening, whatever the lesson says."""
        self.opening = opening
        self.watch.follow(opening.path)
        if opening.lesson:
            self.watch.follow_also([opening.lesson.path])
        if self.loading:
            self.loading.cancel()

        def load() -> World:
            if not self.warmup.ready and self.warmup.compiles:
                self.warmup.wait()  # the kernels that prepare a large scene are being compiled as well
            return tracer.prepare(tracer.load(opening.path, up=opening.up))

        self.loading = self.worker.submit(load)
        self.loading.add_done_callback(lambda loading: self.calls.post(lambda: self._finish(loading, opening)))

    def reload(self) -> None:
        """Load the last scene again, with its lesson."""
        if not self.opening:
            return
        lesson = self.opening.lesson
        try:
            lesson = lesson and read_file(lesson.path)
        except Unusable as unusable:
            self.failed(list(unusable.faults))
            return
        path = lesson.scene if lesson else self.opening.path
        self.load(self.opening._replace(path=path, lesson=lesson))

    def look(self) -> None:
        """Load the scene again if one of its files has been saved. Called before every frame."""
        if self.watch.changed():
            self.reload()
        elif lost := self.watch.lost():
            self.calls.post(lambda: self.failed([f"{shown_path(lost)}: the file is gone"]))

    def _finish(self, loading: Future[World], opening: Opening) -> None:
        if loading is not self.loading:
            return  # another scene has been opened since
        self.loading = None
        try:
            world = loading.result()
        except tracer.SceneError as error:
            self.watch.follow_also(error.files)
            self.failed(error.faults)
        except Exception as error:  # a bug must not end the program: it is reported, and the last scene stays
            self.failed([f"{type(error).__name__}: {error}"])
        else:
            self.watch.follow_also(world.scene.files)
            self.loaded(world, opening)

    def close(self) -> None:
        self.worker.shutdown(wait=False, cancel_futures=True)

"""Loads scenes in the background, and again when their files are saved."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import tracer
from tracer.kernel.world import World
from tracer.printable import shown_path
from viewer.base.files import Unusable
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.moments import sweep_share, view_of
from viewer.reopen.places import is_figure
from viewer.reopen.scene_files import SceneFiles, scene_files
from viewer.reopen.view_state import UNCHANGED, ViewState, merged
from viewer.session.call_queue import CallQueue
from viewer.session.loading.file_watch import FileWatch
from viewer.session.loading.opening import Opening, SceneKey
from viewer.session.loading.prepared import PreparedScenes
from viewer.session.restore.figure_scene import FigureScenes
from viewer.session.restore.view import complete
from viewer.session.warmup import Warmup


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
        self.loading: Future[tuple[World, Opening]] | None = None
        self.worker = ThreadPoolExecutor(1)
        self.watch = FileWatch()
        self.figures = FigureScenes()
        self.prepared = PreparedScenes()
        self.preparing: list[SceneKey] = []  # in the worker

    def open(self, path: Path, lesson: Lesson | None = None, state: ViewState = UNCHANGED) -> None:
        """Load a scene, or that of a figure, in the background. The scene on show stays until it is there, or if it
        has faults.
        """
        self.load(Opening(path, lesson, state))

    def load(self, opening: Opening) -> None:
        """Load a scene in the background. A lesson opens on its own pixel and depth, if the state has none."""
        try:
            if not opening.is_return:
                opening = replace(opening, state=with_lesson(opening.state, opening.lesson))
        except Unusable as unusable:
            self._fail(list(unusable.faults), opening)
            return
        self.opening = opening
        self.prepared.leave_others(opening)
        self._follow(opening)
        if self.loading:
            self.loading.cancel()

        self.loading = None
        ready = self.prepared.find(opening) if opening.lesson else None
        if ready:
            self.opening = replace(opening, files=ready.opening.files)
            self.watch.follow_also(ready.world.scene.files)
            self.loaded(ready.world, self.opening)
            return

        def load() -> tuple[World, Opening]:
            if not self.warmup.ready and self.warmup.compiles:
                self.warmup.wait()  # the kernels that prepare a large scene are being compiled as well
            return self._load(self._read(opening) if is_figure(opening.path) else opening)

        self.loading = self.worker.submit(load)
        self.loading.add_done_callback(lambda loading: self.calls.post(lambda: self._finish(loading, opening)))

    def prepare(self, opening: Opening, then: Callable[[World], object]) -> None:
        """Prepare a scene in the background, for when it is opened. One that has faults is left for then."""
        key = opening.scene_key
        if key in self.preparing:
            return
        self.preparing.append(key)

        def work() -> None:
            try:
                world, found = self._load(opening)
            except Exception:
                self.calls.post(lambda: self.preparing.remove(key))
                return
            self.calls.post(lambda: keep(found, world))

        def keep(found: Opening, world: World) -> None:
            self.preparing.remove(key)
            self.prepared.add(found, world)
            then(world)

        self.worker.submit(work)

    @staticmethod
    def _load(opening: Opening) -> tuple[World, Opening]:
        """The scene of an opening, ready to be traced, and the opening with the content of its files."""
        scene = tracer.load(opening.path, up=opening.up, changes=opening.changes)
        home = opening.files.folder if opening.figure and opening.files else None
        files = scene_files(scene, opening.lesson.path if opening.lesson else None, home)
        return tracer.prepare(scene), replace(opening, files=files)

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
        again = replace(self.opening, lesson=lesson, sets_view=False, note="", instead=None)
        before, after = self.opening.step, again.step
        if before and after and before.state != after.state:  # the lesson's author has changed it
            state = replace(view_of(after, again.share), at=again.state.at, swept=again.state.swept)
            again = replace(again, state=state, sets_view=True, shows_stage=True)
        self.load(again.at_its_step())

    def look(self) -> None:
        """Load the scene again if one of its files has been saved. Called before every frame."""
        if self.watch.changed():
            self.reload()
        elif lost := self.watch.lost():
            self.calls.post(lambda: self.failed([f"{shown_path(lost)}: the file is gone"]))

    def _read(self, opening: Opening) -> Opening:
        """The opening of a figure's scene. The state that was asked for goes before that of the figure."""
        found = self.figures.find(opening.path)
        state = merged(complete(found.state), opening.state)
        files = SceneFiles(found.home, "") if found.copy_of else None
        opened = Opening(
            found.path, found.lesson, state, sets_view=True, figure=found.copy_of, files=files, note=found.note
        )
        return opened.at_its_step()

    def _follow(self, opening: Opening) -> None:
        """Look at the files of an opening that are known before it is read."""
        self.watch.follow(opening.path)
        if opening.lesson:
            self.watch.follow_also(opening.lesson.files)

    def _finish(self, loading: "Future[tuple[World, Opening]]", opening: Opening) -> None:
        if loading is not self.loading:
            return  # another scene has been opened since
        self.loading = None
        try:
            world, found = loading.result()
        except tracer.SceneError as error:
            self.watch.follow_also(error.files)
            self._fail(error.faults, opening)
        except Unusable as unusable:
            self._fail(list(unusable.faults), opening)
        except Exception as error:  # a bug must not end the program: it is reported, and the last scene stays
            self._fail([f"{type(error).__name__}: {error}"], opening)
        else:
            self.opening = found
            if found.path != opening.path:
                self._follow(found)
            self.watch.follow_also(world.scene.files)
            if found.lesson and not found.figure:
                self.prepared.add(found, world)
            self.loaded(world, found)

    def _fail(self, faults: list[str], opening: Opening) -> None:
        if opening.instead:
            self.load(replace(opening.instead, note=f"{opening.instead.note}{faults[0]}"))
        else:
            self.failed(faults)

    def close(self) -> None:
        self.worker.shutdown(wait=False, cancel_futures=True)
        self.figures.close()


def with_lesson(state: ViewState, lesson: Lesson | None) -> ViewState:
    """The state, with what the lesson's step asks for where the state has nothing. Raises Unusable for a step that the
    lesson does not have. Only a step that is asked for decides on how it is looked at.
    """
    if lesson is None:
        return state
    number = state.at[0] if state.at else 1
    if number > len(lesson.steps):
        raise Unusable(f"{shown_path(lesson.path)}: --at must be within 1 .. {len(lesson.steps)}, got {number}")
    step = lesson.steps[number - 1]
    if state.swept is not None and not (state.at and step.state.sweep):
        raise Unusable(f"{shown_path(lesson.path)}: --swept is for a step with a sweep, as --at {number} is not")
    asked = view_of(step, sweep_share(step, state))
    if not state.at:
        asked = ViewState(pixel=asked.pixel, sample=asked.sample, depth=asked.depth, model=asked.model)
    elif state.panels:
        asked = replace(asked, beside=None)
    return merged(asked, state)

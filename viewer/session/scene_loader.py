"""Loads scenes in the background, and again when their files are saved."""

from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import tracer
from tracer.kernel.world import World
from tracer.printable import shown_path
from viewer.base.files import Unusable
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.moments import Moment, view_of
from viewer.lessons.step import Step
from viewer.reopen.places import is_figure
from viewer.reopen.scene_files import SceneFiles, scene_files
from viewer.reopen.view_state import UNCHANGED, ViewState, merged
from viewer.session.call_queue import CallQueue
from viewer.session.file_watch import FileWatch
from viewer.session.restore.figure_scene import FigureScenes
from viewer.session.restore.view import complete
from viewer.session.warmup import Warmup


@dataclass(frozen=True)
class Opening:
    """A scene to open, and the state of its view; what is None there is the lesson's or the scene's own."""

    path: Path  # of the scene; of a figure until it is read
    lesson: Lesson | None = None
    state: ViewState = UNCHANGED
    is_return: bool = False  # to a place that was looked at before
    shows_stage: bool = False  # of the reveal of the lesson's step, after the presses that the state says
    sets_view: bool = False  # the state is taken over even if the scene is on show already
    figure: Path | None = None  # whose copy of the scene this is
    files: SceneFiles | None = None  # the content of the scene's files, when it is loaded
    note: str = ""  # a notice for when it is shown
    instead: "Opening | None" = None  # what to open if this cannot be loaded; its note is followed by the reason

    @property
    def up(self) -> str:
        """The axis of a mesh file that points upwards."""
        return self.state.up

    @property
    def step(self) -> Step | None:
        """The step of the lesson."""
        return self.lesson and self.lesson.step_at(self.moment.step)

    @property
    def moment(self) -> Moment:
        """The place in the lesson."""
        step, press = self.state.at or (1, 0)
        return Moment(step - 1, press)

    @property
    def changes(self) -> Mapping[str, Any]:
        """The values of the scene that the step replaces."""
        return self.step.state.set if self.step else {}

    def is_of(self, other: "Opening") -> bool:
        """Whether both open the same scene with the same values."""
        return (self.path, self.up, self.changes) == (other.path, other.up, other.changes)


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
        if opening.step:
            opening = replace(opening, path=opening.step.scene)
        self.opening = opening
        self._follow(opening)
        if self.loading:
            self.loading.cancel()

        def load() -> tuple[World, Opening]:
            if not self.warmup.ready and self.warmup.compiles:
                self.warmup.wait()  # the kernels that prepare a large scene are being compiled as well
            found = self._read(opening) if is_figure(opening.path) else opening
            scene = tracer.load(found.path, up=found.up, changes=found.changes)
            home = found.files.folder if found.figure and found.files else None
            files = scene_files(scene, found.lesson.path if found.lesson else None, home)
            return tracer.prepare(scene), replace(found, files=files)

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
        again = replace(self.opening, lesson=lesson, sets_view=False, note="", instead=None)
        before, after = self.opening.step, again.step
        if before and after and before.state != after.state:  # the lesson's author has changed it
            again = replace(again, state=replace(view_of(after), at=again.state.at), sets_view=True, shows_stage=True)
        self.load(again)

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
        return replace(opened, path=opened.step.scene) if opened.step else opened

    def _follow(self, opening: Opening) -> None:
        """Look at the files of an opening that are known before it is read."""
        self.watch.follow(opening.path)
        if opening.lesson:
            self.watch.follow_also([opening.lesson.path])

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
    lesson does not have. Only a step that is asked for decides on the panels.
    """
    if lesson is None:
        return state
    number = state.at[0] if state.at else 1
    if number > len(lesson.steps):
        raise Unusable(f"{shown_path(lesson.path)}: --at must be within 1 .. {len(lesson.steps)}, got {number}")
    asked = view_of(lesson.steps[number - 1])
    return merged(asked if state.at else replace(asked, panels=None), state)

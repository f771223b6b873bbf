"""What to open: a scene, perhaps a step of a lesson, and the state of its view."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import Moment, sweep_share
from viewer.lessons.step import Step
from viewer.reopen.scene_files import SceneFiles
from viewer.reopen.view_state import UNCHANGED, ViewState

SceneKey = tuple[Path, str, Mapping[str, Any]]  # file, upward axis, changed values


class InLesson:
    """A scene that may belong to a lesson, and what follows from the place in it that the state has."""

    path: Path
    lesson: Lesson | None
    state: ViewState

    @property
    def moment(self) -> Moment:
        """The place in the lesson."""
        step, press = self.state.at or (1, 0)
        return Moment(step - 1, press)

    @property
    def step(self) -> Step | None:
        """The step of the lesson."""
        return self.lesson and self.lesson.step_at(self.moment.step)

    @property
    def share(self) -> float:
        """How far the step's sweep has gone, 0 to 1."""
        return sweep_share(self.step, self.state)

    @property
    def changes(self) -> Mapping[str, Any]:
        """The values of the scene that the step replaces."""
        return self.step.state.swept(self.share).set if self.step else {}

    @property
    def between(self) -> tuple[float, float] | None:
        """The place in the image to which the step's sweep has gone, if it is between pixels and the state has no other
        pixel than the nearest one. In pixels from the centre of pixel (0, 0).
        """
        sweep = self.step.state.sweep if self.step else None
        if not sweep or not sweep.is_pixel or self.state.pixel != sweep.pixel(self.share):
            return None
        return sweep.between(self.share)

    def at_its_step(self) -> Self:
        """The same, with the scene of the lesson's step."""
        return replace(self, path=self.step.scene) if self.step else self  # type: ignore[type-var]


@dataclass(frozen=True)
class Opening(InLesson):
    """A scene to open, and the state of its view; what is None there is the lesson's or the scene's own."""

    path: Path  # of the scene; of a figure until it is read
    lesson: Lesson | None = None
    state: ViewState = UNCHANGED
    is_return: bool = False  # to a place that was looked at before
    shows_stage: bool = False  # of the reveal of the lesson's step, after the presses that the state says
    sets_view: bool = False  # the state is taken over even if the scene is on show already
    keeps_view: bool = False  # the scene is the one on show with another value: pixel, depth and view stay
    figure: Path | None = None  # whose copy of the scene this is
    files: SceneFiles | None = None  # the content of the scene's files, when it is loaded
    note: str = ""  # a notice for when it is shown
    instead: "Opening | None" = None  # what to open if this cannot be loaded; its note is followed by the reason

    @property
    def up(self) -> str:
        """The axis of a mesh file that points upwards."""
        return self.state.up

    @property
    def scene_key(self) -> SceneKey:
        """The scene's file and its values: two openings with equal keys are of one scene."""
        return (self.path, self.up, self.changes)

    def is_of(self, other: "Opening") -> bool:
        """True if both open the same scene with the same values."""
        return self.scene_key == other.scene_key

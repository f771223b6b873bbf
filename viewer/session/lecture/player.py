"""Gives a lesson: one key leads to the next moment, another to the one before. Each moment is an absolute state."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

from viewer.base.files import Unusable
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import Moment, Shown, count_presses, shown_at
from viewer.lessons.step import COLOUR, DEPTH, Step
from viewer.session.image_renderer import ImageRenderer, Job
from viewer.session.layout import Layout
from viewer.session.lecture.ahead import LAST, Ahead, first_moment, opening_at
from viewer.session.lecture.sweeping import Sweeping
from viewer.session.loading.opening import Opening
from viewer.session.loading.scene_loader import SceneLoader
from viewer.session.stepping.reveal import Reveal
from viewer.session.view_state import Notice


class Taught(Protocol):
    """The parts of a session that a lesson changes."""

    reveal: Reveal
    loader: SceneLoader
    image: ImageRenderer
    pixel: tuple[int, int] | None
    between: tuple[float, float] | None
    selection: str | None
    layout: Layout
    notice: Notice

    @property
    def opening(self) -> Opening | None: ...
    def show_swept(self, opening: Opening) -> None: ...
    def show_moment(self, opening: Opening) -> None: ...
    def show_faults(self, faults: list[str]) -> None: ...
    def image_job(self, depth: int) -> Job: ...
    def set_depth(self, depth: int) -> None: ...
    @property
    def scene_depth(self) -> int: ...


class LessonPlayer:
    """The place in the lesson on show."""

    def __init__(self, session: Taught) -> None:
        self.session = session
        self.sweeping = Sweeping(session)
        self.ahead = Ahead(session)
        self.parameters: dict[str, float] = {}  # of the live pieces, by the names of their handles
        self.lines_too_many = 0  # of the step's text in its panel, when it was drawn last
        self.is_due = False  # whether the stage is to be shown as soon as there is a tree

    @property
    def lesson(self) -> Lesson | None:
        return self.session.opening.lesson if self.session.opening else None

    @property
    def step(self) -> Step | None:
        return self.session.opening.step if self.session.opening else None

    @property
    def hit(self) -> str | None:
        """The path of the ray whose hit is looked at: that which is selected, or that of the step."""
        return self.session.selection or (self.step.state.hit if self.step else None)

    @property
    def moment(self) -> Moment:
        """The place in the lesson, not beyond the end of its step."""
        opening, step = self.session.opening, self.step
        if not opening or not step:
            return Moment()
        return replace(opening.moment, press=min(opening.moment.press, count_presses(step, self.stages)))

    @property
    def shown(self) -> Shown:
        """What is shown of the step."""
        return shown_at(self.step, self.stages, self.moment.press) if self.step else Shown()

    @property
    def stages(self) -> int:
        """The stages of the step's reveal; 1 if it has none, or no tree yet; 2, the ends, of its sweep."""
        step = self.step
        if not step or not step.state.reveal:
            return 2 if step and step.state.sweep else 1
        if step.state.reveal == DEPTH:
            return (self.session.scene_depth if step.state.depth is None else step.state.depth) + 1
        return len(self._pages)

    @property
    def _pages(self) -> Sequence[int]:
        """The pages by ray that are the stages of the reveal. Those that only add rays of hidden kinds are left out."""
        steps = self.session.reveal.steps
        if not steps or not self.step:
            return range(1)
        if self.step.state.reveal == COLOUR:
            return range(steps.count_reveals - 1, len(steps))
        shown = {*self.step.state.show, "camera"}
        kinds = [{steps.tree.kind(row) for row in steps[k].current} for k in range(steps.count_reveals)]
        return [k for k, added in enumerate(kinds) if added & shown]

    # --- going on -----------------------------------------------------------------------------------------------------

    def go(self, by: int) -> bool:
        """Go to the next moment (1), or to the one before (-1). Returns False if no lesson is on show.

        A lesson that is not given yet begins with the moment that is on show: its question comes before its answer. A
        press counts from the moment that was asked for last, also while its scene is still being loaded.
        """
        coming = self._coming
        if not coming and not self.session.layout.taught:
            return self.come_back()
        opening = coming or self.session.opening
        if not opening or not opening.lesson or not opening.step:
            return False
        if by > 0 and self.sweeping.finish():
            return True
        lesson, step = opening.lesson, opening.step
        moment, stages = (self.moment, self.stages) if coming is None else (opening.moment, _least_stages(step))
        press = moment.press + by
        if step.state.sweep and (moment.press, press) == (0, 1):
            self.show(lesson, Moment(moment.step, press), 0.0)
            self.sweeping.play()
        elif 0 <= press <= count_presses(step, stages):
            self.show(lesson, Moment(moment.step, press))
        elif 0 <= moment.step + by < len(lesson.steps):
            self.show(lesson, Moment(moment.step + by, 0 if by > 0 else LAST))
        else:
            self._go_to_lesson(lesson, by)
        return True

    @property
    def _coming(self) -> Opening | None:
        """The moment of a lesson whose scene is being loaded."""
        loader = self.session.loader
        return loader.opening if loader.loading and loader.opening and loader.opening.shows_stage else None

    def come_back(self) -> bool:
        """Show the moment as it was, after wandering off. Returns False if no lesson is on show."""
        if self.lesson:
            self.show(self.lesson, self.moment)
        return self.lesson is not None

    def _go_to_lesson(self, lesson: Lesson, by: int) -> None:
        """Go to the beginning of the next lesson, or to the end of the one before."""
        name = lessons.neighbour(lesson, by)
        if name is None:
            self.session.notice.say(_end(lesson, by))
            return
        try:
            other = lessons.read(name)
        except Unusable as unusable:
            self.session.show_faults(list(unusable.faults))
            return
        self.show(other, first_moment(other, by))

    def show(self, lesson: Lesson, moment: Moment, swept: float | None = None) -> None:
        """Show a moment of a lesson, or a place of its step's sweep."""
        self.sweeping.stop()
        self.parameters = {}
        self.session.show_moment(opening_at(lesson, moment, swept))

    def look_ahead(self) -> None:
        """Prepare what the next presses show."""
        if not self.lesson or not self.step:
            return
        depths = range(self.stages) if self.step.state.reveal == DEPTH else ()
        jobs = [self.session.image_job(depth) for depth in depths]
        self.ahead.prepare(self.lesson, self.moment, jobs, self.look_ahead)
        self.sweeping.prepare(lambda world: None)

    def show_stage(self) -> None:
        """Show the stage of the reveal, and prepare what comes next. Called when there is a tree."""
        step = self.step
        if not self.is_due or not step:
            return
        self.is_due = False
        if step.state.reveal == DEPTH:
            self.session.set_depth(self.shown.stage)
        elif step.state.reveal:
            self.session.reveal.go_to(self._pages[self.shown.stage])
        self.look_ahead()


def _least_stages(step: Step) -> int:
    """The stages of a step without its tree: of its sweep exactly; of a reveal by rays, which needs the tree, two."""
    return 2 if step.state.sweep or step.state.reveal else 1


def _end(lesson: Lesson, by: int) -> str:
    """The notice where there is no further step."""
    if by > 0 and lessons.ends_course(lesson):
        return "the course ends here; deeper lessons are in the menu"
    return f"the {'first' if by < 0 else 'last'} step of {lesson.title}"

"""Gives a lesson: one key leads to the next moment, another to the one before. Each moment is an absolute state."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

from tracer.kernel.world import World
from viewer.base.files import Unusable
from viewer.figures.steps import adding
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import Moment, Shown, count_presses, shown_at, sweep_share, view_of
from viewer.lessons.step import COLOUR, DEPTH, Step
from viewer.reopen.view_state import ViewState, merged
from viewer.session.image_renderer import ImageRenderer, Job
from viewer.session.lecture.sweeping import Sweeping
from viewer.session.loading.opening import Opening
from viewer.session.loading.scene_loader import SceneLoader
from viewer.session.scene_on_show import image_limits
from viewer.session.stepping.reveal import Reveal
from viewer.session.view_state import Notice

LAST = 99_999  # presses after the beginning of a step: its end, however many there are


class Taught(Protocol):
    """The parts of a session that a lesson changes."""

    reveal: Reveal
    loader: SceneLoader
    image: ImageRenderer
    selection: str | None
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
        """The pages by ray that are the stages of the reveal: without those on which no ray appears."""
        steps = self.session.reveal.steps
        if not steps or not self.step:
            return range(1)
        if self.step.state.reveal == COLOUR:
            return range(steps.count_reveals - 1, len(steps))
        return adding(steps, set(self.step.state.show))

    # --- going on -----------------------------------------------------------------------------------------------------

    def go(self, by: int) -> bool:
        """Go to the next moment (1), or to the one before (-1). Returns False if no lesson is on show.

        A press counts from the moment that was asked for last, also while its scene is still being loaded.
        """
        coming = self._coming
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
            self.session.notice.say(f"the {'first' if by < 0 else 'last'} step of {lesson.title}")
            return
        try:
            other = lessons.read(name)
        except Unusable as unusable:
            self.session.show_faults(list(unusable.faults))
            return
        self.show(other, Moment() if by > 0 else Moment(len(other.steps) - 1, LAST))

    def show(self, lesson: Lesson, moment: Moment, swept: float | None = None) -> None:
        """Show a moment of a lesson, or a place of its step's sweep."""
        self.sweeping.stop()
        self.parameters = {}
        self.session.show_moment(self._opening(lesson, moment, swept))

    def look_ahead(self) -> None:
        """Prepare what the next presses show: scenes of the neighbouring steps, and images."""
        lesson, step, moment = self.lesson, self.step, self.moment
        if not lesson or not step:
            return
        jobs: list[Job] = []
        if step.state.reveal == DEPTH:
            jobs += [self.session.image_job(depth) for depth in range(self.stages)]
        waiting = []
        for number in (moment.step + 1, moment.step - 1):
            if 0 <= number < len(lesson.steps):
                opening = self._opening(lesson, Moment(number))
                found = self.session.loader.prepared.find(opening)
                if found:
                    jobs.append(_image_of(opening, found.world))
                else:
                    waiting.append(opening)
        self.session.image.prepare(jobs)
        for opening in waiting:
            self.session.loader.prepare(opening, lambda world: self.look_ahead())
        self.sweeping.prepare(lambda world: None)

    def _opening(self, lesson: Lesson, moment: Moment, swept: float | None = None) -> Opening:
        step = lesson.step_at(moment.step)
        place = ViewState(at=(moment.step + 1, moment.press), swept=swept)
        state = merged(view_of(step, sweep_share(step, place)), place)
        return Opening(step.scene, lesson, state, is_return=True, shows_stage=True, sets_view=True)

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


def _image_of(opening: Opening, world: World) -> Job:
    """The first image of a step."""
    step, tracing, image = opening.step, world.scene.tracing, world.scene.image
    assert step
    depth = 0 if step.state.reveal == DEPTH else step.state.depth
    limits = image_limits(world, tracing.depth if depth is None else depth, step.state.model or tracing.model)
    return (world, limits, (image.width, image.height))

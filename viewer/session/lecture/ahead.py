"""Prepares what the next presses of a lesson show, while the lecturer talks: scenes and first images."""

from collections.abc import Callable, Iterable, Iterator
from typing import Protocol

from tracer.kernel.world import World
from viewer.base.cached import Cached
from viewer.base.files import Unusable
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import Moment, sweep_share, view_of
from viewer.lessons.step import DEPTH
from viewer.reopen.view_state import ViewState, merged
from viewer.session.image_renderer import ImageRenderer, Job
from viewer.session.loading.opening import Opening
from viewer.session.loading.scene_loader import SceneLoader
from viewer.session.scene_on_show import image_limits

LAST = 99_999  # presses after the beginning of a step: its end, however many there are
WAYS = (1, -1)  # forwards is prepared first


class Preparing(Protocol):
    """The parts of a session that prepare."""

    loader: SceneLoader
    image: ImageRenderer


class Ahead:
    """What is prepared for the moments before and after the one on show."""

    def __init__(self, session: Preparing) -> None:
        self.session = session
        self._beside = Cached[dict[int, Lesson]]()

    def prepare(self, lesson: Lesson, moment: Moment, jobs: Iterable[Job], again: Callable[[], object]) -> None:
        """Prepare the scenes of the neighbouring steps, and their first images after those of `jobs`. `again` is called
        when another scene is there.
        """
        jobs, waiting = list(jobs), []
        for opening in self._neighbours(lesson, moment):
            found = self.session.loader.prepared.find(opening)
            if found:
                jobs.append(_image_of(opening, found.world))
            else:
                waiting.append(opening)
        self.session.image.prepare(jobs)
        for opening in waiting:
            self.session.loader.prepare(opening, lambda world: again())

    def _neighbours(self, lesson: Lesson, moment: Moment) -> Iterator[Opening]:
        """The moments at which the steps before and after begin or end, also those of other lessons."""
        for by in WAYS:
            number = moment.step + by
            if 0 <= number < len(lesson.steps):
                yield opening_at(lesson, Moment(number, 0 if by > 0 else LAST))
            elif other := self._lessons_beside(lesson).get(by):
                yield opening_at(other, first_moment(other, by))

    def _lessons_beside(self, lesson: Lesson) -> dict[int, Lesson]:
        return self._beside.get(lesson, lambda: dict(_read_beside(lesson)))


def first_moment(lesson: Lesson, by: int) -> Moment:
    """The moment of a lesson that is reached first, forwards (1) or backwards (-1)."""
    return Moment() if by > 0 else Moment(len(lesson.steps) - 1, LAST)


def opening_at(lesson: Lesson, moment: Moment, swept: float | None = None) -> Opening:
    """What is to be opened for a moment of a lesson, or for a place of its step's sweep."""
    step = lesson.step_at(moment.step)
    place = ViewState(at=(moment.step + 1, moment.press), swept=swept)
    state = merged(view_of(step, sweep_share(step, place)), place)
    return Opening(step.scene, lesson, state, is_return=True, shows_stage=True, sets_view=True)


def _read_beside(lesson: Lesson) -> Iterator[tuple[int, Lesson]]:
    """The lessons after (1) and before (-1). One with faults is left for when it is opened: they are shown then."""
    for by in WAYS:
        name = lessons.neighbour(lesson, by)
        if name is not None:
            try:
                yield by, lessons.read(name)
            except Unusable:
                continue


def _image_of(opening: Opening, world: World) -> Job:
    """The image with which a step is reached."""
    step, tracing, image = opening.step, world.scene.tracing, world.scene.image
    assert step
    at_its_beginning = step.state.reveal == DEPTH and opening.moment.press == 0
    depth = 0 if at_its_beginning else step.state.depth
    limits = image_limits(world, tracing.depth if depth is None else depth, step.state.model or tracing.model)
    return (world, limits, (image.width, image.height))

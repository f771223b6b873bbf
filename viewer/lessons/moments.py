"""The moments of a lesson: each press of a key leads to the next one.

In a step, the stages of its reveal come first, then its hidden parts, one by one.
"""

from dataclasses import dataclass

from viewer.figures.catalogue import BREADTH
from viewer.lessons.step import DEPTH, Step
from viewer.reopen.view_state import GRANULARITIES, ViewState


@dataclass(frozen=True, order=True)
class Moment:
    """A place in a lesson: a step, and how many presses after its beginning. Both count from 0."""

    step: int = 0
    press: int = 0


@dataclass(frozen=True)
class Shown:
    """What is shown of a step: how many of its parts, and the stage of its reveal."""

    parts: int = 1
    stage: int = 0


def count_presses(step: Step, stages: int) -> int:
    """The presses inside a step whose reveal has so many stages (1: it has none)."""
    return stages - 1 + len(step.parts) - 1


def shown_at(step: Step, stages: int, press: int) -> Shown:
    """What is shown after so many presses."""
    stage = min(press, stages - 1)
    return Shown(min(1 + press - stage, len(step.parts)), stage)


def view_of(step: Step) -> ViewState:
    """The view that a step begins with. The first stage of its reveal is shown when there is a tree."""
    state, view = step.state, step.state.view
    by_ray = state.reveal not in (None, DEPTH)
    return ViewState(
        pixel=state.pixel,
        sample=state.sample,
        depth=state.depth,
        model=state.model,
        select=state.hit,
        step=GRANULARITIES[by_ray],
        order=BREADTH,
        camera=(view.azimuth, view.elevation, view.distance, *(view.target or ())),
        filter=state.show,
        hide=(),
        beside=state.panels or None,
    )

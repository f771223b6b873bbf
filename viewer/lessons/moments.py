"""The moments of a lesson: each press of a key leads to the next one.

In a step, the stages of its reveal come first, or its sweep; then its hidden parts, one by one.
"""

from collections.abc import Collection
from dataclasses import dataclass

from viewer.figures.catalogue import BREADTH
from viewer.figures.steps import Steps, adding, of_kinds, whole
from viewer.lessons.step import COLOUR, DEPTH, Step
from viewer.reopen.view_state import GRANULARITIES, ViewState


@dataclass(frozen=True, order=True)
class Moment:
    """A place in a lesson: a step, and how many presses after its beginning. Both count from 0."""

    step: int = 0
    press: int = 0


@dataclass(frozen=True)
class Shown:
    """What is shown of a step: how many of its parts, and the stage of its reveal or of its sweep."""

    parts: int = 1
    stage: int = 0


def sweep_share(step: Step | None, view: ViewState) -> float:
    """How far the sweep of a step has gone: as the view says, or all of the way from the first press on."""
    if step is None or step.state.sweep is None:
        return 0.0
    if view.swept is not None:
        return step.state.sweep.stop(view.swept)
    return float(view.at is not None and view.at[1] > 0)


def count_presses(step: Step, stages: int) -> int:
    """The presses inside a step whose reveal or sweep has so many stages (1: it has none)."""
    return stages - 1 + len(step.parts) - 1


def shown_at(step: Step, stages: int, press: int) -> Shown:
    """What is shown after so many presses."""
    stage = min(press, stages - 1)
    return Shown(min(1 + press - stage, len(step.parts)), stage)


def stages_of(steps: Steps, reveal: str, show: Collection[str]) -> list[int]:
    """The numbers of the steps of a tree, ray by ray, that are the stages of a reveal by rays, or of one by sums, which
    begins with all rays. Stages that only add or sum up rays of hidden kinds are left out: they would look like the one
    before. `show` are the kinds of rays that are shown.
    """
    kinds = {*show, "camera"}
    if reveal != COLOUR:
        return adding(steps, kinds)
    kept = of_kinds(whole(steps.tree), kinds).rows
    sums = [k for k, change in enumerate(steps.changes) if change.sums and not kept.isdisjoint(change.rows)]
    return [steps.count_reveals - 1, *sums]


def view_of(step: Step, share: float = 0.0) -> ViewState:
    """The view that a step begins with, or that it has at this share of its sweep. The first stage of its reveal is
    shown when there is a tree.
    """
    state, view = step.state.swept(share), step.state.view
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
        inset=view.inset,
    )

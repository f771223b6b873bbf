"""Rules for every figure. A new figure is covered here without a change to this file."""

from collections.abc import Iterator

import pytest

import tracer
from tests.conftest import LESSONS
from tests.viewer.figures.geometry import check, check_texts
from viewer.base.orbit import Frame, initial_orbit
from viewer.figures.catalogue import FIGURE_NAMES
from viewer.figures.marks import Figure
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.lessons import lesson

pytestmark = pytest.mark.early

# Figures with a picture of the scene, whose lines run behind the names of objects.
WITH_SCENE = ("scene", "both")


def figures(name: str, worlds: dict[str, tracer.World]) -> Iterator[Figure]:
    """The figure of every lesson, a page for two depths."""
    for title in LESSONS:
        world, found = worlds[title], lesson.read(title)
        trees = [tracer.trace(world, found.first.state.pixel, depth=depth) for depth in (0, 3)]
        subject = Subject(by_depth(trees), world, initial_orbit(world, Frame.of(world), found.first.state.view))
        yield from pages(name, subject, FigureStyle())


@pytest.mark.parametrize("name", FIGURE_NAMES)
def test_nothing_overlaps_and_nothing_leaves_the_canvas(name: str, worlds: dict[str, tracer.World]) -> None:
    for figure in figures(name, worlds):
        if name in WITH_SCENE:
            check_texts(figure)
        else:
            check(figure)

"""The steps of the tree on show: position, order, and the animation, at given times."""

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.viewer.figures.random_tree import random_tree
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.figures.catalogue import BREADTH, ORDERS, RECURSION
from viewer.figures.steps import by_level, by_ray
from viewer.lessons import lesson
from viewer.session.stepping.reveal import GRANULARITIES, LEVELS, RAYS, SPEEDS, Reveal

HOW = [(LEVELS, BREADTH), (RAYS, BREADTH), (RAYS, RECURSION)]


class Show:
    """A tree on show, and its steps."""

    def __init__(self, tree: RayTree | None) -> None:
        self.tree, self.lights = tree, True
        self.reveal = Reveal(lambda: self.tree, lambda: self.lights)

    def set(self, granularity: str, order: str) -> None:
        self.reveal.set_granularity(granularity)
        self.reveal.set_order(order)


@pytest.fixture
def show(worlds: dict[str, tracer.World]) -> Show:
    return Show(tracer.trace(worlds["glass-ball"], (248, 180), depth=3))


def position_of(reveal: Reveal) -> int:
    assert reveal.position is not None
    return reveal.position


@pytest.mark.parametrize(("granularity", "order"), HOW)
@pytest.mark.parametrize("name", EACH_LESSON)
def test_the_state_is_absolute(name: str, granularity: str, order: str, worlds: dict[str, tracer.World]) -> None:
    """Forwards, backwards and by a jump, each step is the exported one."""
    show = Show(tracer.trace(worlds[name], lesson.read(name).first.state.pixel, depth=3))
    show.set(granularity, order)
    reveal = show.reveal
    assert show.tree and reveal.step is None and reveal.position is None
    expected = list(by_level(show.tree) if granularity == LEVELS else by_ray(show.tree, order))
    seen = []
    for _ in expected:
        reveal.go(1)
        seen.append(reveal.step)
    assert seen == expected
    reveal.go(1)
    assert reveal.step == expected[-1]  # it stays on the last
    for k in range(len(expected) - 2, -1, -1):
        reveal.go(-1)
        assert reveal.step == expected[k]
    reveal.go(-1)
    assert reveal.step == expected[0]
    for k in reversed(range(len(expected))):
        reveal.go_to(k)
        assert (reveal.position, reveal.step) == (k, expected[k])
    reveal.last()
    assert reveal.step == expected[-1]
    reveal.first()
    assert reveal.step == expected[0]
    assert reveal.leave() and reveal.step is None and not reveal.leave()
    reveal.go(-1)
    assert reveal.step == expected[-1]  # a whole tree comes after the last step, on the way back


@pytest.mark.parametrize(("granularity", "order"), HOW)
def test_another_tree_goes_to_the_same_ray_or_its_nearest_ancestor(granularity: str, order: str) -> None:
    trees = [random_tree(seed, 40, seed % 3, 4) for seed in range(12)]
    for first in trees:
        for second in trees:
            show = Show(first)
            show.set(granularity, order)
            for k in range(len(show.reveal.steps or ())):
                show.tree = first
                show.reveal.go_to(k)
                step = show.reveal.step
                assert step
                path, level = first.path(max(step.current)), int(first.nodes["depth"][max(step.current)])
                show.tree = second
                there = show.reveal.step
                assert there and there.tree is second
                if granularity == LEVELS and step.sum is None:
                    assert {int(second.nodes["depth"][i]) for i in there.current} == {
                        min(level, int(second.nodes["depth"].max()))
                    }
                elif second.find(path) is not None:
                    assert second.find(path) in there.current and (there.sum is None) == (step.sum is None)
                else:
                    found = {second.path(i) for i in there.current}
                    assert any(path.startswith(name) or name == "E" for name in found), (path, found)
                show.tree = first  # back again, nothing is lost
                assert show.reveal.step == step


def test_order_and_granularity_keep_the_ray(show: Show) -> None:
    reveal = show.reveal
    assert (reveal.granularity, reveal.order) == (LEVELS, BREADTH)
    reveal.go_to(2)
    step = reveal.step
    assert step
    reveal.toggle_order()  # depth-first is by ray
    assert (reveal.granularity, reveal.order) == (RAYS, RECURSION)
    assert reveal.step and reveal.step.current <= step.current
    reveal.toggle_order()
    assert (reveal.granularity, reveal.order) == (RAYS, BREADTH)
    assert reveal.step and reveal.step.rows == step.rows  # the last ray of the level
    reveal.set_order(RECURSION)
    reveal.toggle_granularity()
    assert (reveal.granularity, reveal.order) == (LEVELS, BREADTH)
    assert reveal.step == step


def test_without_shadow_rays_no_step_adds_one(show: Show) -> None:
    reveal, tree = show.reveal, show.tree
    assert tree
    show.set(RAYS, RECURSION)
    reveal.go_to(1)
    assert reveal.step and {tree.kind(i) for i in reveal.step.current} == {"shadow"}
    show.lights = False
    assert reveal.step and reveal.step.current == {0}
    assert reveal.steps
    for step in reveal.steps:
        assert not [i for i in step.rows if tree.nodes["kind"][i] == SHADOW]


def test_without_a_tree_nothing_happens() -> None:
    reveal = Show(None).reveal
    for act in (lambda: reveal.go(1), lambda: reveal.go_to(3), reveal.first, reveal.last, reveal.toggle_play):
        act()
        assert reveal.step is None and not reveal.is_playing and not reveal.advance(1.0)


def test_an_animation_goes_on_when_its_time_has_come(show: Show) -> None:
    reveal = show.reveal
    count = len(reveal.steps or ())
    assert reveal.wait(5.0) == np.inf and not reveal.advance(5.0)
    reveal.toggle_play()
    assert reveal.is_playing and reveal.position == 0 and reveal.wait(5.0) == 0.0
    assert reveal.advance(5.0) and reveal.position == 0  # the clock starts
    assert reveal.wait(5.25) == 0.75
    assert not reveal.advance(5.99) and reveal.position == 0
    assert reveal.advance(6.0) and reveal.position == 1
    assert reveal.advance(100.0) and reveal.position == 2  # late, but no step is skipped
    reveal.change_speed(1)
    assert reveal.speed == 2.0
    assert reveal.advance(101.0) and reveal.position == 3
    assert not reveal.advance(101.49) and reveal.advance(101.5) and reveal.position == 4
    reveal.toggle_play()
    assert not reveal.is_playing and not reveal.advance(1000.0) and reveal.position == 4
    reveal.toggle_play()  # from where it was
    now = 2000.0
    while reveal.advance(now):
        now += 1.0
    assert not reveal.is_playing and reveal.position == count - 1
    reveal.toggle_play()  # anew
    assert reveal.is_playing and reveal.position == 0


def test_a_loop_begins_anew_and_a_key_pauses(show: Show) -> None:
    reveal = show.reveal
    reveal.toggle_loop()
    reveal.toggle_play()
    count, seen = len(reveal.steps or ()), []
    for now in range(2 * count + 1):
        assert reveal.advance(float(now))
        seen.append(reveal.position)
    assert seen == [*range(count), *range(count), 0]
    reveal.go(1)
    assert not reveal.is_playing and reveal.position == 1
    reveal.toggle_play()
    show.tree = None  # another pixel, whose tree is not there yet
    assert not reveal.advance(500.0) and reveal.is_playing and reveal.wait(500.0) == np.inf
    for _ in SPEEDS:
        reveal.change_speed(1)
    assert reveal.speed == SPEEDS[-1]
    for _ in SPEEDS:
        reveal.change_speed(-1)
    assert reveal.speed == SPEEDS[0]


def test_the_choices_are_named_once() -> None:
    reveal = Show(None).reveal
    said = set()
    for granularity in GRANULARITIES:
        for order in ORDERS:
            reveal.set_granularity(granularity)
            reveal.set_order(order)
            said.add(reveal.words)
    assert len(said) == len(HOW)

"""The steps of a tree: what appears when, and when a colour is known."""

from itertools import pairwise

import pytest

import tracer
from tests.conftest import LESSONS
from tests.viewer.figures.random_tree import random_tree
from tracer.kernel.nodes import KINDS, SHADOW
from tracer.tree.raytree import RayTree
from viewer.figures.catalogue import BREADTH, RECURSION
from viewer.figures.steps import Steps, adding, by_color, by_level, by_ray, of_kinds, whole
from viewer.lessons import lesson

TREES = ["one ray", *LESSONS, *range(6)]


@pytest.fixture(params=TREES)
def tree(request: pytest.FixtureRequest, worlds: dict[str, tracer.World]) -> RayTree:
    match request.param:
        case "one ray":
            return tracer.trace(worlds["glass-ball"], (0, 0), depth=0)
        case str(name):
            return tracer.trace(worlds[name], lesson.read(name).first.state.pixel, depth=3)
        case seed:
            return random_tree(seed, 60, seed % 4, 5)


def sequences(tree: RayTree, lights: bool = True) -> list[Steps]:
    return [
        by_level(tree, lights),
        by_ray(tree, BREADTH, lights),
        by_ray(tree, RECURSION, lights),
        by_color(tree, BREADTH, lights),
        by_color(tree, RECURSION, lights),
    ]


def hits(tree: RayTree) -> set[int]:
    return {i for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW}


@pytest.mark.parametrize("lights", (True, False))
def test_each_step_adds_what_it_says_and_the_last_shows_everything(tree: RayTree, lights: bool) -> None:
    everything = whole(tree, lights).rows
    for steps in sequences(tree, lights):
        assert len(list(steps)) == len(steps)
        for before, after in pairwise(steps):
            assert after.current and (after.rows - before.rows) | (after.summed - before.summed) == after.current
            assert before.rows <= after.rows and before.summed <= after.summed
            assert (after.sum is None) == (after.summed == before.summed)
        assert steps[-1].rows == everything and steps[-1].summed == hits(tree)
        assert steps[-1].sum == 0
        assert steps[-len(steps)] == steps[0] and steps[1:] == list(steps)[1:]
        assert [step.name for step in steps] == sorted({step.name for step in steps})


def test_a_ray_appears_after_its_parent_and_a_hit_is_summed_after_all_its_children(tree: RayTree) -> None:
    for steps in sequences(tree):
        for step in steps:
            assert {int(tree.nodes["parent"][i]) for i in step.rows} <= step.rows | {-1}
            assert step.summed <= step.rows
            for i in step.summed:
                assert {c for c in tree.children[i] if c in hits(tree)} <= step.summed


def test_breadth_first_is_the_order_of_the_table(tree: RayTree) -> None:
    steps = by_ray(tree)
    reveals = [step for step in steps if step.sum is None]
    assert [i for step in reveals for i in sorted(step.current)] == list(range(len(tree)))
    assert [step.sum for step in steps[len(reveals) :]] == sorted(hits(tree), reverse=True)
    levels = [step.current for step in by_level(tree) if step.sum is None]
    assert [{int(tree.nodes["depth"][i]) for i in level} for level in levels] == [{k} for k in range(len(levels))]


def test_depth_first_is_the_order_of_the_recursion(tree: RayTree) -> None:
    """The same as from a recursive function, which follows each child to its end."""
    expected: list[tuple[list[int], bool]] = []

    def visit(i: int) -> None:
        expected.append(([i], False))
        below = tree.children[i]
        shadows = [c for c in below if c not in rays]
        if shadows:
            expected.append((shadows, False))
        for c in below:
            if c in rays:
                visit(c)
        expected.append(([i], True))

    rays = hits(tree)
    visit(0)
    steps = by_ray(tree, RECURSION)
    assert [(sorted(step.current), step.sum is not None) for step in steps] == expected
    colors = by_color(tree, RECURSION)
    assert [step.sum for step in colors[1:]] == [rows[0] for rows, is_sum in expected if is_sum]


def test_all_shadow_rays_of_a_hit_appear_at_once(tree: RayTree) -> None:
    shadows = {i for i in range(len(tree)) if i not in hits(tree)}
    for order in (BREADTH, RECURSION):
        groups = [step.current for step in by_ray(tree, order) if step.current & shadows]
        parents = [{int(tree.nodes["parent"][i]) for i in group} for group in groups]
        assert all(len(parent) == 1 for parent in parents)
        assert len(groups) == len({frozenset(parent) for parent in parents})
        assert set().union(*groups) == shadows


def test_a_row_is_found_on_its_step(tree: RayTree) -> None:
    for steps in sequences(tree):
        for k, step in enumerate(steps):
            for row in step.current:
                assert steps.find(row, sums=step.sum is not None) == k


@pytest.mark.parametrize("shown", [{"refraction"}, {"reflection", "shadow"}, {"tir", "refraction"}, set(), set(KINDS)])
def test_each_page_by_ray_adds_a_ray_that_is_shown(tree: RayTree, shown: set[str]) -> None:
    """With some kinds of rays only, no page is like the one before, and none is missing."""
    steps = by_ray(tree)
    pages = adding(steps, shown)
    rows = [of_kinds(steps[k], shown).rows for k in pages]
    assert pages[0] == 0 and all(before < after for before, after in pairwise(rows))
    assert rows[-1] == of_kinds(whole(tree), shown).rows

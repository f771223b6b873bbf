"""The recorded run of the recursion against the kernel's table, two computations that know nothing of each other."""

import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tracer import whitted
from tracer.choices import MODELS
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.explain import recursion
from viewer.explain.recursion import Recording, record, source
from viewer.figures.catalogue import RECURSION
from viewer.figures.steps import by_ray
from viewer.lessons import lesson

# The page's epsilon is too large for these scenes (tests/tracer/test_whitted.py): the record ends at this ray.
ENDS = {"scale": {"whitted": "E", "fresnel": "E"}, "panes": {"whitted": "T2", "fresnel": "T4"}}


def tree_of(worlds: dict[str, tracer.World], name: str, **how: object) -> RayTree:
    return tracer.trace(worlds[name], lesson.read(name).first.state.pixel, depth=3, **how)  # type: ignore[arg-type]


@pytest.fixture
def glass(worlds: dict[str, tracer.World]) -> Recording:
    return record(tree_of(worlds, "glass-ball"))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", EACH_LESSON)
def test_the_recursion_goes_through_the_tree_as_the_depth_first_steps_do(
    name: str, model: str, worlds: dict[str, tracer.World]
) -> None:
    tree = tree_of(worlds, name, model=model)
    recording = record(tree)
    steps = [(min(step.current), step.sum is not None) for step in by_ray(tree, RECURSION)]
    seen = list(dict.fromkeys((moment.row, moment.sums) for moment in recording.moments))
    if name in ENDS:
        assert f"At {ENDS[name][model]}, whitted.py differs" in recording.note and "epsilon of 0.0001" in recording.note
        assert 0 < len(seen) < len(steps)
    else:
        assert not recording.note
    assert seen == steps[: len(seen)] and (len(seen) == len(steps)) == (name not in ENDS)
    for call in recording.calls:
        caller = recording.calls[call.caller].row if call.caller >= 0 else -1
        assert caller == tree.nodes["parent"][call.row]


def test_each_moment_has_the_values_of_all_active_calls(glass: Recording) -> None:
    tree = glass.tree
    for k, moment in enumerate(glass.moments):
        stack = glass.stack(k)
        rows = [call.row for call, _ in stack]
        assert glass.calls[moment.call] == stack[-1][0] and stack[-1][1] == moment.values
        assert rows[0] == 0 and all(tree.nodes["parent"][b] == a for a, b in pairwise(rows))
        assert [values.depth for _, values in stack] == [tree.depth - n for n in range(len(stack))]
        for (call, values), below in zip(stack, [*rows[1:], None], strict=True):
            n1 = float(np.nan_to_num(tree.nodes["n1"][call.row], nan=values.n1))
            assert values.n1 == n1
            if below is not None:  # it waits: its factors and its colour so far are known
                factor = values.kt if tree.kind(below) == "refraction" else values.kr
                assert factor == pytest.approx(tree.nodes["factor"][below][0], rel=1e-12)
                before = [c for c in tree.children[call.row] if c < below and tree.nodes["kind"][c] != SHADOW]
                brought = sum(tree.nodes["factor"][c] * tree.nodes["radiance"][c] for c in before)
                assert values.color == pytest.approx(tree.nodes["local"][call.row] + brought, rel=1e-12)
        if moment.sums and glass.find(moment.row, True) == k:  # it returns
            assert moment.row == stack[-1][0].row
            assert moment.values.color == pytest.approx(tree.nodes["radiance"][moment.row], rel=1e-12)


def test_the_lines_are_those_of_the_file(glass: Recording) -> None:
    file = Path(whitted.__file__).read_text("utf-8").splitlines()
    text = source()
    assert text.lines == [file[number - 1] for number in text.numbers]
    assert text.lines[0].startswith("def radiance(") and text.lines[-1].strip() == "return color"
    assert not any('"""' in line for line in text.lines)
    assert {moment.line for moment in glass.moments} <= set(text.numbers)
    assert "first_hit(" in file[text.traces - 1] and "local_light(" in file[text.lights - 1]
    for k, moment in enumerate(glass.moments):
        line = file[moment.line - 1].strip()
        assert (moment.line == text.traces) == line.startswith("hit =")
        assert line.startswith("return ") == (moment.sums and glass.find(moment.row, True) == k)


def test_a_long_run_is_recorded_up_to_a_limit(worlds: dict[str, tracer.World], monkeypatch: pytest.MonkeyPatch) -> None:
    tree = tree_of(worlds, "glass-ball")
    whole = record(tree)
    monkeypatch.setattr(recursion, "MOST_CALLS", 3)
    short = record(tree)
    assert short.note == "The record ends here, after 3 calls." and short.calls == whole.calls[:3]
    assert short.moments == whole.moments[: len(short.moments)]
    monkeypatch.undo()
    monkeypatch.setattr(recursion, "MOST_TESTS", 10 * len(tree.world.arrays.surfaces))
    short = record(tree)
    assert "more than 490 tests" in short.note and short.moments == whole.moments[: len(short.moments)]
    assert 0 < len(short.moments) < len(whole.moments)


def test_a_run_that_is_not_wanted_ends_and_nothing_stays_traced(worlds: dict[str, tracer.World]) -> None:
    before = sys.gettrace()
    wanted = iter([True, True, False])
    assert record(tree_of(worlds, "glass-ball"), lambda: next(wanted)).note == "stopped"
    assert sys.gettrace() is before


def test_a_tree_that_the_kernel_cut_ends_the_record_there(worlds: dict[str, tracer.World]) -> None:
    for least, row, how in ((0.05, "T1", "another ray is sent"), (0.97, "E", "the kernel sends no such ray")):
        note = record(tree_of(worlds, "glass-ball", min_weight=least)).note
        assert f"At {row}, whitted.py differs from the kernel: {how}" in note
    tree = tree_of(worlds, "glass-ball")
    other = replace(tree, nodes=tree.nodes.copy())
    other.nodes["point"][4] += 1e-3  # a hit in another place
    assert "At T2, whitted.py differs from the kernel: it meets something else" in record(other).note
    other = replace(tree, nodes=tree.nodes.copy())
    other.nodes["radiance"][3] += 1e-3
    assert "At R1, whitted.py differs from the kernel: it has another colour" in record(other).note

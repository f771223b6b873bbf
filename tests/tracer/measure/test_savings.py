"""`raytree plan --measure`: each variant does the work that is left out, for the same image. No test of time."""

import dataclasses
import itertools
import time

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import DARK, GLASS, MATTE, ball, box, plane, world_of
from tracer.measure.plan.paired_timing import paired
from tracer.measure.plan.savings import UNNOTICED, Measured, Saving, Shot, measure, tree_rays
from tracer.measure.plan.variants import Variant
from tracer.measure.plan.with_capability import WITH, everything
from tracer.measure.plan.without_capability import WITHOUT
from tracer.scene import Image, Light

LAMP = Light("lamp", position=(3.0, 6.0, 5.0))
OTHER_PICTURE = {"lens, glossy samples"}


def matte() -> tracer.World:
    return world_of(ball(), plane((0, -1, 0), (0, 1, 0)), lights=(LAMP,), image=Image(64, 48), depth=2)


def glass() -> tracer.World:
    return world_of(
        ball(material=GLASS), box((-4, -2, -4), (4, -1, 4), MATTE), lights=(LAMP,), model="fresnel", image=Image(64, 48)
    )


def shots(world: tracer.World, variant: Variant) -> tuple[tracer.Image, tracer.Image]:
    depth = world.scene.tracing.depth
    other = Shot(tracer.prepare(variant.scene, variant.hierarchy), variant, depth)
    return Shot(world, Variant("", world.scene), depth)((64, 48)), other((64, 48))


def assert_same(first: np.ndarray, second: np.ndarray) -> None:
    """Equal bit for bit; for black images up to what no screen and no sum would notice."""
    seen = first != 0.0
    assert (first[seen] == second[seen]).all()
    assert np.abs(second[~seen]).max(initial=0.0) < UNNOTICED


@pytest.mark.parametrize("name", EACH_LESSON)
def test_what_is_left_out_would_change_no_picture(name: str, worlds: dict[str, tracer.World]) -> None:
    world = worlds[name]
    asked = 0
    for left_out in set(world.left_out) & set(WITH) - OTHER_PICTURE:
        variant = WITH[left_out](world.scene)
        if isinstance(variant, str) or "another picture" in variant.how:
            continue
        asked += 1
        first, second = shots(world, variant)
        if left_out == "vertex normals":  # the mean of three equal normals is one more rounding
            assert np.median(np.abs(first.pixels - second.pixels)) < 1e-14
        else:
            assert_same(first.pixels, second.pixels)
    # These need all work that could be measured without another image.
    assert asked or name in ("underwater", "scale", "panes")
    assert_same(*(image.pixels for image in shots(world, everything(world.scene, world.left_out))))


def test_every_capability_has_both_scenes_or_says_why(worlds: dict[str, tracer.World]) -> None:
    names = {need.name for need in worlds["glass-ball"].needs} - {"light from behind"}
    assert set(WITH) == names
    assert set(WITHOUT) == names
    for world in worlds.values():
        for need in world.needs:
            if need.needed and need.name in WITHOUT:
                variant = WITHOUT[need.name](world.scene)
                assert isinstance(variant, Variant)
                plainer = tracer.prepare(variant.scene, variant.hierarchy)
                assert need.name in plainer.left_out or need.name == "reflection"


def test_variants_ask_for_the_rays(worlds: dict[str, tracer.World]) -> None:
    """Closed forms on a floor that fills the image: at depth d a matte tree of two rays a hit has 2^(d+1) - 1."""
    world = world_of(
        plane((0, -1, 0), (0, 1, 0)), plane((0, 1, 0), (0, -1, 0)), plane((0, 0, -9), (0, 0, 1)),
        plane((-9, 0, 0), (1, 0, 0)), plane((9, 0, 0), (-1, 0, 0)), plane((0, 0, 12), (0, 0, -1)),
        lights=(LAMP,), image=Image(64, 48), depth=3,
    )  # fmt: skip
    pixels = 64 * 48
    variant = WITH["reflection"](world.scene)
    assert isinstance(variant, Variant)
    first, second = shots(world, variant)
    assert (first.rays["camera"], first.rays["reflection"]) == (pixels, 0)
    assert second.rays["reflection"] == 3 * pixels  # a closed room: every ray hits a wall
    dark = world_of(plane((0, 0, -5), (0, 0, 1), DARK), image=Image(64, 48))
    _, second = shots(dark, WITH["shadow rays"](dark.scene))  # type: ignore[arg-type]
    assert second.rays["shadow"] == pixels


@pytest.fixture(scope="module")
def plans() -> dict[str, tuple[tracer.World, Measured]]:
    return {world.scene.tracing.model: (world, measure(world)) for world in (matte(), glass())}


@pytest.mark.parametrize("which", ["whitted", "fresnel"])
def test_plan_measures_every_line_or_says_why_not(which: str, plans: dict[str, tuple[tracer.World, Measured]]) -> None:
    world, plan = plans[which]
    assert [saving.need for saving in plan.savings] == list(world.needs)
    own = tracer.render(world, plan.size, depth=plan.depth).rays
    assert plan.rays == own
    for saving in plan.savings:
        assert saving.how
        if saving.rays and saving.size == plan.size:
            assert saving.rays[1 if saving.need.needed else 0] == sum(own.values())
    measured = {saving.need.name: saving for saving in plan.savings if saving.times}
    assert {"reflection", "refraction", "media", "shadow rays", "checker", "hierarchy"} <= set(measured)
    assert plan.together.changed == 0
    assert all(saving.changed == 0 for saving in plan.savings if same_picture(saving))


def same_picture(saving: Saving) -> bool:
    return not saving.need.needed and saving.need.name not in OTHER_PICTURE and "another picture" not in saving.how


def test_claims_of_the_plan_are_the_counts_of_its_scenes(plans: dict[str, tuple[tracer.World, Measured]]) -> None:
    for world, plan in plans.values():
        for saving in plan.savings:
            table = WITHOUT if saving.need.needed else WITH
            variant = table[saving.need.name](world.scene) if saving.need.name in table else ""
            if isinstance(variant, str) or saving.size is None or saving.rays is None:
                continue
            options = {"depth": plan.depth, **variant.options}
            other = tracer.render(tracer.prepare(variant.scene, variant.hierarchy), saving.size, **options)
            assert saving.rays[0 if saving.need.needed else 1] == sum(other.rays.values())
        behind = next(saving for saving in plan.savings if saving.need.name == "light from behind")
        assert behind.estimated and behind.rays and behind.size
        trees = [
            tracer.trace(world, (x, y), size=behind.size, depth=plan.depth)
            for y in range(behind.size[1])
            for x in range(behind.size[0])
        ]
        assert behind.rays[1] == sum(len(tree) for tree in trees)


def test_trees_count_what_an_image_leaves_out() -> None:
    """Two lights, one on either side of a floor that fills the image: a tree has both shadow rays, an image one."""
    world = world_of(
        plane((0, 0, -5), (0, 0, 1)),
        lights=(LAMP, dataclasses.replace(LAMP, position=(0.0, 0.0, -9.0))),
        image=Image(16, 12),
    )
    own = Shot(world, Variant("", world.scene), 0)
    assert own((16, 12)).rays["shadow"] == 16 * 12
    assert tree_rays(own, (16, 12))["shadow"] == 2 * 16 * 12


def test_turns_are_medians_of_pairs() -> None:
    """Variants run in turn, each first as often as second, so one slow run does not change the median."""
    said: list[str] = []
    delays = iter([0.0, 0.0, 50.0] + [0.0] * 100)

    def without() -> float:
        said.append("a")
        return 2.0 + next(delays)

    def with_it() -> float:
        said.append("b")
        return 3.0

    turns = paired(without, with_it, 7)
    assert (turns.without, turns.extra, turns.ratio, turns.uncertainty) == (2.0, 1.0, 1.5, 0.0)
    assert "".join(said).startswith("abbaab")
    assert said.count("a") == said.count("b") == turns.pairs == 7


def test_the_same_sizes_and_runs_whatever_the_clock_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock on which everything takes a day: the same images, as often."""

    def counted(plan: Measured) -> list[tuple]:
        every = (*plan.savings, plan.together)
        return [(plan.size, saving.size, saving.rays, saving.times and saving.times.pairs) for saving in every]

    fast = measure(matte())
    day = itertools.count(0.0, 86400.0)
    for name in ("perf_counter", "process_time"):
        monkeypatch.setattr(time, name, lambda: next(day))
    assert counted(measure(matte())) == counted(fast)


def test_progress_of_a_plan_is_that_of_its_runs() -> None:
    """The share grows by the work of each pair of runs, and is 1 in the end."""
    told: list[float] = []
    plan = measure(matte(), told.append)
    assert told[0] == 0.0
    assert told[-1] == 1.0
    assert told == sorted(told)
    runs = [saving.times.pairs for saving in (*plan.savings, plan.together) if saving.times]
    assert len(told) == 1 + sum(runs)

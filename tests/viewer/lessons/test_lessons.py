"""The lessons: each one opens, and its pixel shows what its text says."""

import itertools
import os
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests import ROOT
from tests.conftest import ALL_LESSONS
from viewer.base.files import Unusable
from viewer.lessons import lesson
from viewer.lessons.check import check
from viewer.window.lesson_room import room_faults


@pytest.mark.parametrize("name", ALL_LESSONS)
def test_lesson_is_complete(name: str) -> None:
    found = lesson.read(name)
    assert found.title and found.steps
    scene = tracer.load(found.scene)
    assert scene.title
    assert found.first.state.pixel
    assert found.first.state.pixel[0] < scene.image.width and found.first.state.pixel[1] < scene.image.height


def test_the_order_names_every_lesson_once() -> None:
    assert sorted(ALL_LESSONS) == sorted(path.parent.name for path in (ROOT / "lessons").glob("*/lesson.md"))


def opened(name: str, worlds: dict[str, tracer.World]) -> tracer.RayTree:
    found = lesson.read(name)
    return tracer.trace(worlds[name], found.first.state.pixel, depth=found.first.state.depth)


def test_mirror_balls_add_something_at_every_depth(worlds: dict[str, tracer.World]) -> None:
    found = lesson.read("mirror-balls")
    colors = [tracer.trace(worlds["mirror-balls"], found.first.state.pixel, depth=depth).radiance for depth in range(4)]
    for shallow, deep in itertools.pairwise(colors):
        assert abs(deep - shallow).max() > 0.05


def test_glass_ball_is_entered_and_left_for_the_table(worlds: dict[str, tracer.World]) -> None:
    tree = opened("glass-ball", worlds)
    inside = next(i for i in tree.children[0] if tree.kind(i) == "refraction")
    out = next(i for i in tree.children[inside] if tree.kind(i) == "refraction")
    assert [tree.object_name(i) for i in (0, inside, out)] == ["glass ball", "glass ball", "table"]
    assert tree.nodes["n1"][inside] == 1.52


def test_cut_stone_holds_light_by_total_internal_reflection(worlds: dict[str, tracer.World]) -> None:
    kinds = set()
    for x in range(560, 680, 8):
        tree = tracer.trace(worlds["glass-ball"], (x, 320), depth=4)
        if tree.object_name(0) == "cut stone":
            kinds |= {tree.kind(i) for i in range(len(tree))}
    assert "tir" in kinds


def test_water_is_beyond_the_critical_angle(worlds: dict[str, tracer.World]) -> None:
    tree = opened("underwater", worlds)
    assert tree.object_name(0) == "water"
    assert tree.nodes["n1"][0] == 1.33
    assert tree.nodes["radicand"][0] < 0.0
    assert tree.kind(tree.children[0][-1]) == "tir"


def test_plates_have_a_bound_on_the_missing_light_until_they_glow(worlds: dict[str, tracer.World]) -> None:
    """The last step says so; and six faces send back 1/5 of the sky, straight on, with an exact tree."""
    steps = lesson.read("plates").steps
    bounds = []
    for step in steps:
        world = tracer.prepare(tracer.load(step.scene, changes=step.state.set))
        bounds.append(tracer.trace(world, step.state.pixel, depth=2).bound)
    assert np.isinf(bounds).tolist() == [False, False, False, False, True]
    straight = tracer.prepare(tracer.load(steps[3].scene, changes=steps[3].state.set))
    tree = tracer.trace(straight, steps[3].state.pixel, missing=1e-4)
    assert np.abs(tree.radiance - np.array(straight.scene.background.color) / 5.0).max() <= 1e-4


def test_floor_under_the_table_sees_no_light(worlds: dict[str, tracer.World]) -> None:
    tree = opened("two-lights", worlds)
    assert tree.object_name(0) == "floor"
    shadows = [i for i in tree.children[0] if tree.kind(i) == "shadow"]
    assert [tree.end(i) for i in shadows] == ["blocked", "blocked"]
    found = set()
    for x in range(200, 600, 10):
        floor = tracer.trace(worlds["two-lights"], (x, 470), depth=0)
        found.add(tuple((floor.light_name(i), floor.end(i)) for i in floor.children[0]))
    for pair in ((("lamp", "lit"), ("lantern", "blocked")), (("lamp", "blocked"), ("lantern", "lit"))):
        assert pair in found, "a pixel that sees only one of the lights"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("no data", "a lesson begins with its data"),
        ("+++\ntitle = \n+++\nx", 'line 2: not TOML: invalid value, got "title ="'),
        ("+++\nscene = 'scene.toml'\n+++\nx", "title is missing"),
        ("+++\ntitle = 'x'\npixle = [1, 2]\n+++\nx", 'unknown key "pixle" (did you mean "pixel"?)'),
        ("+++\ntitle = 'x'\npixel = [1, -2]\n+++\nx", "pixel must be two whole numbers"),
        ("+++\ntitle = 'x'\n[view]\nelevation = 95\n+++\nx", "elevation must be > -90 and < 90, got 95"),
        ("+++\ntitle = 'x'\nview = 1\n+++\nx", "view must be a table, got 1"),
        ("+++\ntitle = 'x'\nview = [[1]]\n+++\nx", "view must be a table, got [[1]]"),
        ("+++\ntitle = 'x'\nscene = 1\n+++\nx", "scene must be"),
        (f"+++\ntitle = {'[' * 5000}\n+++\nx", "nested too deeply"),
        (
            "+++\ntitle = 'x'\n+++\nThe cone\nof cafés".encode("latin-1"),
            "line 5: a lesson is UTF-8 text, got something",
        ),
    ],
)
def test_faults_of_a_lesson(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str | bytes, said: str) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "lesson.md").write_bytes(text if isinstance(text, bytes) else text.encode("utf-8"))
    (tmp_path / "ORDER").write_text("")
    monkeypatch.setattr(lesson, "folder", lambda: tmp_path)
    with pytest.raises(Unusable) as caught:
        lesson.read("mine")
    assert any(said in fault for fault in caught.value.faults)


def test_a_lesson_may_come_from_a_windows_editor(tmp_path: Path) -> None:
    """A byte order mark, and lines that end with a carriage return."""
    source = ROOT / "lessons" / "mirror-balls" / "lesson.md"
    plain = lesson.read_file(source)
    copy = tmp_path / "lesson.md"
    copy.write_bytes(b"\xef\xbb\xbf" + source.read_bytes().replace(b"\n", b"\r\n"))
    found = lesson.read_file(copy)
    assert (found.title, found.first.parts, found.first.state) == (plain.title, plain.first.parts, plain.first.state)


def test_a_lesson_that_is_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "lesson.md")
    with pytest.raises(Unusable, match="must be a file, got a pipe"):
        lesson.read_file(tmp_path / "lesson.md")


@pytest.mark.parametrize("name", ALL_LESSONS)
def test_nothing_is_wrong_with_a_lesson(name: str) -> None:
    """All that it expects holds, and all that its text names is there."""
    assert check(lesson.read(name).path) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL_LESSONS)
def test_the_text_of_a_lesson_has_room_in_the_hall(name: str) -> None:
    assert room_faults(lesson.read(name).path) == []

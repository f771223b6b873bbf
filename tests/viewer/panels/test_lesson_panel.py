"""The panel of a lesson: the task of a step is ticked off while it is reached; marks of live pieces are clicked."""

import math
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.viewer.driver import Driver, viewer
from viewer.base.theme import Color
from viewer.figures.marks import Box, Disc, Text
from viewer.lessons.expectation import conditions
from viewer.lessons.lesson import read_file
from viewer.lessons.live.pieces.samples import sample_points
from viewer.lessons.moments import Moment
from viewer.lessons.skeleton import SCENE
from viewer.session.layout import Corner

TEXT = """\
+++
title = "Mine"
question = "Why?"
pixel = [160, 150]
+++
## Your turn
```step
panels = ["scene"]
goal = { object = "floor", children = [] }
```
Find the floor.
"""


def accents(driver: Driver) -> int:
    """The pixels of the colour of ticks in the panel of the lesson."""
    return count(driver, driver.session.appearance.theme.accent)


def count(driver: Driver, ink: Color) -> int:
    """The pixels of a colour in the panel of the lesson."""
    driver.session.notice.text = ""
    driver.frames()
    color = 255.0 * np.array(ink[:3])
    left, top, width, height = map(round, driver.app.tiles.places[Corner.TOP_RIGHT])
    picture = driver.picture()[top : top + height, left : left + width]
    return int((np.abs(picture - color).max(axis=2) < 3.0).sum())


def test_a_goal_is_ticked_off_while_it_holds(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    (tmp_path / "lesson.md").write_text(TEXT, "utf-8")
    lesson = read_file(tmp_path / "lesson.md")
    with viewer() as driver:
        session = driver.session
        session.player.show(lesson, Moment())
        driver.app.settle()

        def holds() -> list[tuple[str, bool]]:
            found = conditions(lesson.first.state.goal, session.tree, session.player.hit)
            return [(condition.words, condition.holds) for condition in found]

        words = ["the ray meets floor", "no ray goes on"]
        assert holds() == list(zip(words, (False, False), strict=True))
        before = accents(driver)
        session.pick(160, 200)
        assert holds() == list(zip(words, (True, True), strict=True))
        assert accents(driver) > before + 100  # two discs with ticks
        session.pick(160, 150)
        assert accents(driver) == before
        session.select(session.tree.find("R") if session.tree else None)
        assert holds() == list(zip(words, (True, True), strict=True))  # the selected ray meets the floor


def test_conditions_in_words() -> None:
    goal = {"children": ["I"], "theta1": "48.7", "n2": "1", "TR": {"object": "ball"}, "R.end": "background"}
    assert [one.words for one in conditions(goal, None, None)] == [
        "total internal reflection", "θ₁ = 48.7°", "n₂ = 1", "TR meets ball", "R ends: background",
    ]  # fmt: skip
    assert not any(one.holds or one.now for one in conditions(goal, None, None))


def test_a_goal_has_the_number_of_the_hit_on_show(worlds: dict[str, tracer.World]) -> None:
    """With a digit more than the one that is asked for; no number once it is reached."""
    tree = tracer.trace(worlds["drop"], (400, 300))
    theta1 = math.degrees(math.asin(0.8))
    for goal, now in (
        ({"theta1": "48.7"}, f"{theta1:.2f}°"),
        ({"theta1": "60"}, f"{theta1:.1f}°"),
        ({"theta1": "53"}, ""),
    ):
        (found,) = conditions(goal, tree, "E")
        assert (found.now, found.holds) == (now, not now)
    assert [one.now for one in conditions({"children": ["I"], "object": "moon"}, tree, "E")] == ["", ""]


def clicked(driver: Driver, name: str) -> None:
    """Click the middle of a mark of the live piece on show."""
    ((line, (left, top, scale)),) = driver.canvas.live_places.items()
    mark = next(mark for mark in driver.canvas.live[line].last if mark.name == name and isinstance(mark, (Box, Disc)))
    driver.click(left + scale * mark.center[0], top + scale * mark.center[1])


def show(driver: Driver, folder: Path, piece: str, scene: str = SCENE) -> None:
    (folder / "scene.toml").write_text(scene, "utf-8")
    head, _, _ = TEXT.partition("## Your turn")
    (folder / "lesson.md").write_text(f"{head}## One\n```live\n{piece}\n```\n", "utf-8")
    driver.session.player.show(read_file(folder / "lesson.md"), Moment())
    driver.app.settle()


def test_a_click_on_a_medium_sets_the_indices(tmp_path: Path) -> None:
    with viewer() as driver:
        show(driver, tmp_path, "media")
        clicked(driver, "medium-glass")
        assert driver.session.player.parameters == {"n": 1.52, "n2": 1.52}
        clicked(driver, "medium-water")
        assert driver.session.player.parameters == {"n": 1.33, "n2": 1.33}


def test_a_click_on_a_sample_shows_its_tree(tmp_path: Path) -> None:
    """The point of the piece is that of the tree; a scene whose pixels have one sample says so."""
    scene = SCENE.replace("width = 320", "samples = 9\nwidth = 320")
    with viewer() as driver:
        show(driver, tmp_path, "samples", scene)
        session = driver.session
        for k in (5, 2):
            clicked(driver, f"sample-{k}")
            assert session.tree and session.tree.sample == k
            x, y = sample_points(160, 150, 9)[k]
            assert session.tree.image_point == pytest.approx((160 + x, 150 + y), abs=1e-12)
        (tmp_path / "other").mkdir()
        show(driver, tmp_path / "other", "samples 9")
        clicked(driver, "sample-5")
        assert session.tree and session.tree.sample is None and "has one sample" in session.notice.text


def test_a_piece_has_the_room_that_the_text_below_leaves(tmp_path: Path) -> None:
    """It keeps its size when hidden text appears, and the text needs no scrolling."""
    with viewer() as driver:
        driver.session.appearance.toggle_lecture_size()
        show(driver, tmp_path, "snell 1.33 1\n```\n???\nFirst.\n\n$$x = 1$$\n???\n```code\none" + 2 * "\ntwo")
        seen = []
        for _ in range(3):
            driver.frames()
            seen.append(caption(driver))
            assert driver.session.player.lines_too_many == 0
            driver.session.player.go(1)
            driver.app.settle()
        assert seen[0] == seen[1] == seen[2]
        show(driver, tmp_path, "snell 1.33 1")
        assert caption(driver) > seen[0] + 20.0


def caption(driver: Driver) -> float:
    """The height of the caption below the live piece on show, in points from the top of the piece."""
    (line,) = driver.canvas.live_places
    return next(
        mark.at[1] for mark in driver.canvas.live[line].last if isinstance(mark, Text) and mark.name == "caption"
    )


def test_a_link_has_the_colour_of_its_kind_without_its_ray(tmp_path: Path) -> None:
    with viewer() as driver:
        (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
        (tmp_path / "lesson.md").write_text(TEXT.replace("Find the floor.", "[Find the floor](#T)"), "utf-8")
        driver.session.player.show(read_file(tmp_path / "lesson.md"), Moment())
        driver.app.settle()
        assert driver.session.tree and driver.session.tree.find("T") is None
        assert count(driver, driver.session.appearance.theme.ray("refraction")) > 50

"""The panel of a lesson: the task of a step is ticked off while it is reached."""

from pathlib import Path

import numpy as np

from tests.viewer.driver import Driver, viewer
from viewer.lessons.expectation import conditions
from viewer.lessons.lesson import read_file
from viewer.lessons.moments import Moment
from viewer.lessons.skeleton import SCENE

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
    """The pixels of the colour of ticks in the right third of the window, where the lesson stands."""
    driver.session.notice.text = ""
    driver.frames()
    color = 255.0 * np.array(driver.session.appearance.theme.accent[:3])
    picture = driver.picture()[60:-60, 860:]
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
    assert not any(one.holds for one in conditions(goal, None, None))

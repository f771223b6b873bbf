"""The stages of a reveal are the same in the window, at its presses, and on paper. None looks like the one before."""

from pathlib import Path

import pytest

from tests.viewer.driver import viewer
from tests.viewer.handout.sample import SCENE
from viewer.figures.marks import CANVAS
from viewer.figures.steps import of_kinds
from viewer.handout.document import Room, paper
from viewer.handout.reading import read_handout
from viewer.lessons.lesson import read_file
from viewer.lessons.moments import Moment

LESSON = """+++
title = "Glass"
question = "Why?"
pixel = [30, 18]
panels = ["tree"]
show = {}
+++
## One

```step
reveal = "{}"
```
"""
# The tree of the pixel at depth 2: E with R and T; T with TR and TT. All but one of the hits have a ray to the lamp.
STAGES = {
    ("rays", "camera,reflection,refraction,shadow"): [1, 2, 3, 4, 5, 6, 7, 8, 9],
    ("rays", "camera,refraction"): [1, 2, 3],
    ("rays", "reflection"): [1, 2],  # the camera ray is always there; TR is below a ray that is hidden
    ("rays", "shadow"): [1, 2],
    ("colour", "camera,refraction"): [(3, 0), (3, 1), (3, 2), (3, 3)],
    ("colour", "camera,reflection"): [(2, 0), (2, 1), (2, 2)],
    ("depth", "camera,refraction"): [1, 2, 3],
}


@pytest.mark.parametrize(("reveal", "kinds"), STAGES)
def test_the_window_and_the_paper_have_the_same_stages(tmp_path: Path, reveal: str, kinds: str) -> None:
    (tmp_path / "scene.toml").write_text(SCENE.replace("EVIL", '"ball"'), "utf-8")
    text = LESSON.format(kinds.split(","), reveal)
    (tmp_path / "lesson.md").write_text(text, "utf-8")
    lesson = read_file(tmp_path / "lesson.md")
    page = read_handout(lesson).pages[0]
    drawn = page.show.pictures[0].draw(Room(CANVAS, 18.0, paper("light")), page.stages)
    on_paper = [
        {int(m.name[4:]) for m in marks if m.name.startswith("hit-") and m.name[4:].isdigit()} for marks in drawn
    ]
    in_window = []
    with viewer() as driver:
        driver.session.player.show(lesson, Moment())
        driver.app.settle()
        for press in range(driver.session.player.stages):
            driver.session.player.show(lesson, Moment(0, press))
            driver.app.settle()
            assert driver.session.player.moment == Moment(0, press)
            assert driver.session.tree
            in_window.append(of_kinds(driver.canvas.step(driver.session.tree), driver.session.shown.kinds))
    counted = [len(step.rows) for step in in_window]
    if reveal == "colour":
        counted = [(len(step.rows), len(step.summed & step.rows)) for step in in_window]
    assert counted == STAGES[reveal, kinds]
    kept = [{row for row in step.rows if step.tree.kind(row) != "shadow"} for step in in_window]
    assert on_paper == kept

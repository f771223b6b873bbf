"""A lesson with steps of every kind, and the window in which it is given."""

import numpy as np

from tests.viewer.driver import Driver
from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import Moment

TEXT = """\
+++
title = "Mine"
question = "Why?"
pixel = [160, 150]
+++
## One
```step
hit = "R"
```
Seen: {t}.
???
Hidden.
## Two
```step
reveal = "depth"
depth = 2
set = { material.mirror.reflect = 0.4 }
view = { azimuth = 10 }
panels = ["scene", "tree", "image"]
```
Text.
???
More.
## Three
```step
reveal = "rays"
show = ["camera", "reflection"]
set = {}
```
## Four
```step
reveal = "colour"
model = "fresnel"
```
## Five
```step
sweep = { of = "pixel", from = [160, 150], to = [167, 153] }
```
Watch.
???
Seen.
## Six
```step
sweep = { of = "material.mirror.reflect", from = 0.2, to = 0.9 }
```
"""


def begin(driver: Driver, lesson: Lesson) -> None:
    driver.session.player.show(lesson, Moment())
    driver.app.settle()


def picture(driver: Driver) -> np.ndarray:
    """The window at rest, without notices, the bar with its times, and the mouse."""
    driver.app.settle()
    driver.session.notice.text = ""
    driver.frames(4)
    return driver.app.surface.grab()[:-40].copy()

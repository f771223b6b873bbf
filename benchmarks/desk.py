"""The viewer in a real window, watched: a process of its own that prints what it found as JSON.

`python -m benchmarks.desk SCENE RUNS`. The loop is the viewer's own (`App.run`); only its frames are timed. For frames
without an image in the making a hand moves the mouse over the window, since the viewer draws none on its own, at the
pace at which frames came while one was made.
"""

import faulthandler
import json
import statistics
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

from imgui_bundle import imgui

import tracer
from tests.viewer.screen import screen
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import Window

SIZE = (1280, 720)
FEWEST = 10  # frames at rest
SETTLED = 1.0  # seconds after which the last frames that anything asked for are drawn
PATIENCE = 30.0  # seconds a run, which takes some six
IDLE = 3.0  # seconds


class Desk(App):
    """The viewer, noting how long its frames take; it leaves its loop when `enough` says so after a frame."""

    def __init__(self, scene: Path) -> None:
        super().__init__(Window("raytree", SIZE), Session())
        self.took: list[float] = []
        self.enough: Callable[[], bool] = lambda: False
        self.over = False
        self.session.open(scene)
        self.settle()

    def frame(self) -> None:
        began = time.perf_counter()
        super().frame()
        self.took.append(time.perf_counter() - began)
        self.over = self.enough()

    def is_over(self) -> bool:
        return self.over

    def watch(self, enough: Callable[[], bool]) -> list[float]:
        """Run until there is enough; the seconds of each frame."""
        self.took, self.enough, self.over = [], enough, False
        self.run()
        return self.took

    def frames_at_rest(self, count: int, pause: float) -> float:
        """The median frame while a hand moves the mouse every `pause` seconds and nothing else happens."""

        def moved() -> bool:
            k = len(self.took)
            time.sleep(pause)  # the hand's pace: nothing is waited for
            imgui.get_io().add_mouse_pos_event(600.0 + k % 2, 200.0)
            return k >= count

        return statistics.median(self.watch(moved))

    def image_in_window(self) -> tuple[float, list[float]]:
        """(seconds of an image, the frames drawn meanwhile)."""
        session = self.session
        session.image.forget()
        session.update()
        picture = session.image.picture
        assert picture and not picture.finished
        frames = self.watch(lambda: picture.finished)
        return picture.seconds, frames

    def image_alone(self) -> float:
        world = self.session.world
        assert world
        return tracer.render(world, depth=self.session.depth, model=self.session.model).seconds["trace"]

    def share_at_rest(self) -> float:
        """Of one core, while nothing happens."""
        over = threading.Event()
        times: list[tuple[float, float]] = []

        def look() -> None:
            times.append((time.perf_counter(), time.process_time()))

        def leave() -> None:
            look()
            over.set()
            self.over = True
            self.surface.wake()

        timers = [threading.Timer(SETTLED, look), threading.Timer(SETTLED + IDLE, leave)]
        for timer in timers:
            timer.start()
        self.watch(over.is_set)
        for timer in timers:
            timer.join()
        (began, used_before), (ended, used_after) = times
        return (used_after - used_before) / (ended - began)


def main() -> None:
    faulthandler.dump_traceback_later(PATIENCE * (int(sys.argv[2]) + 1), exit=True)  # says where it hangs
    screen()
    desk = Desk(Path(sys.argv[1]))
    found: dict[str, list[float]] = {name: [] for name in ("rest", "busy", "windowed", "alone", "idle")}
    for run in range(int(sys.argv[2]) + 1):
        windowed, busy = desk.image_in_window()
        pause = max(0.0, (windowed - sum(busy)) / len(busy))  # as while the image rendered: caches forget meanwhile
        rest = desk.frames_at_rest(FEWEST + len(busy), pause)
        row = (rest, statistics.median(busy), windowed, desk.image_alone(), desk.share_at_rest())
        if run:  # the first only warms up
            for values, value in zip(found.values(), row, strict=True):
                values.append(value)
    desk.close()
    print(json.dumps(found))


if __name__ == "__main__":
    main()

"""Frame times of the viewer in a real window: a process of its own that prints its results as JSON.

`python -m benchmarks.desk SCENE RUNS`. The loop is the viewer's own (`App.run`); only its frames are timed. The
viewer draws no frame without an event, so for frames at rest xdotool moves the mouse over the window, at the rate of
the frames during rendering.
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
SETTLED = 1.0  # seconds, after which no frame is left to draw
PATIENCE = 30.0  # seconds for a run, which takes about six
IDLE = 3.0  # seconds


class Desk(App):
    """The viewer with a record of its frame times. It leaves its loop when `enough` says so after a frame."""

    def __init__(self, scene: Path) -> None:
        super().__init__(Window("raytree", SIZE), Session())
        self.took: list[float] = []
        self.enough: Callable[[], bool] = lambda: False
        self.over = False
        self.session.loader.open(scene)
        self.settle()

    def frame(self) -> None:
        began = time.perf_counter()
        super().frame()
        self.took.append(time.perf_counter() - began)
        self.over = self.enough()

    def is_over(self) -> bool:
        return self.over

    def watch(self, enough: Callable[[], bool]) -> list[float]:
        """Run until `enough`; return the seconds of each frame."""
        self.took, self.enough, self.over = [], enough, False
        self.run()
        return self.took

    def frames_at_rest(self, count: int, pause: float) -> float:
        """The median frame time while the mouse moves every `pause` seconds and nothing else happens."""

        def moved() -> bool:
            k = len(self.took)
            time.sleep(pause)  # the pace of the mouse: nothing is waited for
            imgui.get_io().add_mouse_pos_event(600.0 + k % 2, 200.0)
            return k >= count

        return statistics.median(self.watch(moved))

    def image_in_window(self) -> tuple[float, list[float]]:
        """(seconds of an image, times of the frames drawn meanwhile)."""
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
        """CPU time at rest, as a share of one core."""
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
    faulthandler.dump_traceback_later(PATIENCE * (int(sys.argv[2]) + 1), exit=True)  # prints where it hangs
    screen()
    desk = Desk(Path(sys.argv[1]))
    found: dict[str, list[float]] = {name: [] for name in ("rest", "busy", "windowed", "alone", "idle")}
    for run in range(int(sys.argv[2]) + 1):
        windowed, busy = desk.image_in_window()
        # the same rate of frames as during rendering, for the same state of the caches
        pause = max(0.0, (windowed - sum(busy)) / len(busy))
        rest = desk.frames_at_rest(FEWEST + len(busy), pause)
        row = (rest, statistics.median(busy), windowed, desk.image_alone(), desk.share_at_rest())
        if run:  # the first run only warms up
            for values, value in zip(found.values(), row, strict=True):
                values.append(value)
    desk.close()
    print(json.dumps(found))


if __name__ == "__main__":
    main()

"""A pick: from the mouse button to the finished picture, in a real window on a screen without a monitor.

The scene is the lesson `panes`, deep enough that the trees of its middle pixels have some 500 rows. The image is at
rest. The clock stops when OpenGL has finished the frame that shows the new tree, and the frame is on the screen. Our
own share is the processor time of the window's thread without OpenGL's calls: Python, numpy, the tracer, and imgui's
lists of what is to be drawn.

`python -m benchmarks.pick WIDTH HEIGHT RUNS` prints the seconds as JSON. It runs in a process of its own.
"""

import faulthandler
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Callable

# isort: off
import glfw

# isort: on
import moderngl
from imgui_bundle import imgui
from imgui_bundle.imgui import backends

from benchmarks.results.figure import Figure, Spread
from benchmarks.results.task import Options, Task
from tests.viewer.screen import hand, missing, screen
from tracer.processes import python_command
from viewer.lessons import lesson
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import Window

LESSON, DEPTH = "panes", 10
PICKS = 20  # a run
SIZES = {(1280, 720): 33.0, (1600, 900): 50.0}  # of the window, and milliseconds allowed
OWN_MOST = 4.0  # milliseconds
PATIENCE = 60.0  # seconds for a run


def picks(options: Options) -> list[Task]:
    def measure(size: tuple[int, int]) -> list[Figure]:
        if missing():
            raise RuntimeError(f"a screen is needed: the Debian packages {', '.join(missing())}")
        command = python_command("from benchmarks.pick import main; main()")
        run = subprocess.run([*command, *map(str, (*size, options.runs))], capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise RuntimeError(run.stderr.strip()[-2000:])
        found = json.loads(run.stdout)
        whole, own = ([1e3 * value for value in found[name]] for name in ("whole", "own"))
        where = f"{size[0]}x{size[1]}, {found['rows']} rays"
        return [
            Figure("pick", f"to the picture, {where}", "ms", Spread.of(whole), wanted=SIZES[size], at_least=False),
            Figure("pick", f"without OpenGL, {where}", "ms", Spread.of(own), wanted=OWN_MOST, at_least=False),
        ]

    return [Task(f"{w}x{h}", 12.0 + 3.0 * options.runs, lambda size=(w, h): measure(size)) for w, h in SIZES]


class GLClock:
    """The processor time of this thread in OpenGL's calls. It counts from the moment that it is made."""

    def __init__(self) -> None:
        self.seconds = 0.0
        for owner, names in (
            (moderngl.VertexArray, ("render",)),
            (moderngl.Context, ("copy_framebuffer", "finish")),
            (moderngl.Framebuffer, ("use", "clear")),
            (moderngl.Buffer, ("write",)),
            (moderngl.Texture, ("write", "read")),
            (backends, ("opengl3_render_draw_data",)),
            (glfw, ("swap_buffers",)),
        ):
            for name in names:
                setattr(owner, name, self._timed(getattr(owner, name)))

    def _timed(self, call: Callable[..., object]) -> Callable[..., object]:
        def timed(*arguments: object, **named: object) -> object:
            began = time.thread_time()
            try:
                return call(*arguments, **named)
            finally:
                self.seconds += time.thread_time() - began

        return timed


class Picker(App):
    """The viewer at rest, in which pixels are picked."""

    def __init__(self, size: tuple[int, int]) -> None:
        surface = Window("raytree", size)
        super().__init__(surface, Session())
        self.window = surface.window
        self.clock = GLClock()
        imgui.get_io().mouse_double_click_time = 0.0  # picks follow each other fast
        found = lesson.read(LESSON)
        self.session.loader.open(found.scene, found)
        self.settle()
        self.session.set_depth(DEPTH)
        self.settle()

    def pick(self, x: int, y: int) -> tuple[float, float]:
        """Click a pixel of the image: (seconds to the picture, seconds of them without OpenGL)."""
        left, top, scale = self.canvas.image_place
        io = imgui.get_io()
        place = (round(left + (x + 0.5) * scale), round(top + (y + 0.5) * scale))
        hand("mousemove", *map(sum, zip(glfw.get_window_pos(self.window), place, strict=True)))
        while tuple(io.mouse_pos) != place:
            self.step()
        self.rest()
        before, in_gl = self.session.tree, self.clock.seconds
        began, used = time.perf_counter(), time.thread_time()
        io.add_mouse_button_event(0, True)
        while self.canvas.tree is before:
            self.step()
        took, used = time.perf_counter() - began, time.thread_time() - used
        in_gl = self.clock.seconds - in_gl
        io.add_mouse_button_event(0, False)
        self.rest()
        return took, used - in_gl

    def step(self) -> None:
        self.surface.wait(0.0)
        self.session.update()
        self.frame()
        self.surface.ctx.finish()

    def rest(self) -> None:
        for _ in range(3):
            self.step()


def main() -> None:
    width, height, runs = map(int, sys.argv[1:])
    faulthandler.dump_traceback_later(PATIENCE * (runs + 1), exit=True)  # prints where it hangs
    screen()
    picker = Picker((width, height))
    found: dict[str, list[float]] = {"whole": [], "own": []}
    rows = []
    for run in range(runs + 1):
        took = []
        for k in range(PICKS):
            took.append(picker.pick(350 + 5 * k, 296 + run % 3))
            rows.append(len(picker.session.tree or ()))
        if run:  # the first run only warms up
            for values, column in zip(found.values(), zip(*took, strict=True), strict=True):
                values.append(statistics.median(column))
    picker.close()
    print(json.dumps({**found, "rows": int(statistics.median(rows))}))


if __name__ == "__main__":
    main()

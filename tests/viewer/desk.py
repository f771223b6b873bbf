"""A viewer in a real window, used by a real mouse and real keys (`tests.viewer.screen`)."""

import sys
from collections.abc import Callable
from pathlib import Path

import glfw
import numpy as np
import pytest

from tests.viewer.screen import missing, screen
from viewer.lessons import lesson
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import Window

LINUX_ONLY = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="X servers without a monitor are Linux's")


def start_screen() -> None:
    """Start the display of this process, if it has not started yet."""
    assert not missing(), f"these tests need the Debian packages {', '.join(missing())}"
    screen()


class Desk:
    """A viewer in its window, and the means to use it by mouse and keys."""

    def __init__(self, name: str) -> None:
        start_screen()
        self.window = Window("raytree", (1280, 720))
        self.app = App(self.window, Session())
        self.session = self.app.session
        found = lesson.read(name)
        self.session.loader.open(found.scene, found)
        self.app.settle()
        self.until(lambda: self.is_quiet(), "the first image")
        self.id = glfw.get_x11_window(self.window.window)

    def until(self, true: Callable[[], bool], what: str, rounds: int = 600) -> None:
        """Handle events until a condition is true. A condition that never becomes true is a failure, not a matter of
        time. A long image needs more rounds.
        """
        for _ in range(rounds):
            self.window.wait(0.02)
            self.session.update()
            if not self.window.minimised:
                self.app.frame()
            assert self.window.ctx.error == "GL_NO_ERROR"
            assert not self.session.guard.caught
            if true():
                return
        pytest.fail(f"never came: {what}")

    def is_quiet(self) -> bool:
        picture = self.session.image.picture
        return picture is not None and picture.finished and self.session.tree is not None

    def place(self) -> tuple[int, int]:
        """The position of the window's client area on the screen."""
        return glfw.get_window_pos(self.window.window)

    def pixel_at(self, x: int, y: int) -> tuple[int, int]:
        left, top, scale = self.app.canvas.image_place
        px, py = self.place()
        return round(px + left + (x + 0.5) * scale), round(py + top + (y + 0.5) * scale)

    def size(self) -> tuple[int, int]:
        return glfw.get_window_size(self.window.window)

    def window_picture(self) -> np.ndarray:
        """The last frame."""
        return self.window.grab()

    @staticmethod
    def scene_of(name: str) -> Path:
        """The scene's file of a lesson."""
        return lesson.read(name).scene

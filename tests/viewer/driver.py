"""Drives the viewer without a screen: real GL, real panels, events put into imgui's own queue."""

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.base.orbit import project
from viewer.figures.marks import Mark, Text
from viewer.lessons import lesson
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import Offscreen


class Driver:
    """One viewer. Every action draws enough frames to take effect."""

    def __init__(self, size: tuple[int, int] = (1280, 720), languages: Sequence[str] | None = None) -> None:
        self.app = App(Offscreen(size), Session(languages))
        self.session = self.app.session
        self.canvas = self.app.canvas
        self.provokes = False  # exceptions in the window, which are failures otherwise

    def open(self, name: str) -> None:
        found = lesson.read(name)
        self.session.loader.open(found.scene, found)
        self.app.settle()

    def open_file(self, path: Path) -> None:
        self.session.loader.open(path)
        self.app.settle()

    def resize(self, size: tuple[int, int]) -> None:
        assert isinstance(self.app.surface, Offscreen)
        self.app.surface.resize(size)
        self.frames()

    def frames(self, count: int = 2) -> None:
        for _ in range(count):
            self.session.update()
            self.app.frame()
            assert self.app.surface.ctx.error == "GL_NO_ERROR"
            assert self.provokes or not self.session.guard.caught, self.session.guard.caught

    def move(self, x: float, y: float) -> None:
        imgui.get_io().add_mouse_pos_event(x, y)
        self.frames(1)

    def button(self, down: bool, which: int = 0) -> None:
        imgui.get_io().add_mouse_button_event(which, down)
        self.frames(1)

    def click(self, x: float, y: float) -> None:
        self.move(x, y)
        self.button(True)
        self.button(False)
        self.frames()

    def drag(self, places: list[tuple[float, float]], which: int = 0) -> None:
        self.move(*places[0])
        self.button(True, which)
        for place in places[1:]:
            self.move(*place)
        self.button(False, which)
        self.frames()

    def wheel(self, x: float, y: float, steps: float) -> None:
        self.move(x, y)
        imgui.get_io().add_mouse_wheel_event(0.0, steps)
        self.frames(3)

    def type(self, text: str) -> None:
        for character in text:
            imgui.get_io().add_input_character(ord(character))
            self.frames()

    def press(self, *keys: imgui.Key) -> None:
        """Hold all keys but the last, press and release the last one, then release the others."""
        io = imgui.get_io()
        for key in keys:
            io.add_key_event(key, True)
        self.frames(2)
        for key in reversed(keys):
            io.add_key_event(key, False)
        self.frames(2)

    def unpick(self) -> None:
        """As in a scene that was opened without a pixel."""
        session = self.session
        session.pixel = session.tree = session.full_tree = None
        self.frames()

    def aims_at(self, x: int, y: int) -> bool:
        """True if the picked pixel is within a mouse step of (x, y)."""
        picked = self.session.pixel
        step = max(0.5, 0.5 / self.canvas.image_place[2]) + 0.5
        return picked is not None and max(abs(picked[0] - x), abs(picked[1] - y)) <= 2 * step - 0.5

    def pixel_at(self, x: int, y: int) -> tuple[float, float]:
        """The screen position of the centre of an image's pixel."""
        left, top, scale = self.canvas.image_place
        return left + (x + 0.5) * scale, top + (y + 0.5) * scale

    def ray_at(self, row: int, share: float = 0.5) -> tuple[float, float]:
        """The screen position of a point of a ray in the 3D view, `share` of its way along."""
        line = next(line for line in self.canvas.lines if line.row == row)
        left, top, width, height = self.canvas.stage_place
        matrix = self.session.orbit.framed(width / height).matrix(width / height)
        point = line.start + share * (line.end - line.start)
        places, _ = project(point[None], matrix, (width, height))
        return left + places[0, 0], top + places[0, 1]

    def lone_place(self, row: int) -> tuple[float, float] | None:
        """A screen position on a ray in the 3D view that no other ray is near, or None."""
        left, top, width, height = self.canvas.stage_place
        shares = np.linspace(0.0, 1.0, 200)
        matrix = self.session.orbit.framed(width / height).matrix(width / height)
        crowd, own = [], np.zeros((0, 2))
        for line in self.canvas.lines:
            points = line.start + shares[:, None] * (line.end - line.start)
            places, depths = project(points, matrix, (width, height))
            if line.row == row:
                own = places[depths > 0]
            else:
                crowd.append(places[depths > 0])
        others = np.concatenate(crowd)
        for x, y in own:
            alone = np.hypot(*(others - (x, y)).T).min() > 14
            if alone and 9 < x < width - 9 and 9 < y < height - 9:
                return left + float(x), top + float(y)
        return None

    def tree_marks(self) -> list[Mark]:
        """The marks of the tree panel."""
        return self.canvas.tree_marks.last

    def tree_texts(self) -> list[Text]:
        return [mark for mark in self.tree_marks() if isinstance(mark, Text)]

    def picture(self) -> np.ndarray:
        return self.app.surface.grab()


def are_equal(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two pictures of the window are equal, to one of 255 levels: a letter's place in the atlas of glyphs
    depends on what was drawn before, and its coordinates there are rounded.
    """
    return one.shape == other.shape and bool((np.abs(one.astype(int) - other) <= 1).all())


def body(title: str) -> internal.Window:
    """The part of a panel below its titles, which scrolls."""
    name = re.compile(rf"{title}/body_[0-9A-F]{{8}}")
    found = [window for window in imgui.get_current_context().windows if name.fullmatch(window.name)]
    assert len(found) == 1, title
    return found[0]


@contextmanager
def viewer(size: tuple[int, int] = (1280, 720), languages: Sequence[str] | None = None) -> Iterator[Driver]:
    driver = Driver(size, languages)
    try:
        yield driver
    finally:
        assert driver.app.surface.ctx.error == "GL_NO_ERROR"
        driver.app.close()


@contextmanager
def viewer_of(path: Path, scene: str) -> Iterator[Driver]:
    """A viewer on a scene file with this text."""
    path.write_text(scene)
    with viewer() as driver:
        driver.open_file(path)
        yield driver

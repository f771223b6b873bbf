"""Panels: their title, how they are drawn, and where they stand."""

from collections.abc import Callable
from dataclasses import dataclass

from viewer.gl.canvas import Canvas
from viewer.session.layout import Corner, place_of
from viewer.session.session import Session
from viewer.session.view_state import Request


@dataclass(frozen=True)
class Panel:
    """A part of the window. `draw` is called every frame, between imgui's begin and end."""

    title: str
    draw: Callable[[Session, Canvas], None]
    fills: bool = False  # its picture fills the panel; otherwise it is text, which scrolls
    head: Callable[[Session, float], None] | None = None  # beside the title; it may be so many pixels wide
    head_room: Callable[[Session], float] = lambda session: 0.0  # that it needs, in text sizes
    is_named: bool = True  # whether its title is shown, where it stands alone
    short: str = ""  # its title where there is little room
    plate: Callable[[Session], str] | None = None  # words that lie on its picture; None: the title stands above it
    figure: str | None = None  # that it shows, or that is like it: its name in `viewer.figures.catalogue`
    shows_ray: bool = False  # whether it shows what is selected
    first: Callable[[Session, Canvas], None] | None = None  # is called before any panel is drawn
    request: Request | None = None  # that brings it to the front
    exists: Callable[[Session], bool] = lambda session: True

    @property
    def name(self) -> str:
        """Its name in options and in `viewer.session.layout`: the last word of the title."""
        return self.title.split()[-1].lower()

    @property
    def place(self) -> Corner:
        """Its place at the desk."""
        return place_of(self.name, is_lecture=False)

    def place_in(self, session: Session) -> Corner:
        return session.layout.place_in(self.name, session.appearance.is_lecture_size)

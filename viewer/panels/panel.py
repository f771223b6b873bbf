"""Panels: their title, how they are drawn, and where they stand."""

from collections.abc import Callable
from dataclasses import dataclass

from viewer.gl.canvas import Canvas
from viewer.session.layout import Corner
from viewer.session.session import Session
from viewer.session.view_state import Request


@dataclass(frozen=True)
class Panel:
    """A part of the window. `draw` is called every frame, between imgui's begin and end."""

    title: str
    draw: Callable[[Session, Canvas], None]
    place: Corner  # at the desk
    lecture_place: Corner | None = None  # in lecture mode, if it is another
    fills: bool = False  # its picture fills the panel, its title lies on it; otherwise it is text, which scrolls
    head: Callable[[Session, float], None] | None = None  # beside the title; it may be so many pixels wide
    is_named: bool = True  # whether its title is shown, where it stands alone
    short: str = ""  # its title where there is little room
    is_covered: bool = True  # whether the title may cover a part of the picture
    figure: str | None = None  # that it shows, or that is like it: its name in `viewer.figures.catalogue`
    shows_ray: bool = False  # whether it shows what is selected
    request: Request | None = None  # that brings it to the front
    exists: Callable[[Session], bool] = lambda session: True

    def place_in(self, session: Session) -> Corner:
        if session.appearance.is_lecture_size and self.lecture_place:
            return self.lecture_place
        return self.place

"""Panels: their title, how they are drawn, and where they stand."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto

from viewer.gl.canvas import Canvas
from viewer.session.session import Session
from viewer.session.view_state import Request


class Corner(Enum):
    """The corner in which a panel stands at first."""

    TOP_LEFT = auto()
    TOP_RIGHT = auto()
    BOTTOM_LEFT = auto()
    BOTTOM_RIGHT = auto()


@dataclass(frozen=True)
class Panel:
    """A part of the window. `draw` is called every frame, between imgui's begin and end."""

    title: str
    draw: Callable[[Session, Canvas], None]
    place: Corner
    padding: tuple[float, float] | None = None  # of a panel that fills its room and does not scroll; None: it scrolls
    request: Request | None = None  # that brings it to the front
    exists: Callable[[Session], bool] = lambda session: True

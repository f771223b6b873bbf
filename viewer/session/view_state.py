"""Small parts of a session's state: appearance, visibility, pan and zoom, a notice, requests to the window."""

import time
from dataclasses import dataclass, field
from enum import Enum, auto
from pathlib import Path

from tracer.printable import printable
from viewer.base.theme import DARK, LECTURE_ZOOM, LIGHT, STYLES, Theme
from viewer.reopen.view_state import LEFT
from viewer.session.layout import Layout

NOTICE_SECONDS = 6.0
MAX_ZOOM = 200.0


class Request(Enum):
    """A request of the session to the window."""

    SHOW_LESSON = auto()  # bring this panel to the front
    SHOW_RAY = auto()
    SHOW_ERROR = auto()
    SHOW_RECURSION = auto()
    MAXIMISE = auto()  # the panel under the mouse; again: give the room back
    NEXT_PANEL = auto()  # of those at the lower right
    OPEN_DIALOG = auto()
    COPY_VIEW = auto()  # as a command line with the window's size
    FULL_SCREEN = auto()  # or back
    SPEAKER = auto()  # the speaker's window; again: close it
    QUIT = auto()


class Pointer(Enum):
    """The sign that shows the mouse to the room."""

    NONE = auto()
    DISC = auto()
    SPOTLIGHT = auto()

    def next(self) -> "Pointer":
        kinds = list(Pointer)
        return kinds[(kinds.index(self) + 1) % len(kinds)]


@dataclass
class Appearance:
    """Colours and size of the user interface."""

    theme: Theme = DARK
    text_zoom: float = 1.0

    def toggle_theme(self) -> None:
        self.theme = LIGHT if self.theme is DARK else DARK

    @property
    def is_lecture_size(self) -> bool:
        return self.text_zoom > 1.0

    def toggle_lecture_size(self) -> None:
        """Enlarge the user interface, for a lecture hall."""
        self.text_zoom = 1.0 if self.is_lecture_size else LECTURE_ZOOM


@dataclass
class Visibility:
    """The visible parts of the 3D view and the panels."""

    kinds: set[str] = field(default_factory=lambda: set(STYLES))  # of rays
    camera: bool = True  # with its frustum, and the image on the image plane
    lights: bool = True
    normals: bool = True
    labels: bool = True

    @property
    def filter(self) -> tuple[str, ...] | None:
        """The kinds of rays on show, in their order; None: all."""
        return None if self.kinds == set(STYLES) else tuple(kind for kind in STYLES if kind in self.kinds)

    def toggle_kind(self, kind: str) -> None:
        """Show or hide a kind of rays."""
        self.kinds ^= {kind}


@dataclass
class PanZoom:
    """Pan and zoom of a 2D picture in its panel."""

    home: tuple[float, float] = (0.5, 0.5)  # the centre that fits the picture into its panel
    zoom: float = 1.0
    center: tuple[float, float] = field(init=False)

    def __post_init__(self) -> None:
        self.fit()

    def fit(self) -> None:
        """Fit the picture into its panel."""
        self.zoom, self.center = 1.0, self.home

    def move(self, dx: float, dy: float) -> None:
        self.center = (self.center[0] + dx, self.center[1] + dy)

    def zoom_about(self, at: tuple[float, float], steps: float) -> None:
        """Zoom so that the point `at` (as shares of the picture) stays where it is. Zoom 1 fills the panel."""
        zoom = min(MAX_ZOOM, max(1.0, self.zoom * 1.2**steps))
        share = 1.0 - self.zoom / zoom
        self.center = (
            self.center[0] + share * (at[0] - self.center[0]),
            self.center[1] + share * (at[1] - self.center[1]),
        )
        self.zoom = zoom
        if zoom == 1.0:
            self.fit()


@dataclass
class Notice:
    """A line about the last action, shown for some seconds."""

    text: str = ""
    ends: float = 0.0  # of time.monotonic()

    def say(self, text: str) -> None:
        self.text = printable(text)
        self.ends = time.monotonic() + NOTICE_SECONDS

    def expires(self) -> bool:
        """Remove the line if its time is up. Returns whether it was removed."""
        if self.text and time.monotonic() > self.ends:
            self.text = ""
            return True
        return False


@dataclass
class OpenDialog:
    """The dialog that opens a scene."""

    folder: Path | None = None  # whose files it lists
    not_found: str = ""  # a path that was typed and does not exist
    z_up: bool = False  # whether the z axis of a mesh file points upwards


@dataclass(eq=False)
class Looks:
    """The looks of the window: the part of a session that does not depend on the scene."""

    shown: Visibility = field(default_factory=Visibility)
    image_view: PanZoom = field(default_factory=PanZoom)
    tree_view: PanZoom = field(default_factory=lambda: PanZoom(home=(0.0, 0.0)))  # moved by logical pixels
    appearance: Appearance = field(default_factory=Appearance)
    layout: Layout = field(default_factory=Layout)
    notice: Notice = field(default_factory=Notice)
    dialog: OpenDialog = field(default_factory=OpenDialog)
    turn: float | None = None  # the angle of incidence at which the selected hit is shown, in degrees; None: its own
    pointer: Pointer = Pointer.NONE
    shows_help: bool = False
    inset: str = LEFT  # the corner of the scene with the image, if it lies there; or none
    is_blank: bool = False  # the window is black
    scroll: int = 0  # lines by which the texts are to be scrolled
    hovered: int | None = None  # the row of the tree under the mouse, in any view
    held_handle: str | None = None  # the name of the handle on which the mouse button went down

    def turn_back(self) -> None:
        """Show the selected hit as it was traced."""
        self.turn = None

"""What is switched on, how it is looked at, and what is said for a while: small parts of a session."""

import time
from dataclasses import dataclass, field

from viewer.base.theme import STYLES

STAYS = 6.0  # seconds that a notice is to be read


@dataclass
class Shown:
    """What of the 3D view and the panels is switched on."""

    kinds: set[str] = field(default_factory=lambda: set(STYLES))
    camera: bool = True  # with its frustum and the image on the image plane
    lights: bool = True
    normals: bool = True
    labels: bool = True


@dataclass
class Look:
    """How a flat picture is moved and enlarged in its panel."""

    zoom: float = 1.0
    center: tuple[float, float] = (0.5, 0.5)

    def move(self, dx: float, dy: float) -> None:
        self.center = (self.center[0] + dx, self.center[1] + dy)

    def zoom_about(self, at: tuple[float, float], steps: float) -> None:
        """Enlarge so that the place `at` (in shares of the picture) stays where it is; never smaller than the panel."""
        zoom = min(200.0, max(1.0, self.zoom * 1.2**steps))
        share = 1.0 - self.zoom / zoom
        self.center = (
            self.center[0] + share * (at[0] - self.center[0]),
            self.center[1] + share * (at[1] - self.center[1]),
        )
        self.zoom = zoom
        if zoom == 1.0:
            self.center = (0.5, 0.5)


@dataclass
class Notice:
    """What was last done, where nothing else shows it."""

    text: str = ""
    ends: float = 0.0  # of time.monotonic()

    def say(self, text: str) -> None:
        self.text = text
        self.ends = time.monotonic() + STAYS

    def passes(self) -> bool:
        """Whether it has just gone."""
        if self.text and time.monotonic() > self.ends:
            self.text = ""
            return True
        return False

"""The arrangement of the panels: two columns of two places each, of which any may be closed, or one panel on all of it.

Several panels can share a place; one of them is in front. At the desk, all four places are open. In lecture mode, the
scene and one place beside it are open, since type is large, and the image is an inset of the scene.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

Rectangle = tuple[float, float, float, float]  # left, top, width, height

GAP = 4.0  # between two places, in logical pixels
LEAST = 0.15  # the smallest share of a place


class Corner(Enum):
    """A place for panels."""

    TOP_LEFT = "top left"
    TOP_RIGHT = "top right"
    BOTTOM_LEFT = "bottom left"
    BOTTOM_RIGHT = "bottom right"


COLUMNS = ((Corner.TOP_LEFT, Corner.BOTTOM_LEFT), (Corner.TOP_RIGHT, Corner.BOTTOM_RIGHT))


@dataclass
class Arrangement:
    """The open places, and their shares of the room."""

    columns: float = 0.6  # share of the left column
    rows: list[float] = field(default_factory=lambda: [0.56, 0.52])  # share of the upper place in each column
    closed: set[Corner] = field(default_factory=set)
    front: dict[Corner, str] = field(default_factory=dict)  # title of the panel in front, where several share a place

    def split(self, which: int | None, share: float) -> None:
        """Move the border between the columns (None), or that between the two places of a column."""
        share = min(1.0 - LEAST, max(LEAST, share))
        if which is None:
            self.columns = share
        else:
            self.rows[which] = share

    def reset_split(self, which: int | None, at_first: "Arrangement") -> None:
        """Put a border back to where it is in another arrangement."""
        self.split(which, at_first.columns if which is None else at_first.rows[which])


def at_the_desk() -> Arrangement:
    return Arrangement()


def in_a_lecture() -> Arrangement:
    return Arrangement(columns=0.54, closed={Corner.TOP_RIGHT, Corner.BOTTOM_LEFT})


@dataclass
class Layout:
    """Both arrangements, and the panel that has all of the room."""

    desk: Arrangement = field(default_factory=at_the_desk)
    lecture: Arrangement = field(default_factory=in_a_lecture)
    maximised: str | None = None  # its title
    on_show: set[Corner] = field(default_factory=set)  # places of the last frame
    papers: dict[str, tuple[int, int]] = field(default_factory=dict)  # sizes of the figures in panels, in points
    pointed: str | None = None  # the figure in the panel under the mouse, or in the one that has all of the room

    def reset(self) -> None:
        """Put all panels back in place."""
        self.desk, self.lecture, self.maximised = at_the_desk(), in_a_lecture(), None

    def current(self, is_lecture: bool) -> Arrangement:
        return self.lecture if is_lecture else self.desk

    def maximise(self, title: str) -> None:
        """Give a panel all of the room; again: give it back."""
        self.maximised = None if self.maximised == title else title


def tile(
    arrangement: Arrangement, filled: set[Corner], room: Rectangle, gap: float
) -> tuple[dict[Corner, Rectangle], dict[int | None, Rectangle]]:
    """(rectangles of the open places that have a panel, rectangles of the borders that can be moved). Neighbours take
    the room of the others.
    """
    open_places = filled - arrangement.closed
    left, top, width, height = room
    columns = [[place for place in column if place in open_places] for column in COLUMNS]
    places: dict[Corner, Rectangle] = {}
    borders: dict[int | None, Rectangle] = {}
    shown = [k for k, column in enumerate(columns) if column]
    first = round(arrangement.columns * (width - gap)) if len(shown) == 2 else width
    if len(shown) == 2:
        borders[None] = (left + first, top, gap, height)
    for k in shown:
        x, wide = (left, first) if k == shown[0] else (left + first + gap, width - first - gap)
        if len(columns[k]) == 1:
            places[columns[k][0]] = (x, top, wide, height)
            continue
        upper = round(arrangement.rows[k] * (height - gap))
        places[columns[k][0]] = (x, top, wide, upper)
        places[columns[k][1]] = (x, top + upper + gap, wide, height - upper - gap)
        borders[k] = (x, top + upper, wide, gap)
    return places, borders


def stored(layout: Layout) -> dict[str, object]:
    """The layout as data for a file."""
    parts = {
        name: {
            "columns": part.columns,
            "rows": list(part.rows),
            "closed": sorted(place.value for place in part.closed),
            "front": {place.value: title for place, title in part.front.items()},
        }
        for name, part in (("desk", layout.desk), ("lecture", layout.lecture))
    }
    return {"maximised": layout.maximised, **parts}


def restored(data: Mapping[str, object]) -> Layout:
    """The layout from such data. Raises ValueError, KeyError or TypeError if they are not a layout's."""

    def arrangement(part: object) -> Arrangement:
        if not isinstance(part, dict):
            raise TypeError(part)
        found = Arrangement(closed={Corner(name) for name in part["closed"]})
        found.front = {Corner(name): str(title) for name, title in part["front"].items()}
        found.split(None, float(part["columns"]))
        upper_left, upper_right = (float(share) for share in part["rows"])
        found.split(0, upper_left)
        found.split(1, upper_right)
        if not found.closed < set(Corner):
            raise ValueError("all places are closed")
        return found

    maximised = data["maximised"]
    title = maximised if isinstance(maximised, str) else None
    return Layout(arrangement(data["desk"]), arrangement(data["lecture"]), title)

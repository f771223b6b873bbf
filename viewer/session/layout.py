"""The arrangement of the panels: two columns of two places each, of which any may be closed, or one panel on all of it.

Several panels can share a place; one of them is in front. At the desk, all four places are open. In lecture mode, the
scene and one place beside it are open, since type is large, and the image is an inset of the scene.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

from viewer.base.values import LEAST_SHARE
from viewer.reopen.view_state import PANEL_NAMES

Rectangle = tuple[float, float, float, float]  # left, top, width, height

GAP = 6.0  # between two places, in logical pixels


class Corner(Enum):
    """A place for panels."""

    TOP_LEFT = "top left"
    TOP_RIGHT = "top right"
    BOTTOM_LEFT = "bottom left"
    BOTTOM_RIGHT = "bottom right"


# The place of each panel at the desk, and in lecture mode. Of those that share a place, the first is in front at first.
PLACES = dict.fromkeys(PANEL_NAMES, (Corner.BOTTOM_RIGHT, Corner.BOTTOM_RIGHT)) | {
    "scene": (Corner.TOP_LEFT, Corner.TOP_LEFT),
    "image": (Corner.TOP_RIGHT, Corner.TOP_RIGHT),
    "tree": (Corner.BOTTOM_LEFT, Corner.BOTTOM_RIGHT),
}


LESSON = "lesson"
TAUGHT = (Corner.TOP_LEFT, Corner.BOTTOM_LEFT, Corner.BOTTOM_RIGHT)  # places of the panels beside the text of a lesson


def place_of(name: str, is_lecture: bool) -> Corner:
    return PLACES[name][is_lecture]


# In lecture mode, the tree takes the place of the scene while this panel is in front: each explains the other.
BESIDE_TREE = "recursion"


COLUMNS = ((Corner.TOP_LEFT, Corner.BOTTOM_LEFT), (Corner.TOP_RIGHT, Corner.BOTTOM_RIGHT))


@dataclass
class Arrangement:
    """The open places, and their shares of the room."""

    columns: float = 0.6  # share of the left column
    rows: list[float] = field(default_factory=lambda: [0.56, 0.52])  # share of the upper place in each column
    closed: set[Corner] = field(default_factory=set)
    front: dict[Corner, str] = field(default_factory=dict)  # name of the panel in front, where several share a place

    def split(self, which: int | None, share: float) -> None:
        """Move the border between the columns (None), or that between the two places of a column."""
        share = min(1.0 - LEAST_SHARE, max(LEAST_SHARE, share))
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


def while_taught() -> Arrangement:
    return Arrangement(columns=0.6)


@dataclass
class Layout:
    """All arrangements, and the panel that has all of the room."""

    desk: Arrangement = field(default_factory=at_the_desk)
    lecture: Arrangement = field(default_factory=in_a_lecture)
    lesson: Arrangement = field(default_factory=while_taught)
    taught: tuple[str, ...] = ()  # the panels beside the text of a lesson; empty: no lesson is given
    maximised: str | None = None  # its name
    on_show: set[Corner] = field(default_factory=set)  # places of the last frame
    papers: dict[str, tuple[int, int]] = field(default_factory=dict)  # sizes of the figures in panels, in points
    pointed: str | None = None  # the figure in the panel that the mouse was over last, or that has all of the room

    def reset(self) -> None:
        """Put all panels back in place."""
        self.desk, self.lecture, self.lesson = at_the_desk(), in_a_lecture(), while_taught()
        self.taught, self.maximised = (), None

    def current(self, is_lecture: bool) -> Arrangement:
        if self.taught:
            return self.lesson
        return self.lecture if is_lecture else self.desk

    def teach(self, names: Sequence[str]) -> None:
        """Show the text of a lesson, and beside it at most three of the other panels."""
        self.taught, self.maximised = tuple(names[: len(TAUGHT)]), None
        self.lesson.front = dict(zip(TAUGHT, self.taught, strict=False))

    def has_tree_beside(self, is_lecture: bool) -> bool:
        return is_lecture and not self.taught and self.lecture.front.get(Corner.BOTTOM_RIGHT) == BESIDE_TREE

    def place_in(self, name: str, is_lecture: bool) -> Corner:
        """The place of a panel."""
        if self.taught:
            return self._place_beside(name)
        if name == "tree" and self.has_tree_beside(is_lecture):
            return Corner.BOTTOM_LEFT
        return place_of(name, is_lecture)

    def _place_beside(self, name: str) -> Corner:
        """The place of a panel beside the text of a lesson. The others share those of the scene and of the tree."""
        if name == LESSON:
            return Corner.TOP_RIGHT
        if name in self.taught:
            return TAUGHT[self.taught.index(name)]
        return {"scene": Corner.TOP_LEFT, "image": Corner.BOTTOM_RIGHT}.get(name, Corner.BOTTOM_LEFT)

    def closed(self, is_lecture: bool) -> set[Corner]:
        """The places that are closed."""
        if self.taught:
            return set(TAUGHT[len(self.taught) :])
        closed = self.current(is_lecture).closed
        if self.has_tree_beside(is_lecture):
            return (closed - {Corner.BOTTOM_LEFT}) | {Corner.TOP_LEFT, Corner.TOP_RIGHT}
        return closed

    def bring_to_front(self, name: str, is_lecture: bool) -> None:
        """Show a panel in its place. Lecture mode keeps its own: it opens on the tree, whatever is read at the desk."""
        self.current(is_lecture).front[self.place_in(name, is_lecture)] = name

    def maximise(self, name: str) -> None:
        """Give a panel all of the room; again: give it back."""
        self.maximised = None if self.maximised == name else name

    def give_back(self) -> bool:
        """Show all panels. Returns whether one had all of the room."""
        had_one, self.maximised = self.maximised is not None, None
        return had_one

    def shown(self, is_lecture: bool) -> tuple[str, ...]:
        """The names of the panels on show, if no lesson is given."""
        if self.maximised:
            return (self.maximised,)
        arrangement, found = self.current(is_lecture), {}
        for name in PLACES:
            place = self.place_in(name, is_lecture)
            if place not in self.closed(is_lecture):
                found.setdefault(place, arrangement.front.get(place, name))
        return tuple(found.values())

    def show(self, names: Sequence[str], is_lecture: bool) -> None:
        """Show these panels and no others; a single one has all of the room."""
        self.taught = ()
        self.maximised = names[0] if len(names) == 1 else None
        if not self.maximised:
            front = {place_of(name, is_lecture): name for name in reversed(names)}
            if is_lecture and BESIDE_TREE in names:
                front[Corner.BOTTOM_RIGHT] = BESIDE_TREE
            arrangement = self.current(is_lecture)
            arrangement.front |= front
            if BESIDE_TREE not in names or not is_lecture:
                arrangement.closed = set(Corner) - set(front)

    def beside(self) -> tuple[str, ...]:
        """The names of the panels on show beside the text of a lesson; none if no lesson is given."""
        if self.maximised:
            return ()
        return tuple(self.lesson.front.get(self._place_beside(name), name) for name in self.taught)

    def borders(self, is_lecture: bool) -> tuple[float, float, float]:
        """The shares of the left column, and of the upper place in each column."""
        arrangement = self.current(is_lecture)
        return (arrangement.columns, arrangement.rows[0], arrangement.rows[1])


def usual_borders(layout: Layout, is_lecture: bool) -> tuple[float, float, float]:
    """The borders of a new window in the arrangement on show."""
    return Layout(taught=layout.taught).borders(is_lecture)


def tile(
    arrangement: Arrangement, closed: set[Corner], filled: set[Corner], room: Rectangle, gap: float
) -> tuple[dict[Corner, Rectangle], dict[int | None, Rectangle]]:
    """(rectangles of the open places that have a panel, rectangles of the borders that can be moved). Neighbours take
    the room of the others.
    """
    open_places = filled - closed
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

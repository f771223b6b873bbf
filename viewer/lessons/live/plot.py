"""Plots made of marks: two axes with ticks, curves, points and labels; and bars of colours that add up."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from viewer.base.theme import Color, Theme, faded
from viewer.base.wording import format_number
from viewer.figures.font import text_width
from viewer.figures.marks import Box, Disc, Handle, Line, Mark, Point, Rectangle, Shape, Stroke, Text
from viewer.lessons.live.labels import Labels

TICKS = 1.45  # height of the line of numbers below the plot, in text sizes
TITLE = 1.35  # height of the title below, in text sizes
HEAD = 1.75  # height of the title above, clear of the uppermost number
APART = 0.9  # least distance between the numbers of an axis, in text sizes
STEPS = 90  # of a curve, and of a handle's path
DOT = 0.3  # radius of a point, in text sizes


@dataclass(frozen=True)
class Axis:
    """`titles` are the longest first; the first with room is used. `steps` are distances of ticks, the finest first;
    the first whose numbers have room is used.
    """

    titles: tuple[str, ...]
    low: float
    high: float
    steps: tuple[float, ...]
    unit: str = ""

    def share(self, value: float) -> float:
        return (value - self.low) / (self.high - self.low)

    def title(self, size: float, room: float) -> str:
        return next((words for words in self.titles if text_width(words, size) <= room), "")

    def ticks(self, size: float, room: float, high: bool) -> list[tuple[float, str]]:
        """Values and their numbers on an axis of this length; if it is `high`, they stand above each other."""
        for step in self.steps:
            first, last = -(-self.low // step), self.high / step + 1e-9
            values = [step * k for k in range(int(first), int(last) + 1)]
            found = [(value, f"{value:g}{self.unit}".replace("-", "−")) for value in values]
            extent = size if high else max(text_width(words, size) for _, words in found)
            if (extent + APART * size) * (len(found) - 1) <= room:
                return found
        return found[:: max(1, len(found) - 1)]


class Plot:
    """The axes of a plot in a rectangle. Labels keep off what is drawn before them."""

    def __init__(self, where: Rectangle, across: Axis, up: Axis, size: float, theme: Theme) -> None:
        self.across, self.up, self.size, self.theme = across, up, size, theme
        left, top, right, bottom = where
        high = bottom - top - (TICKS + TITLE + HEAD) * size
        numbers = up.ticks(size, high, True)
        left += max(text_width(words, size) for _, words in numbers) + 0.5 * size
        last = across.ticks(size, right - left, False)[-1][1]
        right -= 0.5 * text_width(last, size)
        self.box: Rectangle = (left, top + HEAD * size, right, bottom - (TICKS + TITLE) * size)
        self.labels = Labels(self.box, size, theme)
        self.marks: list[Mark] = []
        self._axes(where, numbers)
        self.avoided = len(self.marks)  # how many of the marks the labels have seen: labels may cover the grid

    def at(self, x: float, y: float) -> Point:
        left, top, right, bottom = self.box
        return (left + self.across.share(x) * (right - left), bottom - self.up.share(y) * (bottom - top))

    def _axes(self, where: Rectangle, numbers: Sequence[tuple[float, str]]) -> None:
        left, top, right, bottom = self.box
        size, theme = self.size, self.theme
        grid = Stroke(theme.border, 1.0)
        for value, words in numbers:
            (_, y) = self.at(self.across.low, value)
            self.marks.append(Line("grid", (left, y), (right, y), grid))
            self.marks.append(Text("axis", (left - 0.4 * size, y), words, size, theme.muted, "end"))
        for value, words in self.across.ticks(size, right - left, False):
            (x, _) = self.at(value, self.up.low)
            self.marks.append(Line("grid", (x, top), (x, bottom), grid))
            self.marks.append(Text("axis", (x, bottom + 1.05 * size), words, size, theme.muted))
        ink = Stroke(theme.text, 1.4)
        self.marks.append(Line("axis", (left, bottom), (right, bottom), ink))
        self.marks.append(Line("axis", (left, top), (left, bottom), ink))
        wide = where[2] - where[0]
        self.marks.append(
            Text("axis", (where[0], where[1] + 0.55 * size), self.up.title(size, wide), size, theme.text, "start")
        )
        below = bottom + (TICKS + 0.65) * size
        self.marks.append(Text("axis", (where[2], below), self.across.title(size, wide), size, theme.text, "end"))

    def curve(
        self, name: str, value: Callable[[float], float], ends: tuple[float, float], stroke: Stroke, title: str = ""
    ) -> None:
        """A function between two places of the axis."""
        first, last = ends
        xs = [first + (last - first) * k / STEPS for k in range(STEPS + 1)]
        corners = tuple(self.at(x, value(x)) for x in xs)
        self.marks.append(Shape(name, corners, None, stroke, closed=False, title=title))

    def line(self, name: str, start: Point, end: Point, stroke: Stroke) -> None:
        """A straight line between two places."""
        self.marks.append(Line(name, self.at(*start), self.at(*end), stroke))

    def region(self, name: str, ends: tuple[float, float], color: Color, title: str = "") -> None:
        """Tint all of the plot between two places of the axis."""
        low, high = self.up.low, self.up.high
        places = ((ends[0], low), (ends[1], low), (ends[1], high), (ends[0], high))
        self.marks.append(Shape(name, tuple(self.at(*place) for place in places), color, None, title=title))

    def point(self, name: str, x: float, y: float, color: Color, hollow: bool = False, title: str = "") -> None:
        at, radius = self.at(x, y), DOT * self.size
        fill = self.theme.ground if hollow else color
        self.marks.append(Disc(name, at, radius, fill, Stroke(color, 2.0), title=title))

    def handle(self, name: str, value: float, color: Color, title: str) -> None:
        """A handle on the axis."""
        ends = (self.across.low, self.across.high)
        path = (self.at(ends[0], self.up.low), self.at(ends[1], self.up.low))
        self.marks.append(Handle(name, value, ends, path, color, title=title))

    def label(
        self, name: str, words: Sequence[str], x: float, y: float, color: Color, most: int = 0, near: bool = False
    ) -> None:
        """Write the first of these texts that has a place beside a point, as in `Labels.beside`."""
        self.labels.avoid(self.marks[self.avoided :])
        self.avoided = len(self.marks)
        self.labels.beside(name, words, self.at(x, y), color, most, near)

    def drawn(self) -> list[Mark]:
        """All marks, with the labels above."""
        return [*self.marks, *self.labels.marks]


BAR = 0.8  # height of a bar, in text sizes
CHANNELS = ("red", "green", "blue")
TRACK = 0.10  # opacity of the room of a bar


@dataclass(frozen=True)
class Stacked:
    """A part of stacked bars: its linear colour (3,), and the colour it is drawn in."""

    name: str
    value: np.ndarray
    ink: Color
    title: str


def stacked_bars(parts: Sequence[Stacked], where: Rectangle, size: float, theme: Theme) -> list[Mark]:
    """Three bars, of red, green and blue, in which these parts follow each other, with their sums. All of the width is
    1, so that bars of several hits compare; or the largest sum, if it is larger.
    """
    left, top, right, bottom = where
    pitch = (bottom - top) / len(CHANNELS)
    total = sum((part.value for part in parts), np.zeros(3))
    numbers = [format_number(float(x), 3) for x in total]
    start = left + max(text_width(words, size) for words in CHANNELS) + 0.5 * size
    end = right - max(text_width(words, size) for words in numbers) - 0.5 * size
    unit = max(end - start, 0.0) / max(1.0, float(total.max()))
    high = min(BAR * size, 0.8 * pitch)
    marks: list[Mark] = []
    for c, channel in enumerate(CHANNELS):
        y, x = top + (c + 0.5) * pitch, start
        marks.append(Text("bars", (left, y), channel, size, theme.muted, "start"))
        if end > start:
            room = (end - start, high)
            marks.append(Box("bars", (0.5 * (start + end), y), room, 0.0, faded(theme.text, TRACK), None))
        for part in parts:
            wide = unit * float(part.value[c])
            if wide > 0.0:
                title = f"{part.title}, {channel}: {format_number(float(part.value[c]), 4)}"
                marks.append(Box(part.name, (x + 0.5 * wide, y), (wide, high), 0.0, part.ink, None, title=title))
                x += wide
        marks.append(Text("bars", (right, y), numbers[c], size, theme.text, "end"))
    return marks

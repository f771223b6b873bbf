"""Small signs that figures share: the eye, ends of shadow rays, the bar of total internal reflection."""

import math
from dataclasses import replace

from viewer.base.theme import Color, Theme
from viewer.figures.marks import Disc, Line, Mark, Point, Shape, Stroke


def eye(at: Point, size: float, theme: Theme) -> list[Mark]:
    """An almond with its pupil."""
    x, y = at
    half, high = 0.85 * size, 0.42 * size
    lid = [(x + half * math.cos(a), y - high * math.sin(a)) for a in (math.pi * k / 12 for k in range(24))]
    stroke = Stroke(theme.text, 1.8)
    return [
        Shape("eye", tuple(lid), theme.panel, stroke, title="the eye"),
        Disc("eye", at, 0.24 * size, theme.text, None),
    ]


def sun(name: str, at: Point, size: float, color: Color, ring: Color | None = None, title: str = "") -> list[Mark]:
    """A light that is reached: a disc with eight rays, with a ring if the light comes through glass."""
    marks: list[Mark] = [Disc(name, at, 0.2 * size, color, None, title=title)]
    for k in range(8):
        dx, dy = math.cos(k * math.pi / 4), math.sin(k * math.pi / 4)
        start = (at[0] + 0.28 * size * dx, at[1] + 0.28 * size * dy)
        end = (at[0] + 0.4 * size * dx, at[1] + 0.4 * size * dy)
        marks.append(Line(name, start, end, Stroke(color, 1.8)))
    if ring:
        marks.append(Disc(name, at, 0.48 * size, None, Stroke(ring, 1.5)))
    return marks


def cross(name: str, at: Point, size: float, color: Color) -> list[Mark]:
    """A light that is not reached."""
    r = 0.26 * size
    x, y = at
    return [
        Line(name, (x - r, y - r), (x + r, y + r), Stroke(color, 2.6)),
        Line(name, (x - r, y + r), (x + r, y - r), Stroke(color, 2.6)),
    ]


def bar(name: str, at: Point, size: float, color: Color) -> list[Mark]:
    """A ray that does not exist."""
    return [Line(name, (at[0] - 0.36 * size, at[1]), (at[0] + 0.36 * size, at[1]), Stroke(color, 3.0))]


def arc(center: Point, radius: float, begin: float, end: float) -> tuple[Point, ...]:
    """The corners of an arc between two directions, clockwise from above, in steps of at most two degrees."""
    steps = max(1, math.ceil(abs(end - begin) / math.radians(2.0)))
    turns = (begin + (end - begin) * k / steps for k in range(steps + 1))
    return tuple((center[0] + radius * math.sin(turn), center[1] - radius * math.cos(turn)) for turn in turns)


def cut(name: str, at: Point, size: float, color: Color, title: str = "") -> list[Mark]:
    """Rays that were cut: three dots."""
    return [Disc(name, (at[0] + 0.3 * k * size, at[1]), 0.08 * size, color, None, title=title) for k in (-1, 0, 1)]


def light_end(end: str, name: str, at: Point, size: float, theme: Theme, title: str = "") -> list[Mark]:
    """The sign at the end of a shadow ray of this fate."""
    color = theme.ray("shadow")
    match end:
        case "away":
            marks = bar(name, at, 0.7 * size, color)
        case "blocked":
            marks = cross(name, at, size, color)
        case "nothing":
            marks = [Disc(name, at, 0.26 * size, None, Stroke(color, 1.5))]
        case _:
            marks = sun(name, at, size, theme.sun, color if end == "filtered" else None)
    return [replace(marks[0], title=title), *marks[1:]]

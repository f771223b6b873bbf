"""The mark under the mouse: the distance from a point to each mark, and the nearest one."""

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

from viewer.figures.marks import Box, Disc, Formula, Handle, Line, Mark, Point, Rectangle, Shape, Text, point_along

PICKED = ("ray", "hit")  # the kinds of names that can be picked: `ray-3` and `hit-3` belong to row 3 of a tree


def mark_at(marks: Iterable[Mark], point: Point, reach: float, kinds: Sequence[str] = PICKED) -> str | None:
    """The name of the nearest mark that is at most `reach` from a point, in the unit of the marks; None if there is
    none. Of several at one distance, as where one covers the other, it is the last, which is drawn on top.

    Only marks are considered whose names are one of `kinds`, a hyphen and a number.
    """
    found, nearest = None, reach
    for mark in marks:
        if ray_of(mark.name, kinds) is not None:
            away = distance(mark, point)
            if away <= nearest:
                found, nearest = mark.name, away
    return found


def handle_at(marks: Iterable[Mark], point: Point, reach: float) -> Handle | None:
    """The handle nearest to a point, at most `reach` from its middle; None if there is none."""
    handles = [mark for mark in marks if isinstance(mark, Handle)]
    near = min(handles, key=lambda handle: math.dist(handle.at, point), default=None)
    return near if near and math.dist(near.at, point) <= reach else None


def nearest_value(handle: Handle, point: Point) -> float:
    """The value of the handle whose place is nearest to a point."""
    pieces = list(pairwise(handle.path))
    shares = [_nearest_share(*piece, point) for piece in pieces]
    away = [math.dist(point, point_along(piece, share)) for piece, share in zip(pieces, shares, strict=True)]
    k = min(range(len(pieces)), key=away.__getitem__)
    low, high = handle.range
    return low + (high - low) * (k + shares[k]) / len(pieces)


def ray_of(name: str, kinds: Sequence[str] = PICKED) -> int | None:
    """The row of the tree that a mark of one of these kinds belongs to, by its name; None for other marks."""
    kind, _, number = name.rpartition("-")
    return row_of(name) if kind in kinds and number.isdecimal() else None


def row_of(name: str | None) -> int | None:
    """The row of the tree that a mark belongs to, by its name."""
    return None if name is None else int(name.rpartition("-")[2])


def distance(mark: Mark, point: Point) -> float:
    """The distance from a point to what is drawn of a mark: 0 on it, and inside boxes, discs, closed outlines and the
    frames of texts.
    """
    match mark:
        case Box():
            (x, y), (w, h) = mark.center, mark.size
            return _to_rectangle((x - w / 2, y - h / 2, x + w / 2, y + h / 2), point)
        case Disc():
            return max(0.0, math.dist(mark.center, point) - mark.radius)
        case Shape():
            if mark.closed and _winds(mark.corners, point):
                return 0.0
            ends = (*mark.corners, mark.corners[0]) if mark.closed else mark.corners
            return _to_curve(ends, point, mark.stroke.width if mark.stroke else 0.0)
        case Line():
            return _to_curve((mark.start, mark.end), point, mark.stroke.width)
        case Text() | Formula():
            return _to_rectangle(mark.box(), point)
        case _:
            return math.inf


def _to_rectangle(box: Rectangle, point: Point) -> float:
    left, top, right, bottom = box
    x, y = point
    return math.hypot(max(left - x, 0.0, x - right), max(top - y, 0.0, y - bottom))


def _to_curve(corners: Sequence[Point], point: Point, width: float) -> float:
    """The distance to a line of this width through the corners."""
    away = min(_to_segment(a, b, point) for a, b in pairwise(corners))
    return max(0.0, away - 0.5 * width)


def _to_segment(a: Point, b: Point, point: Point) -> float:
    return math.dist(point_along((a, b), _nearest_share(a, b, point)), point)


def _nearest_share(a: Point, b: Point, point: Point) -> float:
    """The share of the length of a segment at which it is nearest to a point."""
    along = (b[0] - a[0], b[1] - a[1])
    square = along[0] ** 2 + along[1] ** 2
    share = ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / square if square else 0.0
    return min(1.0, max(0.0, share))


def _winds(corners: Sequence[Point], point: Point) -> bool:
    """Whether a point is inside a closed outline: a ray from it crosses the outline an odd number of times."""
    x, y = point
    odd = False
    for (x0, y0), (x1, y1) in pairwise((*corners, corners[0])):
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
            odd = not odd
    return odd

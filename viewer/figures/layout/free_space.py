"""Free space on a canvas: a grid of cells that are taken, with prefix sums that give the count of any rectangle."""

import math
from collections.abc import Iterable

import numpy as np

from viewer.figures.marks import Box, Disc, Formula, Line, Mark, Point, Rectangle, Shape, Text, clip_shares, overlap

CELL = 4.0  # points
RANK = 90.0  # a corner is preferred to the one before it if it is nearer by this many points


def is_free(box: Rectangle, marks: Iterable[Mark]) -> bool:
    """Whether no mark touches a rectangle."""
    return not any(_touches(mark, box) for mark in marks)


def _touches(mark: Mark, box: Rectangle) -> bool:
    match mark:
        case Line():
            return clip_shares((mark.start, mark.end), box) is not None
        case Text() | Formula() | Box() | Disc() | Shape():
            return overlap(_bounds(mark), box)
        case _:
            return True


def _bounds(mark: Text | Formula | Box | Disc | Shape) -> Rectangle:
    match mark:
        case Text() | Formula():
            return mark.box()
        case Box(center=(x, y), size=(w, h)):
            return (x - 0.5 * w, y - 0.5 * h, x + 0.5 * w, y + 0.5 * h)
        case Disc(center=(x, y), radius=r):
            return (x - r, y - r, x + r, y + r)
        case Shape(corners=corners):
            across, down = zip(*corners, strict=True)
            return (min(across), min(down), max(across), max(down))


class FreeSpace:
    """A cell counts as taken if a mark touches it."""

    def __init__(self, where: Rectangle, marks: Iterable[Mark] = ()) -> None:
        self.where = where
        left, top, right, bottom = where
        self.taken = np.zeros((int((bottom - top) / CELL), int((right - left) / CELL)), bool)
        for mark in marks:
            self._take_mark(mark)

    def _take_mark(self, mark: Mark) -> None:
        match mark:
            case Text() | Formula() | Box() | Disc() | Shape():
                self.take(_bounds(mark))
            case Line():
                steps = max(1, math.ceil(math.dist(mark.start, mark.end) / CELL))
                for k in range(steps):  # in short pieces, whose bounding boxes are hardly larger than themselves
                    (x0, y0), (x1, y1) = mark.at(k / steps), mark.at((k + 1) / steps)
                    self.take((min(x0, x1) - 2.0, min(y0, y1) - 2.0, max(x0, x1) + 2.0, max(y0, y1) + 2.0))

    def take(self, box: Rectangle) -> None:
        left, top, _, _ = self.where
        first_column, last_column = math.floor((box[0] - left) / CELL), math.floor((box[2] - left) / CELL)
        first_row, last_row = math.floor((box[1] - top) / CELL), math.floor((box[3] - top) / CELL)
        if last_column >= 0 and last_row >= 0:
            self.taken[max(0, first_row) : last_row + 1, max(0, first_column) : last_column + 1] = True

    def place(self, size: tuple[float, float], corners: Iterable[str]) -> Point | None:
        """The top left of a free rectangle of this size, as near as possible to one of the corners, like "top left"."""
        x, y = self._places(size)
        if not len(x):
            return None
        left, top, _, _ = self.where
        right, bottom = left + CELL * self.taken.shape[1], top + CELL * self.taken.shape[0]
        costs = []
        for rank, corner in enumerate(corners):
            far_x = right - size[0] - x if "right" in corner else x - left
            far_y = bottom - size[1] - y if "bottom" in corner else y - top
            costs.append(np.hypot(far_x, far_y) + RANK * rank)
        best = int(np.argmin(np.min(costs, axis=0)))
        return (float(x[best]), float(y[best]))

    def nearest(self, size: tuple[float, float], box: Rectangle) -> Point | None:
        """The top left of the free rectangle of this size that is nearest to a box."""
        x, y = self._places(size)
        if not len(x):
            return None
        left, top, right, bottom = box
        far_x = np.maximum(0.0, np.maximum(left - size[0] - x, x - right))
        far_y = np.maximum(0.0, np.maximum(top - size[1] - y, y - bottom))
        aside = np.abs(x + 0.5 * size[0] - 0.5 * (left + right)) + np.abs(y + 0.5 * size[1] - 0.5 * (top + bottom))
        best = int(np.argmin(np.hypot(far_x, far_y) + 1e-3 * aside))  # of equal distances, the one that faces the box
        return (float(x[best]), float(y[best]))

    def _places(self, size: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
        """Left and top of all free rectangles of this size."""
        wide, high = (math.ceil(length / CELL) for length in size)
        rows, columns = self.taken.shape
        if wide > columns or high > rows:
            return np.zeros(0), np.zeros(0)
        sums = np.pad(self.taken.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
        inside = sums[high:, wide:] - sums[:-high, wide:] - sums[high:, :-wide] + sums[:-high, :-wide]
        y, x = np.nonzero(inside == 0)
        left, top, _, _ = self.where
        return left + CELL * x, top + CELL * y

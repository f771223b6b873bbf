"""Outlines of the true pixels of a picture, in points of the canvas: contour lines of the coverage of each point.

Marching squares are contourpy's. The picture has FINE pixels per point, in each direction.
"""

import itertools
from dataclasses import dataclass

import contourpy
import numpy as np

from viewer.figures.marks import Point, Rectangle
from viewer.figures.visible.rings import sharpen_corners, simplify, straighten

FINE = 2  # pixels per point in each direction: an outline is accurate to a quarter of a point
SMALL = 6.0  # square points: smaller areas are noise
SQUARE, NEARBY = 3.0, 8  # points: the smallest checker drawn as squares; the window in which that is decided
COARSE, RING, MOST_SPOTS = 4, 12, 80  # points between spots for a name; spots in one ring; spots in all


@dataclass(frozen=True)
class Area:
    """One connected area of the picture, in points, with holes."""

    outline: tuple[Point, ...]
    holes: tuple[tuple[Point, ...], ...]

    def covers(self, point: Point) -> bool:
        """Whether a point is inside: whether a ray from there to the right crosses the rings an odd number of times."""
        x, y = point
        crossings = 0
        for ring in (self.outline, *self.holes):
            for (x0, y0), (x1, y1) in zip(ring, (*ring[1:], ring[0]), strict=True):
                crossings += (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0)
        return crossings % 2 == 1


def pixels_of_numbers(numbers: np.ndarray, count: int) -> list[np.ndarray]:
    """The flat indices of the pixels that have each of the numbers 0 to count - 1."""
    order = np.argsort(numbers, axis=None, kind="stable")
    ends = np.searchsorted(numbers.flat[order], np.arange(count + 1))
    return [order[a:b] for a, b in itertools.pairwise(ends)]


def window_of(places: np.ndarray, shape: tuple[int, int], where: Rectangle) -> tuple[tuple[slice, slice], Rectangle]:
    """(the part of a picture that contains these pixels, its rectangle on the canvas), with a margin."""
    rows, columns = np.divmod(places, shape[1])
    grid = FINE * COARSE
    ends = []
    for at, size in ((rows, shape[0]), (columns, shape[1])):
        first = max(0, (int(at.min()) // grid - 1) * grid)
        ends.append(slice(first, min(size, (int(at.max()) // grid + 2) * grid)))
    down, across = ends
    left, top, _, _ = where
    part = (
        left + across.start / FINE,
        top + down.start / FINE,
        left + across.stop / FINE,
        top + down.stop / FINE,
    )
    return (down, across), part


def outline_areas(mask: np.ndarray, where: Rectangle) -> tuple[Area, ...]:
    """The outlines of the true pixels, in points of the canvas."""
    if not mask.any():
        return ()
    height, width = (n // FINE for n in mask.shape)
    cover = mask.reshape(height, FINE, width, FINE).mean(axis=(1, 3))
    # At the picture's border, areas continue a little and then end. Nearly level edges are stairs of one pixel: smooth
    # them.
    cover = np.pad(cover, 2, mode="edge")
    cover = 0.25 * (cover[:-2] + 2.0 * cover[1:-1] + cover[2:])
    cover = np.pad(0.25 * (cover[:, :-2] + 2.0 * cover[:, 1:-1] + cover[:, 2:]), 1)
    x, y = np.arange(width + 4) - 1.5, np.arange(height + 4) - 1.5
    maker = contourpy.contour_generator(x, y, cover, fill_type=contourpy.FillType.OuterOffset)
    found = []
    for points, offsets in zip(*maker.filled(0.5, 2.0), strict=True):
        clipped = np.clip(points, 0.0, (width, height))
        fine = [clipped[a:b] for a, b in itertools.pairwise(offsets)]
        rings = [sharpen_corners(straighten(simplify(ring)), ring) for ring in fine]
        rings = [np.clip(ring, 0.0, (width, height)) + where[:2] for ring in rings]
        rings = [ring for ring in rings if len(ring) > 2 and _size(ring) >= SMALL]
        if rings:
            outline, *holes = (tuple(map(tuple, ring.tolist())) for ring in rings)
            found.append(Area(outline, tuple(holes)))
    return tuple(found)


def is_too_fine(squares: np.ndarray, within: np.ndarray) -> np.ndarray:
    """Mask of the pixels where a checker's squares are lower or narrower than SQUARE, estimated from the number of
    their borders nearby.
    """
    dense = np.zeros(squares.shape, bool)
    for axis in (0, 1):
        turns = np.zeros(squares.shape, np.float32)
        here, there = ((slice(None), slice(1, None)), (slice(None), slice(None, -1)))
        if axis == 0:
            here, there = here[::-1], there[::-1]
        turns[here] = (squares[here] != squares[there]) & within[here] & within[there]
        dense |= _about(turns, NEARBY * FINE) > _about(within, NEARBY * FINE) / (SQUARE * FINE)
    return dense


def _about(values: np.ndarray, half: int) -> np.ndarray:
    """Sums over windows of this half width around each pixel, cut at the border."""
    sums = np.pad(values.cumsum(axis=0, dtype=float).cumsum(axis=1), ((1, 0), (1, 0)))
    rows, columns = (np.arange(n) for n in values.shape)
    top, bottom = np.maximum(rows - half, 0), np.minimum(rows + half + 1, values.shape[0])
    left, right = np.maximum(columns - half, 0), np.minimum(columns + half + 1, values.shape[1])
    return sums[np.ix_(bottom, right)] - sums[np.ix_(top, right)] - sums[np.ix_(bottom, left)] + sums[np.ix_(top, left)]


def label_spots(mask: np.ndarray, where: Rectangle) -> tuple[Point, ...]:
    """Spots well inside the true pixels. The border is eroded until nothing is left, and the last pixels come first."""
    found: list[Point] = []
    left = mask[:: FINE * COARSE, :: FINE * COARSE]
    while left.any():
        rows, columns = np.nonzero(left)
        steps = np.linspace(0, len(rows) - 1, min(RING, len(rows))).astype(int)
        found[:0] = [(where[0] + COARSE * float(columns[k]), where[1] + COARSE * float(rows[k])) for k in steps]
        inner = np.pad(left, 1)
        left = left & inner[:-2, 1:-1] & inner[2:, 1:-1] & inner[1:-1, :-2] & inner[1:-1, 2:]
    return tuple(found[:: max(1, -(-len(found) // MOST_SPOTS))])


def _size(ring: np.ndarray) -> float:
    x, y = ring.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))

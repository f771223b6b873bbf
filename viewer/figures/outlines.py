"""From a picture of what is true to outlines in points of the canvas: level lines of how much of each point is covered.

Marching squares are contourpy's; the picture has FINE rays a point across and down.
"""

import itertools
import math
from dataclasses import dataclass

import contourpy
import numpy as np

from viewer.figures.marks import Point, Rectangle

FINE = 2  # rays a point across and down: an outline is sure to a quarter of a point
STRAIGHT = 0.2  # points: how far a simpler outline may be off
LONG, LEVEL = 30.0, 0.5  # an edge so long is an edge of the thing: stairs so high are the picture's, not its own
SIDE, CORNER = 20.0, 16.0  # two edges so long, joined by a way so short, meet in a corner that the picture has rounded
ROUNDED = 1.0  # if the way keeps so close to them
SMALL = 6.0  # square points: smaller spots are noise
SQUARE, NEARBY = 3.0, 8  # points: what is finer is no square to be drawn; how far about it is looked for others
COARSE, RING, MOST_SPOTS = 4, 12, 80  # points between places that may be named; places in a ring of them, in all


@dataclass(frozen=True)
class Area:
    """One connected spot of the picture, in points; with holes where something stands before it."""

    outline: tuple[Point, ...]
    holes: tuple[tuple[Point, ...], ...]

    def covers(self, point: Point) -> bool:
        """Whether a ray from there to the right meets its rings an odd number of times."""
        x, y = point
        crossings = 0
        for ring in (self.outline, *self.holes):
            for (x0, y0), (x1, y1) in zip(ring, (*ring[1:], ring[0]), strict=True):
                crossings += (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0)
        return crossings % 2 == 1


def places_of(numbers: np.ndarray, count: int) -> list[np.ndarray]:
    """Where in a picture each of the numbers 0 to count - 1 stands, as places in its flat order."""
    order = np.argsort(numbers, axis=None, kind="stable")
    ends = np.searchsorted(numbers.flat[order], np.arange(count + 1))
    return [order[a:b] for a, b in itertools.pairwise(ends)]


def window_of(places: np.ndarray, shape: tuple[int, int], where: Rectangle) -> tuple[tuple[slice, slice], Rectangle]:
    """(the part of a picture of that shape in which these places are, its rectangle on the canvas), with a free rim."""
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


def areas(mask: np.ndarray, where: Rectangle) -> tuple[Area, ...]:
    """The outlines of what is true, in points of the canvas."""
    if not mask.any():
        return ()
    height, width = (n // FINE for n in mask.shape)
    cover = mask.reshape(height, FINE, width, FINE).mean(axis=(1, 3))
    # At the rim a spot goes on as it was, and ends outside. Nearly level edges are stairs, a ray high: smoothed.
    cover = np.pad(cover, 2, mode="edge")
    cover = 0.25 * (cover[:-2] + 2.0 * cover[1:-1] + cover[2:])
    cover = np.pad(0.25 * (cover[:, :-2] + 2.0 * cover[:, 1:-1] + cover[:, 2:]), 1)
    x, y = np.arange(width + 4) - 1.5, np.arange(height + 4) - 1.5
    maker = contourpy.contour_generator(x, y, cover, fill_type=contourpy.FillType.OuterOffset)
    found = []
    for points, offsets in zip(*maker.filled(0.5, 2.0), strict=True):
        clipped = np.clip(points, 0.0, (width, height))
        rings = [sharper(straighter(simpler(clipped[a:b]))) for a, b in itertools.pairwise(offsets)]
        rings = [np.clip(ring, 0.0, (width, height)) + where[:2] for ring in rings]
        rings = [ring for ring in rings if len(ring) > 2 and _size(ring) >= SMALL]
        if rings:
            outline, *holes = (tuple(map(tuple, ring.tolist())) for ring in rings)
            found.append(Area(outline, tuple(holes)))
    return tuple(found)


def too_fine(squares: np.ndarray, within: np.ndarray) -> np.ndarray:
    """Where the squares of checkers are lower or narrower than SQUARE: by how often they begin and end nearby."""
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
    """The sums over windows so far to either side and up and down, cut off at the rim."""
    sums = np.pad(values.cumsum(axis=0, dtype=float).cumsum(axis=1), ((1, 0), (1, 0)))
    rows, columns = (np.arange(n) for n in values.shape)
    top, bottom = np.maximum(rows - half, 0), np.minimum(rows + half + 1, values.shape[0])
    left, right = np.maximum(columns - half, 0), np.minimum(columns + half + 1, values.shape[1])
    return sums[np.ix_(bottom, right)] - sums[np.ix_(top, right)] - sums[np.ix_(bottom, left)] + sums[np.ix_(top, left)]


def spots_of(mask: np.ndarray, where: Rectangle) -> tuple[Point, ...]:
    """Places all over what is true: its rim is taken off until nothing is left, and the last ones come first."""
    found: list[Point] = []
    left = mask[:: FINE * COARSE, :: FINE * COARSE]
    while left.any():
        rows, columns = np.nonzero(left)
        steps = np.linspace(0, len(rows) - 1, min(RING, len(rows))).astype(int)
        found[:0] = [(where[0] + COARSE * float(columns[k]), where[1] + COARSE * float(rows[k])) for k in steps]
        inner = np.pad(left, 1)
        left = left & inner[:-2, 1:-1] & inner[2:, 1:-1] & inner[1:-1, :-2] & inner[1:-1, 2:]
    return tuple(found[:: max(1, -(-len(found) // MOST_SPOTS))])


def simpler(ring: np.ndarray) -> np.ndarray:
    """A closed outline with fewer corners, nowhere farther off than STRAIGHT, along long edges than LEVEL
    (Ramer 1972; Douglas & Peucker 1973)."""
    ring = ring[:-1] if len(ring) > 1 and (ring[0] == ring[-1]).all() else ring
    if len(ring) < 4:
        return ring
    far = int(np.argmax(((ring - ring[0]) ** 2).sum(axis=1)))
    kept = {0, far}
    closed = np.concatenate([ring, ring[:1]])
    waiting = [(0, far), (far, len(ring))]
    while waiting:
        a, b = waiting.pop()
        if b - a < 2:
            continue
        along = closed[b] - closed[a]
        length = math.hypot(*along)
        between = closed[a + 1 : b] - closed[a]
        away = np.abs(between @ (-along[1], along[0])) / length if length > 0.0 else np.hypot(*between.T)
        k = int(np.argmax(away))
        if away[k] > (LEVEL if length > LONG else STRAIGHT):
            kept.add(a + 1 + k)
            waiting += [(a, a + 1 + k), (a + 1 + k, b)]
    return ring[sorted(kept)]


def straighter(ring: np.ndarray) -> np.ndarray:
    """A closed outline without the corners that only bend a long edge, by no more than LEVEL."""
    kept = [(float(x), float(y)) for x, y in ring]
    at = idle = 0
    while len(kept) > 3 and idle < len(kept):
        (x0, y0), (x, y), (x1, y1) = kept[at - 1], kept[at], kept[(at + 1) % len(kept)]
        length = math.hypot(x1 - x0, y1 - y0)
        if length > LONG and abs((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) <= LEVEL * length:
            del kept[at]
            idle = 0
        else:
            at, idle = at + 1, idle + 1
        at %= len(kept)
    return np.array(kept)


def sharper(ring: np.ndarray) -> np.ndarray:
    """A closed outline with its corners where the edges on both sides of them meet."""
    edges = np.roll(ring, -1, axis=0) - ring
    lengths = np.hypot(*edges.T)
    sides = np.flatnonzero(lengths >= SIDE)
    if len(sides) < 2:
        return ring
    found: list[np.ndarray] = []
    for here, there in zip(sides, np.roll(sides, -1), strict=True):
        between = np.arange(here + 1, there if there > here else there + len(ring)) % len(ring)
        way = ring[[*between, there]]
        corner = _meeting(ring[here], edges[here], ring[there], edges[there])
        aside = [_aside(way, ring[k], edges[k]) for k in (here, there)]
        rounded = lengths[between].sum() <= CORNER and np.minimum(*aside).max() <= ROUNDED
        if rounded and corner is not None and math.dist(corner, way[0]) <= CORNER:
            found.append(corner)
        else:
            found += list(way)
    return np.array(found)


def _aside(points: np.ndarray, start: np.ndarray, along: np.ndarray) -> np.ndarray:
    """How far points (n, 2) are from a line."""
    across = points - start
    return np.abs(across[:, 0] * along[1] - across[:, 1] * along[0]) / math.hypot(*along)


def _meeting(a: np.ndarray, along: np.ndarray, b: np.ndarray, other: np.ndarray) -> np.ndarray | None:
    """Where two lines meet, from points on them and their directions; None where they are almost one line."""
    cross = along[0] * other[1] - along[1] * other[0]
    if abs(cross) < 0.3 * math.hypot(*along) * math.hypot(*other):
        return None
    across = b - a
    return a + (across[0] * other[1] - across[1] * other[0]) / cross * along


def _size(ring: np.ndarray) -> float:
    x, y = ring.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))

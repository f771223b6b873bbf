"""Closed outlines with fewer corners: removes the steps that come from the pixels of the picture.

A ring is (n, 2) in points. Its last corner is joined to its first.
"""

import math

import numpy as np

STRAIGHT = 0.2  # points: the largest deviation of a simpler outline
LONG, LEVEL = 30.0, 0.5  # points: on an edge of this length, steps of this height come from pixels
SIDE, CORNER = 20.0, 16.0  # points: two edges of this length, joined by a shorter way than this, meet in a corner
ROUNDED = 1.0  # points: and if that way is no farther from the edges than this


def simplify(ring: np.ndarray) -> np.ndarray:
    """A closed outline with fewer corners, with a deviation of at most STRAIGHT, and LEVEL along long edges.

    Ramer 1972; Douglas & Peucker 1973.
    """
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


def straighten(ring: np.ndarray) -> np.ndarray:
    """A closed outline without the corners that bend a long edge by no more than LEVEL."""
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


def sharpen_corners(ring: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """A closed outline with sharp corners, where its edges meet. `fine` is the outline before it was simplified.

    An edge is the line fitted to the points between its ends, since the ends themselves are rounded.
    """
    along = np.roll(ring, -1, axis=0) - ring
    lengths = np.hypot(*along.T)
    sides = np.flatnonzero(lengths >= SIDE)
    if len(sides) < 2:
        return ring
    lines = {int(k): _fitted(fine, ring[k], along[k]) for k in sides}
    found: list[np.ndarray] = []
    for here, there in zip(sides.tolist(), np.roll(sides, -1).tolist(), strict=True):
        between = np.arange(here + 1, there if there > here else there + len(ring)) % len(ring)
        way = ring[[*between, there]]
        corner = _meeting(*lines[here], *lines[there])
        aside = [_aside(way, *lines[k]) for k in (here, there)]
        rounded = lengths[between].sum() <= CORNER and np.minimum(*aside).max() <= ROUNDED
        if rounded and corner is not None and math.dist(corner, way[0]) <= CORNER:
            found.append(corner)
        else:
            found += list(way)
    return np.array(found)


def _fitted(points: np.ndarray, start: np.ndarray, along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(a point, a direction) of the line fitted to the points along an edge, without its ends."""
    shares = (points - start) @ along / (along @ along)
    near = points[(shares > 0.1) & (shares < 0.9) & (_aside(points, start, along) <= 2.0 * LEVEL)]
    if len(near) < 4:
        return start, along
    middle = near.mean(axis=0)
    _, _, axes = np.linalg.svd(near - middle, full_matrices=False)
    return middle, axes[0]


def _aside(points: np.ndarray, start: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Distances of points (n, 2) from a line."""
    across = points - start
    return np.abs(across[:, 0] * along[1] - across[:, 1] * along[0]) / math.hypot(*along)


def _meeting(a: np.ndarray, along: np.ndarray, b: np.ndarray, other: np.ndarray) -> np.ndarray | None:
    """The intersection of two lines, given by points and directions; None if they are nearly parallel."""
    cross = along[0] * other[1] - along[1] * other[0]
    if abs(cross) < 0.3 * math.hypot(*along) * math.hypot(*other):
        return None
    across = b - a
    return a + (across[0] * other[1] - across[1] * other[0]) / cross * along

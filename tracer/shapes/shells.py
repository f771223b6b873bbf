"""Shells of a triangle mesh: its connected pieces, which of them are closed, and which solid each bounds.

Corners at equal places are one point, whatever the file's indices. Two triangles are connected if they are the only
ones at an edge, and run along it in opposite directions. A shell is closed if every edge is run along as often in
one direction as in the other. Then its signed volume tells whether it is wound right side out (positive).

A positive shell is a solid of its own. A negative one inside a positive one is a cavity of that solid; inside no
other it is wound inside out, and must be turned.
"""

import math
from typing import NamedTuple

import numpy as np

OPEN = -1
TRIED = 8  # faces of a shell, the middles of which may show that it lies inside another one


class Shells(NamedTuple):
    """The solids of a mesh with m faces."""

    shell: np.ndarray  # (m,) number of the shell of each face
    solid: np.ndarray  # (m,) number of the solid that each face bounds, OPEN for a face of an open shell
    turned: np.ndarray  # (m,) whether the face belongs to a closed shell that is wound inside out
    count: int  # number of solids


def find_shells(corners: np.ndarray, parts: np.ndarray | None = None, media: np.ndarray | None = None) -> Shells:
    """The solids of triangles (m, 3, 3). Faces without area count as faces here: they may close a mesh.

    `parts` (m,) numbers the parts of a file: a part that is closed by itself is a shell, even if it touches another
    part. `media` (m,) are the indices of refraction, NaN for opaque faces: a cavity belongs to a solid of its own
    index, if it lies inside one.
    """
    points = welded(corners.reshape(-1, 3)).reshape(-1, 3)
    corners = corners * unit_scale(corners)
    shell, closed = shells_of(points, np.zeros(len(corners), np.int64) if parts is None else parts)
    sizes = signed_volumes(corners, shell, len(closed))
    lows, highs = bounds_of(corners, shell, len(closed))
    faces_of = grouped(shell, len(closed))
    index = np.zeros(len(closed))
    if media is not None:
        index[shell] = media
    host = np.arange(len(closed))
    solid_like = closed & (sizes > 0.0) & ~np.isnan(index)
    for k in np.flatnonzero(closed & (sizes < 0.0)):
        around = np.flatnonzero(solid_like & (lows <= lows[k]).all(axis=1) & (highs >= highs[k]).all(axis=1))
        points = corners[faces_of[k][:TRIED]].mean(axis=1)
        # The same medium first, then the smallest.
        for other in sorted(around.tolist(), key=lambda j: (index[j] != index[k], sizes[j])):
            if (winding_numbers(corners[faces_of[other]], points) > 0.5).any():
                host[k] = other
                break
    own = closed & (host == np.arange(len(closed)))
    number = np.where(own, np.cumsum(own) - 1, OPEN)
    solid = np.where(closed, number[host], OPEN)
    return Shells(shell, solid[shell], (own & (sizes < 0.0))[shell], int(own.sum()))


def unit_scale(*points: np.ndarray) -> float:
    """The power of two that makes the largest coordinate about 1, so that no product overflows or underflows."""
    largest = max(float(np.abs(some).max(initial=0.0)) for some in points)
    return math.ldexp(1.0, -math.frexp(largest)[1]) if 0.0 < largest < math.inf else 1.0


def grouped(labels: np.ndarray, count: int) -> list[np.ndarray]:
    """The positions of each label from 0 to before `count`."""
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.searchsorted(labels[order], np.arange(1, count)))


def welded(points: np.ndarray) -> np.ndarray:
    """A number (n,) for each point (n, 3). Equal points have equal numbers."""
    points = points + 0.0  # -0 becomes 0
    order = np.lexsort(points.T)
    differs = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    place = np.zeros(len(order), np.int64)
    place[order[1:]] = np.cumsum(differs)
    return place


def shells_of(faces: np.ndarray, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(shell of each face (m,), whether each shell is closed) for triangles of numbered points (m, 3).

    First the shells within each part; then those of the faces whose part is not closed by itself.
    """
    shell, closed = pieces_of(faces, parts)
    rest = ~closed[shell]
    if not rest.any() or not parts.any():
        return shell, closed
    again, closed_again = pieces_of(faces[rest], np.zeros(int(rest.sum()), np.int64))
    shell[rest] = len(closed) + again
    _, compact = np.unique(shell, return_inverse=True)
    compact = compact.ravel()
    both = np.zeros(int(compact.max()) + 1, bool)
    both[compact] = np.concatenate([closed, closed_again])[shell]
    return compact, both


def pieces_of(faces: np.ndarray, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """As `shells_of`, without connections between different parts."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    face = np.repeat(np.arange(len(faces)), 3)
    real = start != end
    start, end, face = start[real], end[real], face[real]
    low, high = np.minimum(start, end), np.maximum(start, end)
    key = low * (int(high.max(initial=0)) + 1) + high
    if parts.any():
        _, key = np.unique(key, return_inverse=True)
        key = key.ravel() * (int(parts.max()) + 1) + parts[face]
    order = np.argsort(key, kind="stable")
    key, face, way = key[order], face[order], np.where(start < end, 1, -1)[order]
    first = np.flatnonzero(np.diff(key, prepend=-1))
    count = np.diff(first, append=len(key))
    pairs = first[count == 2]
    pairs = pairs[way[pairs] + way[pairs + 1] == 0]
    label = components(len(faces), face[pairs], face[pairs + 1])
    edge = np.repeat(np.arange(len(first)), count)
    loose = unbalanced(label[face], edge, way)
    if loose.any():
        # Pieces that are not closed by themselves may close each other, at edges with more than two faces.
        at = np.flatnonzero(loose)
        joined = at[np.diff(edge[at], prepend=-1) != 0]
        anchor = np.zeros(len(first), np.int64)
        anchor[edge[joined]] = face[joined]
        a = np.concatenate([face[pairs], face[at]])
        b = np.concatenate([face[pairs + 1], anchor[edge[at]]])
        label = components(len(faces), a, b)
        loose = unbalanced(label[face], edge, way)
    _, shell = np.unique(label, return_inverse=True)
    shell = shell.ravel()
    closed = np.ones(int(shell.max(initial=-1)) + 1, bool)
    closed[shell[face[loose]]] = False
    return shell, closed


def has_holes(corners: np.ndarray) -> bool:
    """Whether triangles (m, 3, 3) have an edge at an odd number of them."""
    faces = welded(corners.reshape(-1, 3)).reshape(-1, 3)
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, counts = np.unique(edges[edges[:, 0] != edges[:, 1]], axis=0, return_counts=True)
    return bool((counts % 2).any())


def components(count: int, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The smallest number in the connected component of each of `count` nodes, for edges from a to b."""
    label = np.arange(count)
    while True:
        la, lb = label[a], label[b]
        if (la == lb).all():
            return label
        np.minimum.at(label, np.maximum(la, lb), np.minimum(la, lb))
        while (label[label] != label).any():
            label = label[label]


def unbalanced(piece: np.ndarray, edge: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Whether the piece of a face runs along the edge more often one way than the other, for each side of a face."""
    order = np.lexsort((piece, edge))
    changes = (np.diff(piece[order], prepend=-1) != 0) | (np.diff(edge[order], prepend=-1) != 0)
    group = np.cumsum(changes) - 1
    sums = np.bincount(group, way[order], minlength=int(group.max(initial=-1)) + 1)
    result = np.zeros(len(piece), bool)
    result[order] = sums[group] != 0
    return result


def signed_volumes(corners: np.ndarray, shell: np.ndarray, count: int) -> np.ndarray:
    """The volume of each shell: positive if it is wound right side out. Lengths are scaled by `unit_scale`."""
    corners = corners * unit_scale(corners)
    origin = np.zeros((count, 3))
    origin[shell] = corners[:, 0]
    a, b, c = np.moveaxis(corners - origin[shell][:, None], 1, 0)
    return np.bincount(shell, (a * np.cross(b, c)).sum(axis=1) / 6.0, minlength=count)


def bounds_of(corners: np.ndarray, shell: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The lowest and the highest corner (count, 3) of each shell's box."""
    low, high = np.full((count, 3), math.inf), np.full((count, 3), -math.inf)
    np.minimum.at(low, shell, corners.min(axis=1))
    np.maximum.at(high, shell, corners.max(axis=1))
    return low, high


def winding_number(corners: np.ndarray, p: np.ndarray) -> float:
    """As `winding_numbers`, for one point (3,)."""
    return float(winding_numbers(corners, p[None])[0])


def winding_numbers(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How often closed triangles (m, 3, 3) wind about points (n, 3): 1 inside, 0 outside, NaN on the surface; (n,).

    From the solid angles of the faces.
    Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983.
    """
    size = unit_scale(corners, points)
    corners, points = corners * size, points * size
    step = max(1, 1_000_000 // max(1, len(corners)))
    return np.concatenate(
        [np.zeros(0), *(_winding(corners, points[k : k + step]) for k in range(0, len(points), step))]
    )


def _winding(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    a, b, c = (corners[None, :, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.sqrt((x * x).sum(axis=2)) for x in (a, b, c))
    volume = (a * np.cross(b, c)).sum(axis=2)
    spread = la * lb * lc + (a * b).sum(axis=2) * lc + (b * c).sum(axis=2) * la + (c * a).sum(axis=2) * lb
    on_surface = np.maximum(np.abs(volume), spread) <= 1e-12 * la * lb * lc
    turns = 2.0 * np.arctan2(volume, spread).sum(axis=1) / (4.0 * math.pi)
    return np.where(on_surface.any(axis=1), math.nan, turns)

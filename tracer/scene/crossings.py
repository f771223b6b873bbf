"""Whether closed triangle meshes overlap: one has faces inside the other, or their surfaces cross.

Every overlap that is found is one; a small one between large meshes may be missed.
"""

from typing import NamedTuple

import numpy as np

from tracer.shapes.shells import winding_numbers

MOST_PAIRS = 1_000_000  # of faces that a test compares; of larger meshes, it leaves out faces at equal intervals


class Surface(NamedTuple):
    """A closed mesh of m triangles, of either winding."""

    corners: np.ndarray  # (m, 3, 3)
    low: np.ndarray  # (m, 3) the lowest corner of each face's box
    high: np.ndarray  # (m, 3) the highest

    @classmethod
    def of(cls, corners: np.ndarray) -> "Surface":
        a, b, c = (corners[:, k] for k in range(3))
        return cls(corners, np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c))

    def within(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """The faces (n, 3, 3) whose boxes meet a box."""
        return self.corners[(self.low <= high).all(axis=1) & (self.high >= low).all(axis=1)]


def overlap(a: Surface, b: Surface) -> bool:
    """Whether the insides of two meshes have a point in common. A common part of the surfaces alone does not count."""
    return reaches_into(a, b) or reaches_into(b, a) or cross(a, b)


def reaches_into(a: Surface, b: Surface) -> bool:
    """Whether a corner or the middle of a face of one mesh lies inside the other."""
    faces = a.corners[:: 1 + 4 * len(a.corners) * len(b.corners) // MOST_PAIRS]
    points = np.concatenate([faces.mean(axis=1), faces.reshape(-1, 3)])
    return bool((np.abs(winding_numbers(b.corners, points)) > 0.5).any())


def cross(a: Surface, b: Surface) -> bool:
    """Whether an edge of one mesh goes through a face of the other, clearly beside the edges of that face."""
    low = np.maximum(a.low.min(axis=0), b.low.min(axis=0))
    high = np.minimum(a.high.max(axis=0), b.high.max(axis=0))
    first, second = a.within(low, high), b.within(low, high)
    return edges_pierce(first, second) or edges_pierce(second, first)


def edges_pierce(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether an edge of triangles (m, 3, 3) goes through one of the triangles (n, 3, 3)."""
    if not len(a) or not len(b):
        return False
    edges = np.stack([a, np.roll(a, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    edges = edges[:: 1 + len(edges) * len(b) // MOST_PAIRS]
    size = float(max(np.abs(a).max(), np.abs(b).max()))
    step = max(1, 100_000 // len(b))
    return any(pierces(edges[k : k + step] / size, b / size).any() for k in range(0, len(edges), step))


def pierces(ends: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Whether segments (m, 2, 3) go through triangles (n, 3, 3): (m, n). Coordinates are at most 1.

    Decided by the signs of volumes of tetrahedra. Volumes near the rounding error count as no crossing.
    """
    p, q = ends[:, None, 0], ends[:, None, 1]
    a, b, c = faces[None, :, 0], faces[None, :, 1], faces[None, :, 2]
    normal = np.cross(b - a, c - a)
    above, below = ((p - a) * normal).sum(axis=2), ((q - a) * normal).sum(axis=2)
    d = q - p
    sides = np.stack([(d * np.cross(x - p, y - p)).sum(axis=2) for x, y in ((a, b), (b, c), (c, a))])
    clear = 1e-14
    through = ((above > clear) & (below < -clear)) | ((above < -clear) & (below > clear))
    return through & ((sides > clear).all(axis=0) | (sides < -clear).all(axis=0))

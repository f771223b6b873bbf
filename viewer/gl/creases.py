"""Edges where the surface of triangles bends or ends. They make clear glass visible."""

import math

import numpy as np

from tracer.shapes.tessellation import normals_of

SMOOTH = math.cos(math.radians(15.0))  # faces that meet at a smaller angle count as one smooth surface
MAX_EDGES = 4000  # a shape with more is shown by its shading


def creases(corners: np.ndarray) -> np.ndarray:
    """Edges (m, 2, 3) of triangles (n, 3, 3) where the surface turns or ends; none if there are more than MAX_EDGES."""
    nothing = np.zeros((0, 2, 3))
    if len(corners) > 10 * MAX_EDGES:
        return nothing
    places, names = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    faces = names.reshape(-1, 3)
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    n = np.repeat(normals_of(corners)[0], 3, axis=0)
    known, which, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    # The sum of two unit normals is as long as twice the cosine of half the angle between them.
    total = np.zeros((len(known), 3))
    np.add.at(total, which.ravel(), n)
    flat = (count == 2) & ((total * total).sum(axis=1) > 2.0 + 2.0 * SMOOTH)
    kept = places[known[~flat & (known[:, 0] != known[:, 1])]]
    return kept if len(kept) <= MAX_EDGES else nothing

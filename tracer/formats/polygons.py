"""Triangulation of a mesh file's polygons: convex ones as fans, the others by mapbox_earcut."""

import numpy as np

MOST_CORNERS = 10**6  # of a polygon


def triangulated(points: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of polygons.

    `points` (n, 3) are the corners of all polygons, one polygon after another; `counts` are their numbers of corners,
    each at least 3. Returns (triangles, polygons): indices (t, 3) into `points`, in the order of the polygons, and the
    number of the polygon of each triangle. A polygon with k corners has k - 2 triangles, and every side of it is a side
    of one of them, so meshes that share sides stay closed.
    """
    starts = np.cumsum(counts) - counts
    if (counts == 3).all():
        return starts[:, None] + np.arange(3), np.arange(len(counts))
    triangles, owners = [], []
    for count in np.unique(counts):
        which = np.flatnonzero(counts == count)
        corners = starts[which][:, None] + np.arange(count)
        fans = np.ones(len(which), bool) if count == 3 else _strictly_convex(points[corners])
        k = np.arange(1, count - 1)
        fan = np.stack([np.zeros_like(k), k, k + 1], axis=1)
        triangles.append(corners[fans][:, fan].reshape(-1, 3))
        owners.append(np.repeat(which[fans], count - 2))
        for polygon, own in zip(which[~fans], corners[~fans], strict=True):
            cut = _ears(points[own])
            triangles.append(own[cut])
            owners.append(np.full(len(cut), polygon))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(triangles)[order], owner[order]


def _strictly_convex(corners: np.ndarray) -> np.ndarray:
    """Whether each polygon (n, k, 3) turns to the same side at all corners, seen along its normal."""
    before, after = corners - np.roll(corners, 1, axis=1), np.roll(corners, -1, axis=1) - corners
    turns = (np.cross(before, after) * _normals(corners)[:, None]).sum(axis=2)
    return (turns > 0.0).all(axis=1)


def _normals(corners: np.ndarray) -> np.ndarray:
    """A normal of each polygon (n, k, 3): its area vector, by Newell's method about the first corner."""
    a = corners - corners[:, :1]
    return np.cross(a, np.roll(a, -1, axis=1)).sum(axis=1)


def _ears(corners: np.ndarray) -> np.ndarray:
    """Triangles (k - 2, 3) of any simple polygon (k, 3), as indices of its corners."""
    import mapbox_earcut  # few meshes have concave faces

    n = _normals(corners[None])[0]
    drop = int(np.abs(n).argmax())
    u, v = ((drop + 1) % 3, (drop + 2) % 3) if n[drop] >= 0.0 else ((drop + 2) % 3, (drop + 1) % 3)
    flat = np.ascontiguousarray(corners[:, [u, v]])
    flat = flat - flat[0]
    cut = mapbox_earcut.triangulate_float64(flat, np.array([len(flat)], np.uint32)).reshape(-1, 3).astype(np.int64)
    a, b, c = np.moveaxis(flat[cut], 1, 0)
    mirrored = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    cut[mirrored] = cut[mirrored][:, ::-1]
    return _with_all_corners(cut.tolist(), len(corners))


def _with_all_corners(triangles: list[list[int]], count: int) -> np.ndarray:
    """Split triangles at corners that earcut leaves out, because they lie on the line between their neighbours."""
    if not triangles:  # a polygon without area
        return np.array([[0, k, k + 1] for k in range(1, count - 1)])
    done, waiting = [], list(triangles)
    used = sorted({corner for triangle in triangles for corner in triangle})
    between = {a: (b - a) % count for a, b in zip(used, [*used[1:], used[0]], strict=True)}
    while waiting:
        triangle = waiting.pop()
        for _ in range(3):
            a, b, c = triangle
            if (b - a) % count > 1 and between.get(a) == (b - a) % count:
                middle = (a + 1) % count
                between[a], between[middle] = 1, (b - a) % count - 1
                waiting += [[a, middle, c], [middle, b, c]]
                break
            triangle = [b, c, a]
        else:
            done.append(triangle)
    return np.array(done)

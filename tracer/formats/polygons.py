"""Triangulation of a mesh file's polygons: convex ones as fans, the others by mapbox_earcut."""

import numpy as np

from tracer.formats.notes import Notes

MOST_CORNERS = 10**6  # of a polygon
BENT = 0.01  # largest distance of a corner from the plane of a flat polygon, relative to the polygon's size


def triangulated(points: np.ndarray, counts: np.ndarray, notes: Notes) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of polygons.

    `points` (n, 3) are the corners of all polygons, one polygon after another; `counts` are their numbers of corners,
    each at least 3. Returns (triangles, polygons): indices (t, 3) into `points`, in the order of the polygons, and the
    number of the polygon of each triangle. A polygon with k corners has k - 2 triangles, and every side of it is a side
    of one of them, so meshes that share sides stay closed.

    The triangles depend on the method where a polygon is bent, or crosses itself, which makes it a fan. Notes tell how
    many do.
    """
    starts = np.cumsum(counts) - counts
    if (counts == 3).all():
        return starts[:, None] + np.arange(3), np.arange(len(counts))
    triangles, owners = [], []
    bent = crossed = 0
    for count in np.unique(counts):
        which = np.flatnonzero(counts == count)
        corners = starts[which][:, None] + np.arange(count)
        fans = np.ones(len(which), bool)
        if count > 3:
            with np.errstate(over="ignore", invalid="ignore"):
                own = points[corners]
                normals = _normals(own)
                fans = _convex(own, normals)
                bent += int(_is_bent(own, normals).sum())
        k = np.arange(1, count - 1)
        fan = np.stack([np.zeros_like(k), k, k + 1], axis=1)
        triangles.append(corners[fans][:, fan].reshape(-1, 3))
        owners.append(np.repeat(which[fans], count - 2))
        for polygon, own in zip(which[~fans], corners[~fans], strict=True):
            with np.errstate(over="ignore", invalid="ignore"):
                cut, crosses = _cut(points[own])
            crossed += crosses
            triangles.append(own[cut])
            owners.append(np.full(len(cut), polygon))
    notes.count("polygons that are not flat are cut into triangles in one of several ways", bent)
    notes.count("polygons whose sides cross each other are cut into triangles that overlap", crossed)
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(triangles)[order], owner[order]


def _normals(corners: np.ndarray) -> np.ndarray:
    """A normal of each polygon (n, k, 3): twice its area vector, by Newell's method about the first corner."""
    spokes = corners[:, 1:] - corners[:, :1]
    return np.einsum("nkc->nc", np.cross(spokes[:, :-1], spokes[:, 1:]))


def _convex(corners: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Whether each polygon (n, k, 3) is strictly convex, seen along its normal (n, 3): it turns to the same side at all
    corners, and goes around once.
    """
    sides = np.roll(corners, -1, axis=1) - corners
    turns = np.einsum("nkc,nc->nk", np.cross(np.roll(sides, 1, axis=1), sides), normals)
    convex = (turns > 0.0).all(axis=1)
    if corners.shape[1] > 4:  # a polygon of four corners has no room to go around twice
        spokes = corners[:, 1:] - corners[:, :1]
        fan = np.einsum("nkc,nc->nk", np.cross(spokes[:, :-1], spokes[:, 1:]), normals)
        convex &= (fan > 0.0).all(axis=1)
    return convex


def _is_bent(corners: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Whether each polygon (n, k, 3) with a normal (n, 3) has corners that are clearly off its plane."""
    arms = corners - (np.einsum("nkc->nc", corners) / corners.shape[1])[:, None]
    heights = np.einsum("nkc,nc->nk", arms, normals)
    sizes = np.einsum("nkc,nkc->nk", arms, arms).max(axis=1) * np.einsum("nc,nc->n", normals, normals)
    return (heights * heights).max(axis=1) > BENT**2 * sizes


def _cut(corners: np.ndarray) -> tuple[np.ndarray, bool]:
    """(triangles (k - 2, 3), whether sides cross) of any polygon (k, 3). Triangles are indices of its corners."""
    sides = np.roll(corners, -1, axis=0) - corners
    spokes = corners - corners[0]
    n = np.cross(spokes, sides).sum(axis=0)
    parts = np.concatenate([np.cross(spokes, sides), np.cross(sides, np.roll(sides, -1, axis=0))])
    if np.abs(n).max() <= 1e-9 * np.abs(parts).max():  # a polygon like an 8, the halves of which cancel
        n = parts[np.abs(parts).max(axis=1).argmax()]
    drop = int(np.abs(n).argmax())
    u, v = ((drop + 1) % 3, (drop + 2) % 3) if n[drop] >= 0.0 else ((drop + 2) % 3, (drop + 1) % 3)
    flat = np.ascontiguousarray(corners[:, [u, v]])
    flat = flat - flat[0]
    ring, spikes = _without_spikes(flat)
    if len(ring) < 3:
        return np.array(spikes), False
    own, cut = flat[ring], _ears(flat[ring])
    k = np.arange(1, len(ring) - 1)
    fan = np.stack([np.zeros_like(k), k, k + 1], axis=1)
    areas, size = _double_areas(own[cut]), abs(_double_areas(own[fan]).sum())
    crosses = len(cut) != len(fan) or np.abs(areas).sum() - size > 1e-9 * size
    if not crosses:
        cut[areas < 0.0] = cut[areas < 0.0][:, ::-1]
    return np.concatenate([ring[fan if crosses else cut], np.array(spikes, np.int64).reshape(-1, 3)]), bool(crosses)


def _double_areas(corners: np.ndarray) -> np.ndarray:
    """Twice the signed areas of triangles (n, 3, 2) in the plane."""
    a, b, c = np.moveaxis(corners, 1, 0)
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def _without_spikes(flat: np.ndarray) -> tuple[np.ndarray, list[list[int]]]:
    """(corners that remain, triangles without area) of a polygon (k, 2).

    A spike is a corner from which the polygon returns along the line on which it came.
    """
    if not _turns_back(flat - np.roll(flat, 1, axis=0), np.roll(flat, -1, axis=0) - flat).any():
        return np.arange(len(flat)), []
    ring, spikes, k = list(range(len(flat))), [], 0
    while k < len(ring) and len(ring) > 2:
        before, after = ring[k - 1], ring[(k + 1) % len(ring)]
        if _turns_back(flat[ring[k]] - flat[before], flat[after] - flat[ring[k]]):
            spikes.append([before, ring[k], after])
            del ring[k]
            k = max(0, k - 2)
        else:
            k += 1
    return np.array(ring), spikes


def _turns_back(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Whether sides b (..., 2) lie on sides a, up to rounding, and have the opposite direction."""
    cross, dot = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0], (a * b).sum(axis=-1)
    return (dot <= 0.0) & (np.abs(cross) <= 1e-12 * np.abs(dot))


def _ears(flat: np.ndarray) -> np.ndarray:
    """Triangles (k - 2, 3) of a polygon (k, 2) in the plane."""
    import mapbox_earcut  # few meshes have concave faces

    cut = mapbox_earcut.triangulate_float64(flat, np.array([len(flat)], np.uint32)).reshape(-1, 3).astype(np.int64)
    return _with_all_corners(cut.tolist(), len(flat))


def _with_all_corners(triangles: list[list[int]], count: int) -> np.ndarray:
    """Split triangles at corners that earcut leaves out, because they lie on the line between their neighbours."""
    done, waiting = [], list(triangles)
    used = sorted({corner for triangle in triangles for corner in triangle})
    between = {a: (b - a) % count for a, b in zip(used, [*used[1:], *used[:1]], strict=True)}
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
    return np.array(done, np.int64).reshape(-1, 3)

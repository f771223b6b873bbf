"""Shapes as triangles for the 3D view. Arrays only: corners and normals in the world's own coordinates, float64.

What the tracer traces is exact; this is its picture. An endless plane becomes a large square that fades out.
"""

import math

import numpy as np

from tracer.formulas.vector import rescale, unit
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.planar import unit_normal
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle
from viewer.base.orbit import Frame

PLANE_REACH = 12.0  # radii of the scene
CREASE = math.cos(math.radians(15.0))  # faces that meet at less than this angle are meant to be one
ROUND = 64  # corners of a circle
MOST_CREASES = 4000  # a shape with more is shown by its shading


def ball(segments: int) -> tuple[np.ndarray, np.ndarray]:
    """The unit ball by circles of latitude: (corners (n, 3), which are its normals too, faces (m, 3))."""
    lines = segments // 2
    theta = np.linspace(0.0, math.pi, lines + 1)[:, None]
    phi = np.linspace(0.0, 2 * math.pi, segments + 1)[None, :]
    grid = np.stack(
        [np.sin(theta) * np.cos(phi), np.cos(theta) * np.ones_like(phi), -np.sin(theta) * np.sin(phi)], axis=-1
    )
    a = (np.arange(lines)[:, None] * (segments + 1) + np.arange(segments)[None, :]).ravel()
    b, c, d = a + segments + 1, a + segments + 2, a + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return grid.reshape(-1, 3), faces


def triangles(shape: object, frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """(corners, normals), both (n, 3, 3), of any shape."""
    match shape:
        case Sphere():
            corners, faces = ball(ROUND)
            return (np.array(shape.center) + shape.radius * corners)[faces], corners[faces]
        case Cone():
            return _cone(shape)
        case Box():
            corners = _box(shape)
        case Disc():
            corners = _disc(shape)
        case Triangle():
            corners = np.array(shape.vertices)[None]
        case Polygon():
            corners = _polygon(np.array(shape.vertices))
        case Plane():
            corners = _plane(shape, frame)
        case Mesh():
            corners = shape.placed()
            normals = shape.smooth()
            if normals is not None:
                return corners, normals
        case _:
            raise TypeError(f"no triangles for {type(shape).__name__}")
    return corners, _flat_normals(corners)


def creases(corners: np.ndarray) -> np.ndarray:
    """Edges (m, 2, 3) of triangles (n, 3, 3) where the surface turns or ends; none where there would be too many."""
    nothing = np.zeros((0, 2, 3))
    if len(corners) > 10 * MOST_CREASES:
        return nothing
    places, names = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    faces = names.reshape(-1, 3)
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    n = np.repeat(_flat_normals(corners)[:, 0], 3, axis=0)
    known, which, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    # Of two unit normals the sum is as long as twice the cosine of half the angle between them.
    total = np.zeros((len(known), 3))
    np.add.at(total, which.ravel(), n)
    flat = (count == 2) & ((total * total).sum(axis=1) > 2.0 + 2.0 * CREASE)
    kept = places[known[~flat & (known[:, 0] != known[:, 1])]]
    return kept if len(kept) <= MOST_CREASES else nothing


def _flat_normals(corners: np.ndarray) -> np.ndarray:
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(area, axis=1, keepdims=True)
    return np.repeat((area / np.where(size > 0.0, size, 1.0))[:, None], 3, axis=1)


def _box(box: Box) -> np.ndarray:
    low, high = np.array(box.min), np.array(box.max)
    faces = []
    for axis in range(3):
        u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
        for side, end in ((1.0, high), (-1.0, low)):
            at = np.where(np.arange(3) == axis, end, low)
            p, q = u * (high - low), v * (high - low)
            square = [at, at + p, at + p + q, at + q][:: int(side)]
            faces += [[square[0], square[1], square[2]], [square[0], square[2], square[3]]]
    return np.array(faces)


def _circle(normal: np.ndarray) -> np.ndarray:
    """The unit circle about a normal, counter-clockwise seen from its tip; the last corner is the first."""
    n = np.array(unit(rescale(normal)))
    u = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    u /= np.linalg.norm(u)
    phi = np.linspace(0.0, 2 * math.pi, ROUND + 1)[:, None]
    corners = np.cos(phi) * u + np.sin(phi) * np.cross(n, u)
    corners[-1] = corners[0]
    return corners


def _disc(disc: Disc) -> np.ndarray:
    """A fan about its centre."""
    rim = np.array(disc.center) + disc.radius * _circle(np.array(disc.normal))
    return np.stack([np.broadcast_to(disc.center, rim[1:].shape), rim[:-1], rim[1:]], axis=1)


def _cone(cone: Cone) -> tuple[np.ndarray, np.ndarray]:
    """A strip between its two circles, with the normals of the cone; a tip takes one triangle of each pair."""
    narrow, wide = cone.ends()
    axis = cone.axis()
    height, growth = math.hypot(*axis), abs(cone.base_radius - cone.apex_radius)
    circle = _circle(np.array(axis))
    r = min(cone.base_radius, cone.apex_radius)
    low, high = np.array(narrow) + r * circle, np.array(wide) + (r + growth) * circle
    n = (height * circle - growth * np.array(unit(rescale(axis)))) / math.hypot(height, growth)
    corners = np.stack([low[:-1], high[1:], high[:-1]], axis=1)
    normals = np.stack([n[:-1], n[1:], n[:-1]], axis=1)
    if r > 0.0:
        corners = np.concatenate([corners, np.stack([low[:-1], low[1:], high[1:]], axis=1)])
        normals = np.concatenate([normals, np.stack([n[:-1], n[1:], n[1:]], axis=1)])
    return corners, normals


def _polygon(corners: np.ndarray) -> np.ndarray:
    """Cut a flat outline, convex or not, into triangles in its own plane."""
    import mapbox_earcut

    n = unit_normal(corners)
    u = corners[1] - corners[0]
    u = u - (u @ n) * n
    u /= np.linalg.norm(u)
    flat = np.stack([(corners - corners[0]) @ u, (corners - corners[0]) @ np.cross(n, u)], axis=1)
    flat /= np.abs(flat).max()  # its size is no matter, and float64 may be out of the cutter's range
    cut = mapbox_earcut.triangulate_float64(flat, np.array([len(flat)], np.uint32)).reshape(-1, 3)
    found = corners[cut]
    turned = (np.cross(found[:, 1] - found[:, 0], found[:, 2] - found[:, 0]) @ n) < 0.0
    found[turned] = found[turned][:, ::-1]
    return found


def _plane(plane: Plane, frame: Frame) -> np.ndarray:
    """A square about the foot of the perpendicular from the scene's middle."""
    n = np.array(unit(rescale(plane.normal)))
    foot = frame.middle - ((frame.middle - plane.point) @ n) * n
    aside = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    aside /= np.linalg.norm(aside)
    u, v = PLANE_REACH * frame.radius * aside, PLANE_REACH * frame.radius * np.cross(n, aside)
    a, b, c, d = foot - u - v, foot + u - v, foot + u + v, foot - u + v
    return np.array([[a, b, c], [a, c, d]])

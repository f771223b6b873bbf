"""Triangles of round shapes for the 3D view, in plain numpy."""

import math

import numpy as np

from tracer.formulas.vector import VectorLike, rescale, unit

SEGMENTS = 64  # of a circle


def unit_ball(segments: int = SEGMENTS) -> tuple[np.ndarray, np.ndarray]:
    """(corners (n, 3), faces (m, 3)) of the unit ball, along circles of latitude. The corners are also the normals."""
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


def unit_circle(normal: VectorLike) -> np.ndarray:
    """Corners (SEGMENTS + 1, 3) of the unit circle about a normal, counter-clockwise seen from its tip, closed."""
    n = np.array(unit(rescale(normal)))
    u = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    u /= np.linalg.norm(u)
    phi = np.linspace(0.0, 2 * math.pi, SEGMENTS + 1)[:, None]
    corners = np.cos(phi) * u + np.sin(phi) * np.cross(n, u)
    corners[-1] = corners[0]
    return corners


def flat(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(corners, normals): triangles (n, 3, 3) with their faces' normals at all corners."""
    return corners, flat_normals(corners)


def flat_normals(corners: np.ndarray) -> np.ndarray:
    """Unit normals (n, 3, 3) of triangles (n, 3, 3), repeated at each corner; 0 for a triangle without area."""
    return np.repeat(normals_of(corners)[0][:, None], 3, axis=1)


def normals_of(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(unit normals (n, 3), twice the areas (n,)) of triangles (n, 3, 3)."""
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(area, axis=1)
    return area / np.where(size > 0.0, size, 1.0)[:, None], size

"""Polygons of mesh files as triangles: any simple polygon has its own area and sides; any other is noted."""

import math
from collections import Counter

import numpy as np
import pytest

from tracer.formats.notes import Notes
from tracer.formats.polygons import triangulated

U = 2.0**-53


def area(triangles: np.ndarray) -> float:
    a, b, c = np.moveaxis(triangles, 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


def cut(corners: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """(triangles as indices of the corners, notes) of one polygon. Its sides are sides of the triangles."""
    notes = Notes()
    triangles, owners = triangulated(corners, np.array([len(corners)]), notes)
    assert len(triangles) == len(corners) - 2
    assert not owners.any()
    sides: Counter[tuple[int, int]] = Counter()
    for triangle in triangles.tolist():
        sides.update(zip(triangle, [*triangle[1:], triangle[0]], strict=True))
    own = Counter((k, (k + 1) % len(corners)) for k in range(len(corners)))
    for a, b in {*sides, *own}:  # inner sides cancel
        assert sides[a, b] - sides[b, a] == own[a, b] - own[b, a]
    return triangles, notes.lines()


@pytest.mark.parametrize("seed", range(60))
def test_simple_polygon_has_its_area(seed: int) -> None:
    """Star-shaped ones in any plane, half of them with corners in the middle of sides."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 12))
    angle = (np.arange(count) + rng.random(count)) * 2.0 * math.pi / count
    radius = rng.uniform(0.2, 1.0, count)
    flat = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    if seed % 2:
        flat = np.stack([flat, 0.5 * (flat + np.roll(flat, -1, axis=0))], axis=1).reshape(-1, 2)
    x, y = flat.T
    wanted = 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
    frame = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    corners = np.c_[flat, np.zeros(len(flat))] @ frame
    triangles, notes = cut(corners)
    assert notes == []
    # Each corner is rounded, and so is each product: some 10 roundings for each of at most 24 corners.
    assert area(corners[triangles]) == pytest.approx(wanted, rel=0.0, abs=240 * U)


SPIKE = [(0, 0, 0), (2, 0, 0), (1, 0, 0), (1, 1, 0)]
DOUBLED = [(0, 0, 0), (1, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
LINE = [(0, 0, 0), (1, 1, 1), (3, 3, 3), (2, 2, 2)]
BOW = [(0, 0, 0), (2, 2, 0), (2, 0, 0), (0, 2, 0)]
PENTAGRAM = [(math.cos(0.8 * math.pi * k), math.sin(0.8 * math.pi * k), 0.0) for k in range(5)]
BENT = [(0, 0, 0), (1, 0, 0), (1, 1, 0.1), (0, 1, 0)]
ROUNDED = [(0, 0, 0), (1, 0, 0), (1, 1, 0.000001), (0, 1, 0)]


@pytest.mark.parametrize(
    ("corners", "wanted", "said"),
    [
        (SPIKE, 0.5, []),
        (DOUBLED, 1.0, []),
        (LINE, 0.0, []),
        (ROUNDED, 1.0, []),
        (BOW, None, ["polygons whose sides cross each other are cut into triangles that overlap: 1"]),
        (PENTAGRAM, None, ["polygons whose sides cross each other are cut into triangles that overlap: 1"]),
        (BENT, None, ["polygons that are not flat are cut into triangles in one of several ways: 1"]),
    ],
)
def test_odd_polygon_is_right_or_noted(
    corners: list[tuple[float, float, float]], wanted: float | None, said: list[str]
) -> None:
    points = np.array(corners, float)
    triangles, notes = cut(points)
    assert notes == said
    if wanted is not None:
        assert area(points[triangles]) == pytest.approx(wanted, abs=1e-6 if corners is ROUNDED else 8 * U)

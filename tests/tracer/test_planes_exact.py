"""Flat faces against fractions: no digit is lost by how far off they stand, how they lie, or how a ray grazes them."""

import math
from fractions import Fraction

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, world_of
from tracer.scene import Object, Shape
from tracer.shapes.disc import Disc
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.triangle import Triangle
from tracer.vector import vector

U = 2.0**-53


def fractions(v: np.ndarray | tuple) -> np.ndarray:
    return np.array([Fraction(float(x)) for x in v], object)


def corners(random: np.random.Generator, size: float) -> np.ndarray:
    """Of a triangle about (0, 0, 0), all `size` away from there."""
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return size * np.array([(1.0, 0.0, 0.0), (-0.6, 0.8, 0.0), (-0.6, -0.8, 0.0)]) @ turn.T


def face(kind: str, random: np.random.Generator, size: float) -> tuple[Shape, np.ndarray, np.ndarray]:
    """(shape, a point of it, its normal of any length), the last two exactly."""
    a, b, c = (vector(corner) for corner in corners(random, size).tolist())
    at, n = fractions(a), np.cross(fractions(b) - fractions(a), fractions(c) - fractions(a))
    if kind == "triangle":
        return Triangle((a, b, c)), at, n
    if kind == "polygon":
        return Polygon((a, b, c)), at, n
    rounded = vector([float(x) for x in n / max(map(abs, n))])
    return Plane(a, rounded) if kind == "plane" else Disc(a, rounded, 9.0 * size), at, fractions(rounded)


@pytest.mark.parametrize("kind", ["plane", "polygon", "triangle", "disc"])
@pytest.mark.parametrize("size", [1.0, 1e3, 1e6, 1e9])
def test_distance_to_a_face_is_right_to_the_last_digit(kind: str, size: float) -> None:
    """t = n.(a - o) / n.d. The hit lies in the plane, but for roundings of it and of how far the plane's point is.

    A point farther than four times the way to the hit costs no more than one there.
    """
    random = np.random.default_rng(3)
    for _ in range(25):
        shape, a, n = face(kind, random, size)
        up = (n / max(map(abs, n))).astype(float)
        up /= np.linalg.norm(up)
        away, target = random.normal(size=(2, 3))
        origin = away - (1.0 - random.choice([1.0, 1e-3])) * (away @ up) * up  # every other ray grazes it
        aim = 0.1 * (target - (target @ up) * up) - origin
        tree = tracer.trace(world_of(Object(shape, MATTE)), ray=(tuple(origin), tuple(aim)), depth=0)
        row = tree.nodes[0]
        o, d, p = (fractions(row[field]) for field in ("origin", "direction", "point"))
        t = (n @ (a - o)) / (n @ d)
        (found,) = fractions((row["t"],))
        assert abs(found - t) <= math.ulp(row["t"])
        near = min(np.abs(a.astype(float)).sum(), 4.0 * (np.abs(origin).sum() + row["t"]))
        assert abs(n @ (p - a)) <= 4 * U * math.sqrt(n @ n) * (np.abs(row["point"]).sum() + near)

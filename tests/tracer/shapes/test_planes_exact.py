"""Flat surfaces against fractions: full accuracy at any distance, orientation and grazing angle."""

import math
from fractions import Fraction

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, random_cone, world_of
from tracer.formulas.vector import vector
from tracer.rays import make_ray
from tracer.scene import Object, Shape
from tracer.shapes import intersect
from tracer.shapes.disc import Disc
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle

U = 2.0**-53


def fractions(v: np.ndarray | tuple) -> np.ndarray:
    return np.array([Fraction(float(x)) for x in v], object)


def corners(random: np.random.Generator, size: float) -> np.ndarray:
    """Corners of a triangle about (0, 0, 0), all at distance `size` from there."""
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return size * np.array([(1.0, 0.0, 0.0), (-0.6, 0.8, 0.0), (-0.6, -0.8, 0.0)]) @ turn.T


def face(kind: str, random: np.random.Generator, size: float) -> tuple[Shape, np.ndarray, np.ndarray]:
    """(shape, a point of it, its normal of any length), the last two exact."""
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
    """t = n.(a - o) / n.d. The hit lies in the plane up to its own rounding and that of the plane's point.

    A plane's point farther than four times the distance of the hit costs no more than one there.
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


@pytest.mark.parametrize("kind", ["plane", "polygon", "triangle", "disc", "ball", "cone"])
def test_asked_whether_it_is_met_a_shape_says_what_it_says_when_asked_where(kind: str) -> None:
    """The any-hit test of a shape agrees with its closest hit, for a light one rounding away and rays at the rim."""
    random = np.random.default_rng(5)
    met = 0
    for k in range(150):
        if kind == "cone":
            shape: Shape = random_cone(random, k)
        elif kind == "ball":
            shape = Sphere(vector(random.normal(size=3).tolist()), 1.5)
        else:
            shape = face(kind, random, 1.5)[0]
        if isinstance(shape, Disc):
            shape = Disc(shape.center, shape.normal, 1.5)
        world = world_of(Object(shape, MATTE)).arrays
        origin = 4.0 * random.normal(size=3)
        way = random.normal(size=3) - origin
        if isinstance(shape, Disc | Sphere) and k % 2:
            rim = np.cross(random.normal(size=3), shape.normal if isinstance(shape, Disc) else shape.center - origin)
            way = shape.center + 1.5 * rim / np.linalg.norm(rim) - origin
        ray = make_ray(
            vector(origin.tolist()), vector((way / np.linalg.norm(way)).tolist()), -1, 0.0, np.abs(origin).sum()
        )
        t = intersect(world, world.surfaces[0], ray, 0.0, math.inf, True)
        for end in [math.inf, *(t * (1.0 + j * U) for j in range(-6, 7))]:
            whether = intersect(world, world.surfaces[0], ray, 0.0, end, False) < end
            assert whether == (t < end)
        met += t < math.inf
    assert met > 5

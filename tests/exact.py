"""Vectors and surfaces in mpmath with 50 digits, for the judge. A new shape needs a function and a line in SURFACES.

A vector is an array of three mpf. A surface is all points p with q.M(q) + 2 g.q + h = 0, where q = p - at. M is the
matrix of a quadric, and 0 for a flat surface. Half the gradient, M(q) + g, points outwards.
"""

from collections.abc import Callable, Iterable
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from mpmath import mp, mpf

from tracer.scene import Shape
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Mesh
from tracer.shapes.sphere import Sphere

mp.dps = 50

Vector = np.ndarray

NAN = mpf("nan")
NOWHERE = np.array([NAN, NAN, NAN], object)


def exact(values: Iterable[Any]) -> Vector:
    """Convert float64 to mpf, without rounding."""
    return np.array([mpf(value) for value in values], object)


def dot(a: Vector, b: Vector) -> mpf:
    return (a * b).sum()


def unit(a: Vector) -> Vector:
    return a / mp.norm(a)


def root(square: mpf) -> Any:
    return mp.sqrt(square) if square >= 0 else NAN


class Surface(NamedTuple):
    at: Vector
    g: Vector
    map: Callable[[Vector], Vector] = lambda q: q * 0
    h: mpf = mpf(0)


def surface(shape: Shape, row: np.void) -> Surface:
    """The surface of the shape that a recorded ray hit."""
    if shape.name not in SURFACES:
        raise ValueError(f"the judge does not know the shape {shape.name}: add it to SURFACES")
    return SURFACES[shape.name](shape, row)


def sphere(shape: Sphere, row: np.void) -> Surface:
    return Surface(exact(shape.center), exact((0, 0, 0)), lambda q: q, -(mpf(shape.radius) ** 2))


def box(shape: Box, row: np.void) -> Surface:
    """The face of the box that is nearest to the recorded hit, among those with the axis of the recorded normal."""
    k = int(np.argmax(np.abs(row["normal"])))
    above = abs(row["point"][k] - shape.max[k]) < abs(row["point"][k] - shape.min[k])
    return Surface(exact(shape.max if above else shape.min), exact(np.eye(3)[k] * (1 if above else -1)))


def cone(shape: Cone, row: np.void) -> Surface:
    """A cone: all q measured from the base with |across|^2 = (r + slope along)^2, where q = across + along axis."""
    axis = exact(shape.apex) - exact(shape.base)
    slope = (mpf(shape.apex_radius) - mpf(shape.base_radius)) / mp.norm(axis)
    u, r = unit(axis), mpf(shape.base_radius)
    return Surface(exact(shape.base), -slope * r * u, lambda q: q - (1 + slope**2) * dot(q, u) * u, -(r**2))


def mesh(shape: Mesh, row: np.void) -> Surface:
    return flat(face(shape, row))


def flat(corners: Any) -> Surface:
    """The plane through the corners of a face."""
    return Surface(exact(corners[0]), area(corners))


SURFACES: dict[str, Callable[[Any, np.void], Surface]] = {
    "sphere": sphere,
    "plane": lambda shape, row: Surface(exact(shape.point), exact(shape.normal)),
    "polygon": lambda shape, row: flat(shape.vertices),
    "triangle": lambda shape, row: flat(shape.vertices),
    "box": box,
    "cone": cone,
    "disc": lambda shape, row: Surface(exact(shape.center), exact(shape.normal)),
    "mesh": mesh,
}


def area(corners: Iterable[Iterable[float]]) -> Vector:
    """Twice the vector area of a polygon, by Newell's sum. It points to where the corners are counter-clockwise."""
    points = [exact(corner) for corner in corners]
    return sum((np.cross(a - points[0], b - points[0]) for a, b in pairwise(points)), exact((0, 0, 0)))


@lru_cache(maxsize=8)
def placed(mesh: Mesh) -> np.ndarray:
    if mesh.smooth() is not None:
        raise ValueError(f"the judge knows no interpolated normals, and mesh {mesh.file} has them")
    return mesh.placed()


def face(mesh: Mesh, row: np.void) -> np.ndarray:
    """The corners of the mesh face with the recorded point and normal."""
    corners = placed(mesh)
    edges = np.roll(corners, -1, axis=1) - corners
    arms = row["point"] - corners
    n = np.cross(edges[:, 0], edges[:, 1])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    sizes = np.linalg.norm(edges, axis=2)
    # for each edge, the distance of the point outside it
    outside = -(np.cross(edges, arms) * n[:, None]).sum(axis=2) / sizes
    height = np.abs((arms[:, 0] * n).sum(axis=1))
    turned = np.linalg.norm(np.cross(n, row["normal"]), axis=1) * sizes.max(axis=1)
    return corners[np.argmin(height + turned + np.maximum(outside.max(axis=1), 0.0))]

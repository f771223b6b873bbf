"""Numbers, vectors and surfaces with 50 digits, for the judge. A new shape: a function, and a line in SURFACES.

A vector is an array of three mpf. A surface is all p with q.M(q) + 2 g.q + h = 0, where q = p - at: M is the map of a
quadric, 0 where the surface is flat. Half its gradient, M(q) + g, points outwards.
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
    """Floats as they are, to the last bit."""
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
    """The surface of the shape that a recorded ray met."""
    if shape.name not in SURFACES:
        raise ValueError(f"the judge does not know the shape {shape.name}: add it to SURFACES")
    return SURFACES[shape.name](shape, row)


def sphere(shape: Sphere, row: np.void) -> Surface:
    return Surface(exact(shape.center), exact((0, 0, 0)), lambda q: q, -(mpf(shape.radius) ** 2))


def box(shape: Box, row: np.void) -> Surface:
    """The nearest face whose axis is that of the recorded normal."""
    k = int(np.argmax(np.abs(row["normal"])))
    above = abs(row["point"][k] - shape.max[k]) < abs(row["point"][k] - shape.min[k])
    return Surface(exact(shape.max if above else shape.min), exact(np.eye(3)[k] * (1 if above else -1)))


def cone(shape: Cone, row: np.void) -> Surface:
    """All q from the base with |across|^2 = (r + slope along)^2, where across + along axis = q."""
    axis = exact(shape.apex) - exact(shape.base)
    slope = (mpf(shape.apex_radius) - mpf(shape.base_radius)) / mp.norm(axis)
    u, r = unit(axis), mpf(shape.base_radius)
    return Surface(exact(shape.base), -slope * r * u, lambda q: q - (1 + slope**2) * dot(q, u) * u, -(r**2))


def mesh(shape: Mesh, row: np.void) -> Surface:
    return flat(face(shape, row))


def flat(corners: Any) -> Surface:
    """The plane of a face with these corners."""
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
    """Twice the area of a face along its normal, as Newell's sum: corners counter-clockwise from the normal's tip."""
    points = [exact(corner) for corner in corners]
    return sum((np.cross(a - points[0], b - points[0]) for a, b in pairwise(points)), exact((0, 0, 0)))


@lru_cache(maxsize=8)
def placed(mesh: Mesh) -> np.ndarray:
    if mesh.smooth() is not None:
        raise ValueError(f"the judge knows no interpolated normals, and mesh {mesh.file} has them")
    return mesh.placed()


def face(mesh: Mesh, row: np.void) -> np.ndarray:
    """The corners of the face at the recorded point with the recorded normal."""
    corners = placed(mesh)
    edges = np.roll(corners, -1, axis=1) - corners
    arms = row["point"] - corners
    n = np.cross(edges[:, 0], edges[:, 1])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    sizes = np.linalg.norm(edges, axis=2)
    outside = -(np.cross(edges, arms) * n[:, None]).sum(axis=2) / sizes  # of each edge, how far
    height = np.abs((arms[:, 0] * n).sum(axis=1))
    turned = np.linalg.norm(np.cross(n, row["normal"]), axis=1) * sizes.max(axis=1)
    return corners[np.argmin(height + turned + np.maximum(outside.max(axis=1), 0.0))]

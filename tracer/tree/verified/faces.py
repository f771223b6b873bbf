"""The faces of a surface as its author wrote it, in balls.

Every shape is made of three kinds of faces: flat ones, spheres, and the sides of cones. A new kind of curved shape
needs a class like those in `curved` and a line in `faces_of`. Until then no ray that may meet it is certified.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

from tracer.formulas import exact
from tracer.formulas.rotation import rotation
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.shape import Shape
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle
from tracer.tree.verified.balls import Ball, BallVector, add, ball, balls, cross, flint, scale, subtract
from tracer.tree.verified.curved import ConeSide, SphereFace
from tracer.tree.verified.face import Face
from tracer.tree.verified.flat import Flat


def faces_of(shape: Shape, surface: int, row: int, cache: dict[int, Any]) -> list[Face] | None:
    """The faces of surface number `row` of a shape; None for a kind of shape that is not known.

    `cache` keeps what the faces of one mesh share.
    """
    match shape:
        case Sphere():
            return [SphereFace(surface, shape)]
        case Plane():
            return [_flat(surface, shape.point, shape.normal)]
        case Polygon() | Triangle():
            return [_outlined(surface, shape.vertices)]
        case Disc():
            return [_flat(surface, shape.center, shape.normal, ball(shape.radius))]
        case Box():
            return [_box_face(surface, shape, k, side) for k in range(3) for side in (-1, 1)]
        case Cone():
            return [ConeSide(surface, shape), *_end_discs(surface, shape)]
        case Mesh():
            return [_mesh_face(surface, shape, row, cache)]
    return None


def _flat(surface: int, point: Sequence[float], normal: Sequence[float], radius: Ball = None) -> Flat:
    def rational() -> tuple[exact.Exact, exact.Exact]:
        return exact.exact(point), exact.exact(normal)

    return Flat(surface, balls(point), balls(normal), (), radius, rational)


def _end_discs(surface: int, shape: Cone) -> list[Flat]:
    """The end discs of a closed cone. Its axis is the exact difference of two points."""
    found = []
    for end, other, radius in (
        (shape.base, shape.apex, shape.base_radius),
        (shape.apex, shape.base, shape.apex_radius),
    ):
        if shape.closed and radius > 0.0:
            point, normal = exact.exact(end), exact.minus(exact.exact(end), exact.exact(other))
            outwards = subtract(balls(end), balls(other))
            found.append(Flat(surface, balls(end), outwards, (), ball(radius), lambda plane=(point, normal): plane))
    return found


def _outlined(surface: int, corners: Sequence[Sequence[float]]) -> Flat:
    def rational() -> tuple[exact.Exact, exact.Exact]:
        points = [exact.exact(corner) for corner in corners]
        return points[0], exact.area(points)

    points = [balls(corner) for corner in corners]
    return Flat(surface, points[0], area(points), points, None, rational)


def area(corners: Sequence[BallVector]) -> BallVector:
    """The area vector of an outline, twice as long (Newell's rule)."""
    arms = [subtract(corner, corners[0]) for corner in corners[1:]]
    total = balls((0.0, 0.0, 0.0))
    for a, b in pairwise(arms):
        total = add(total, cross(a, b))
    return total


def _box_face(surface: int, shape: Box, k: int, side: int) -> Flat:
    low, high = np.array(shape.min), np.array(shape.max)
    end = high if side > 0 else low
    u, v = (k + 1) % 3, (k + 2) % 3
    corners = np.tile(end, (4, 1))
    corners[:, u] = (low[u], high[u], high[u], low[u])
    corners[:, v] = (low[v], low[v], high[v], high[v])
    return _outlined(surface, corners.tolist() if side > 0 else corners[::-1].tolist())


def _mesh_face(surface: int, shape: Mesh, row: int, cache: dict[int, Any]) -> Flat:
    geometry = shape.geometry
    own = geometry.faces[row].tolist()
    normals = ()
    if not shape.is_placed():
        corners = geometry.vertices[own].tolist()
        flat = _outlined(surface, corners)
        turn = None
    else:
        flat = None
        turn = cache.get(id(shape))
        if turn is None:
            turn = cache[id(shape)] = rotation(shape.rotate)
    matrix = [[_of_fraction(x) for x in line] for line in turn] if turn else None
    if matrix is not None:
        move, factor = balls(shape.translate), ball(shape.scale)
        points = [add(scale(factor, _turned(matrix, balls(v))), move) for v in geometry.vertices[own].tolist()]
        flat = Flat(surface, points[0], area(points), points)
    assert flat is not None
    if geometry.normals is not None:
        indices = own if geometry.normal_faces is None else geometry.normal_faces[row].tolist()
        normals = [balls(n) for n in geometry.normals[indices].tolist()]
        flat.smooth = [_turned(matrix, n) for n in normals] if matrix is not None else normals
    return flat


def _of_fraction(x: Fraction) -> Ball:
    """A ball around a sine or cosine, which `rotation` gives to 2^-150."""
    value = ball(x.numerator) / ball(x.denominator)
    return value if x.denominator == 1 else value + flint().arb(0, 2.0**-150)


def _turned(matrix: list[list[Ball]], v: BallVector) -> BallVector:
    x, y, z = (row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in matrix)
    return (x, y, z)

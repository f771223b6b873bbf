"""The faces of a surface as its author wrote it, in balls.

Every shape is made of three kinds of faces: flat ones, spheres, and the sides of cones. A new kind of curved shape
needs a class like those in `curved` and a line in `faces_of`. Until then no ray that may meet it is certified.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from tracer.formulas.exact import exact, minus, plane_of
from tracer.formulas.rotation import rotation
from tracer.formulas.vector import Vector
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

Matrix = list[list[Ball]]


def faces_of(shape: Shape, surface: int, row: int, turns: dict[int, Matrix]) -> Sequence[Face] | None:
    """The faces of surface number `row` of a shape; None for a kind of shape that is not known.

    `turns` keeps the rotations of meshes, by their identity: all faces of a mesh share one.
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
            return _box_faces(surface, shape)
        case Cone():
            return [ConeSide(surface, shape), *_end_discs(surface, shape)]
        case Mesh():
            return [_mesh_face(surface, shape, row, turns)]
    return None


def _flat(surface: int, point: Sequence[float], normal: Sequence[float], radius: Ball = None) -> Flat:
    return Flat(surface, balls(point), balls(normal), (), radius, lambda: (exact(point), exact(normal)))


def _end_discs(surface: int, shape: Cone) -> list[Flat]:
    """The end discs of a closed cone. Its axis is the exact difference of two points."""

    def disc(end: Vector, other: Vector, radius: float) -> Flat:
        outwards = subtract(balls(end), balls(other))
        plane = (exact(end), minus(exact(end), exact(other)))
        return Flat(surface, balls(end), outwards, (), ball(radius), lambda: plane)

    base, apex = (shape.base, shape.apex, shape.base_radius), (shape.apex, shape.base, shape.apex_radius)
    return [disc(*end) for end in (base, apex) if shape.closed and end[2] > 0.0]


def _box_faces(surface: int, shape: Box) -> list[Flat]:
    """The sides of a box, counter-clockwise from outside. In `Box.faces` lower and upper sides alternate."""
    corners = [side.vertices for (side,) in shape.faces() if isinstance(side, Polygon)]
    return [_outlined(surface, own if k % 2 else own[::-1]) for k, own in enumerate(corners)]


def _outlined(surface: int, corners: Sequence[Sequence[float]]) -> Flat:
    points = [balls(corner) for corner in corners]
    return Flat(surface, points[0], area(points), points, None, lambda: plane_of([exact(corner) for corner in corners]))


def area(corners: Sequence[BallVector]) -> BallVector:
    """The area vector of an outline, twice as long (Newell's rule)."""
    arms = [subtract(corner, corners[0]) for corner in corners[1:]]
    total = balls((0.0, 0.0, 0.0))
    for a, b in pairwise(arms):
        total = add(total, cross(a, b))
    return total


def _mesh_face(surface: int, shape: Mesh, row: int, turns: dict[int, Matrix]) -> Flat:
    geometry = shape.geometry
    own = geometry.faces[row].tolist()
    corners = geometry.vertices[own].tolist()
    normals: list[BallVector] = []
    if geometry.normals is not None:
        indices = own if geometry.normal_faces is None else geometry.normal_faces[row].tolist()
        normals = [balls(n) for n in geometry.normals[indices].tolist()]
    if not shape.is_placed():
        face = _outlined(surface, corners)
        face.smooth = normals
        return face
    if id(shape) not in turns:
        turns[id(shape)] = [[_of_fraction(x) for x in line] for line in rotation(shape.rotate)]
    turn, move, factor = turns[id(shape)], balls(shape.translate), ball(shape.scale)
    points = [add(scale(factor, _turned(turn, balls(v))), move) for v in corners]
    return Flat(surface, points[0], area(points), points, smooth=[_turned(turn, n) for n in normals])


def _of_fraction(x: Fraction) -> Ball:
    """A ball around a sine or cosine, which `rotation` gives to 2^-150."""
    value = ball(x.numerator) / ball(x.denominator)
    return value if x.denominator == 1 else value + flint().arb(0, 2.0**-150)


def _turned(matrix: Matrix, v: BallVector) -> BallVector:
    x, y, z = (row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in matrix)
    return (x, y, z)

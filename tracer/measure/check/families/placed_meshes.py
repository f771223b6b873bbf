"""The family of placed meshes: coordinates far from the origin in the file, moved back by the placement."""

import math
from collections.abc import Iterator, Sequence
from decimal import Decimal

import numpy as np

from tracer.formulas.vector import Vector, subtract
from tracer.measure.check import exact_shapes, textbook, textbook_shapes
from tracer.measure.check.case import Reading, U, case, decimal, worst_of
from tracer.measure.check.draws import Draws, plus
from tracer.measure.check.exact_optics import Point, dot, pi, point
from tracer.measure.check.scenes import DARK, path, world
from tracer.scene import Object
from tracer.shapes.mesh import Geometry, Mesh

# In units of u times the distances of the eye and of the face from the origin and from each other, over the cosine of
# incidence. Each coordinate of a placed vertex is rounded once (1); the distance to a face is right to 2 (HIT in
# `tracer.shapes.planar`).
PLACED = 3.0


def sine_and_cosine(degrees: float) -> tuple[Decimal, Decimal]:
    """By their power series."""
    x = decimal(degrees) / 180 * pi()
    sums, term, k = [Decimal(0), Decimal(0)], Decimal(1), 0
    while abs(term) > Decimal("1e-50"):
        sums[k % 2] += term if k % 4 < 2 else -term
        k += 1
        term *= x / k
    return sums[1], sums[0]


def placed(vertex: Sequence[float], scale: float, rotate: Vector, move: Vector) -> Point:
    """A vertex scaled, rotated about x, y and z, and moved, with 50 digits."""
    p = [decimal(scale) * x for x in point(vertex)]
    for axis, degrees in enumerate(rotate):
        (s, c), i, j = sine_and_cosine(degrees), (axis + 1) % 3, (axis + 2) % 3
        p[i], p[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
    return [x + y for x, y in zip(p, point(move), strict=True)]


def hits(chance: Draws, count: int) -> Iterator[Reading]:
    """Triangles of size 1, 1e2 to 1e9 away in the file."""
    for _ in range(count):
        far = chance.place(chance.size(2, 9))
        vertices = [plus(far, chance.direction()) for _ in range(3)]
        scale, rotate = (
            chance.size(-1, 1),
            (chance.uniform(-180, 180), chance.uniform(-180, 180), chance.uniform(-180, 180)),
        )
        x, y, z = (-float(x) for x in placed(far, scale, rotate, (0.0, 0.0, 0.0)))
        corners = [placed(vertex, scale, rotate, (x, y, z)) for vertex in vertices]
        shares = [decimal(share) for share in (0.2, 0.3, 0.5)]
        x_goal, y_goal, z_goal = (
            float(sum((s * c for s, c in zip(shares, column, strict=True)), Decimal(0)))
            for column in zip(*corners, strict=True)
        )
        goal = (x_goal, y_goal, z_goal)
        eye = plus(goal, chance.place(3.0 * scale))
        mesh = Mesh(Geometry(np.array(vertices), np.array([[0, 1, 2]])), "mesh", scale, rotate, (x, y, z))
        row = path(world(Object(mesh, DARK, "mesh")), eye, subtract(goal, eye)).nodes[0]
        direction = row["direction"].tolist()
        normal = exact_shapes.normal(corners)
        facing = abs(float(dot(normal, point(direction)) / dot(normal, normal).sqrt()))
        exact = exact_shapes.plane(eye, direction, corners[0], normal)
        size = math.hypot(*eye) + float(exact) + max(math.hypot(*map(float, corner)) for corner in corners)
        unit = U * size / facing
        usual = [textbook_shapes.placed(vertex, scale, rotate, (x, y, z)) for vertex in vertices]
        yield Reading("", exact, float(row["t"]), unit, PLACED, textbook.triangle(eye, direction, usual, 0.0, 0.0))


@case("B13", "meshes far from the origin in their file, moved back by their placement", seconds=0.5)
def any_placement() -> Iterator[Reading]:
    """The textbook multiplies vertices by the matrix of the placement in double precision: coordinates of 1e9 have
    errors of 1e-7, which are left when the placement moves them back. Placed in double-double, with sines and cosines
    of 48 digits, each coordinate is rounded once, however far the placement moves it.
    """
    yield worst_of("t", hits(Draws(55), 200))

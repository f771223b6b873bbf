"""Whether two faces lie exactly in one plane, as their authors wrote them. They are then one interface, and which is
met first is no decision.
"""

import numpy as np

from tracer.formulas.exact import ExactPlane, are_one_plane, exact, minus, plane_of
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.shape import Shape
from tracer.shapes.triangle import Triangle


def in_one_plane(a: Shape, row_a: int, b: Shape, row_b: int, near: np.ndarray) -> bool:
    """Whether surface `row_a` of a shape and surface `row_b` of another have faces in one plane through a point that is
    near both.
    """
    others = planes_of(b, row_b, near)
    return any(are_one_plane(one, other) for one in planes_of(a, row_a, near) for other in others)


def planes_of(shape: Shape, row: int, near: np.ndarray) -> list[ExactPlane]:
    """The planes of a surface's flat faces; of a box, of the faces near a point."""
    match shape:
        case Plane():
            return [(exact(shape.point), exact(shape.normal))]
        case Disc():
            return [(exact(shape.center), exact(shape.normal))]
        case Polygon() | Triangle():
            return [plane_of([exact(corner) for corner in shape.vertices])]
        case Box():
            faces = [(end, k) for end in (shape.min, shape.max) for k in range(3)]
            size = max(map(abs, (*shape.min, *shape.max)))
            return [(exact(end), exact(np.eye(3)[k])) for end, k in faces if abs(end[k] - near[k]) <= 1e-6 * size]
        case Cone(closed=True):
            axis = minus(exact(shape.apex), exact(shape.base))
            return [(exact(end), axis) for end in (shape.base, shape.apex)]
        case Mesh():
            return [plane_of([exact(corner) for corner in shape.placed()[row].tolist()])]
    return []

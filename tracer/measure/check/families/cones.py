"""Families of cones and cylinders: the distance to the hit, and hit or miss at the silhouette."""

import math
from collections.abc import Iterator
from decimal import localcontext

from tracer.formulas.vector import Vector, scale, subtract
from tracer.measure.check import exact_shapes, textbook_shapes
from tracer.measure.check.case import Reading, case
from tracer.measure.check.draws import Draws, perpendicular, plus
from tracer.measure.check.exact_shapes import DECIDING, Tube
from tracer.measure.check.families.judged import Decision, Hit, distances, wrong_of
from tracer.measure.check.scenes import MATTE, path, paths, world
from tracer.scene import Object
from tracer.shapes.cone import Cone


def tube(chance: Draws, narrowing: float, length: float) -> tuple[Tube, Vector]:
    """A cone or cylinder of any size in any place, and the unit vector along its axis."""
    radius = chance.size(-9, 9)
    base, axis = chance.place(radius * chance.size(-3, 6)), chance.direction()
    return Tube(base, radius, plus(base, scale(radius * length, axis)), radius * narrowing), axis


def hits(chance: Draws, count: int, cylinder: bool) -> Iterator[Hit]:
    """Rays from far and near at points of the side, some of them grazing it. Many start inside."""
    while count:
        shape, axis = tube(chance, 1.0 if cylinder else chance.random(), chance.size(-2, 2))
        share = chance.random()
        radius = shape.base_radius + (shape.apex_radius - shape.base_radius) * share
        out = perpendicular(axis, chance.direction())
        aim = plus(scale(1.0 - share, shape.base), scale(share, shape.apex), scale(radius, out))
        steep = scale(chance.choice((-1.0, 1.0)) * chance.size(-9, 0), out)
        away = plus(steep, perpendicular(out, chance.direction()))
        eye = plus(aim, scale(shape.base_radius * chance.size(-6, 6), away))
        row = path(world(Object(Cone(*shape), MATTE)), eye, subtract(aim, eye)).nodes[0]
        direction = row["direction"].tolist()
        if exact := exact_shapes.tube(eye, direction, shape):
            count -= 1
            usual = textbook_shapes.tube(eye, direction, shape, tmin=0.0)
            yield Hit(exact[0], float(row["t"]), float(row["error"]), usual)


@case("K1", "cylinders and cones of any size from anywhere: radius 1e-9 to 1e9", seconds=0.4)
def any_tube() -> Iterator[Reading]:
    """The quadratic of a cone cancels where that of a sphere does. The parts of the ray across the axis, from which it
    is made, are small differences of large vectors if the ray is nearly parallel to the axis or the base is far
    away. As for spheres, the unit is u times the distance, and the textbook has no smallest distance.
    """
    yield from distances("cylinders", hits(Draws(21), 300, cylinder=True))
    yield from distances("cones", hits(Draws(22), 300, cylinder=False))


def silhouettes(chance: Draws, cylinder: bool) -> Iterator[Decision]:
    """Rays at the middle of long tubes, within a tangent plane that was moved in or out by the margin."""
    length = 100.0
    for _ in range(50):
        shape, axis = tube(chance, 1.0 if cylinder else chance.uniform(0.5, 1.0), length)
        radius = 0.5 * (shape.base_radius + shape.apex_radius)
        middle = plus(scale(0.5, shape.base), scale(0.5, shape.apex))
        slope = (shape.apex_radius / shape.base_radius - 1.0) / length
        eyes, aims, margins = [], [], []
        for _ in range(10):
            across = perpendicular(axis, chance.direction())
            normal = plus(across, scale(-slope, axis))
            margins.append(chance.choice((-1.0, 1.0)) * 2.0 ** -chance.uniform(1, 52))
            tangent = perpendicular(
                scale(1.0 / math.hypot(*normal), normal),
                plus(perpendicular(axis, chance.direction()), scale(0.5, axis)),
            )
            touched = plus(middle, scale(radius * (1.0 + margins[-1]), across))
            eyes.append(plus(touched, scale(radius * chance.size(0.5, 4), tangent)))
            aims.append(scale(-1.0, tangent))
        found = paths(world(Object(Cone(*shape), MATTE)), eyes, aims).hits
        for row, eye, margin in zip(found, eyes, margins, strict=True):
            direction = row["direction"].tolist()
            exact = exact_shapes.tube(eye, direction, shape)
            usual = textbook_shapes.tube(eye, direction, shape, tmin=0.0)
            yield Decision(bool(exact), math.isfinite(row["t"]), usual < math.inf, margin)


@case("K2", "the silhouettes of cylinders and cones of any size, seen from anywhere", seconds=0.1)
def any_silhouette() -> Iterator[Reading]:
    """The discriminant decides, as for a sphere, and its rounding error grows with the squared distance. A ray is drawn
    with a margin relative to the radius, and then rounded to doubles; the decision is judged for the rounded ray.
    """
    with localcontext(DECIDING):
        yield wrong_of("cylinders", list(silhouettes(Draws(23), cylinder=True)))
        yield wrong_of("cones", list(silhouettes(Draws(24), cylinder=False)))

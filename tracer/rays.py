"""A ray with values that several intersection tests need, computed once.

The shear (Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013) maps space so that the ray
runs along one axis through (0, 0). Two numbers are left of each point, and their signs say on which side of the ray
it lies. A corner gets the same two numbers for every face it belongs to, so faces that share an edge leave no gap.
"""

from typing import Any, NamedTuple

import numpy as np

from tracer.compile.jit import inlined
from tracer.compile.rows import Float3, Numbers, Row, as_rows, dtype_of
from tracer.formulas.vector import Vector


class HistoryRow(Row):
    """The ways by which a ray's origin was reached. All fields are vectors (`vector_at`)."""

    approach: Float3  # the last ray before it that was longer than rounding
    before: Float3  # the way before that


APPROACH, BEFORE = range(2)  # the fields
HISTORY = dtype_of(HistoryRow)
NO_HISTORY = as_rows(np.zeros(1, HISTORY), HistoryRow)[0]  # of a ray from the eye


class Ray(NamedTuple):
    """A ray, in the world's frame and unit of length."""

    origin: Vector
    direction: Vector  # unit vector
    inverse: Vector  # 1/direction by component; infinite where that is 0
    axis: int  # index of the direction's largest component
    across: int  # the next axis, in the order x, y, z, x
    up: int  # the axis after that
    permuted_origin: Vector  # the origin's coordinates in the order of these three axes
    shear: tuple[float, float]  # the two other components of the direction over the largest
    magnitude: float  # scale of the origin's rounding errors: |x| + |y| + |z| of what it was computed from
    start: int  # id of the surface it leaves (its `coincident`), -1 for a ray from the eye
    side: float  # +1.0: it leaves on the side that the surface's normal points to; -1.0: on the other
    settles: bool  # whether it carries a set of solids; shadow rays do not
    history: Any  # `reference` to a HistoryRow: few functions read it, and six more numbers in each call take time


@inlined
def make_ray(
    origin: Vector,
    direction: Vector,
    start: int,
    side: float,
    magnitude: float,
    history: Any = NO_HISTORY,
    settles: bool = False,
) -> Ray:
    """The ray with all its derived fields; `direction` is a unit vector. Kernels must give the `history`."""
    x, y, z = abs(direction[0]), abs(direction[1]), abs(direction[2])
    inverse = (1.0 / direction[0], 1.0 / direction[1], 1.0 / direction[2])
    # Selects instead of branches: which axis it is cannot be predicted.
    along_x, along_y = x >= y and x >= z, y >= z
    axis = 0 if along_x else (1 if along_y else 2)
    across, up = select_axis(along_x, along_y, (1, 2, 0)), select_axis(along_x, along_y, (2, 0, 1))
    o, d = origin, direction
    permuted = (
        select_axis(along_x, along_y, (o[0], o[1], o[2])),
        select_axis(along_x, along_y, (o[1], o[2], o[0])),
        select_axis(along_x, along_y, (o[2], o[0], o[1])),
    )
    most = select_axis(along_x, along_y, inverse)
    shear = (
        select_axis(along_x, along_y, (d[1], d[2], d[0])) * most,
        select_axis(along_x, along_y, (d[2], d[0], d[1])) * most,
    )
    return Ray(origin, direction, inverse, axis, across, up, permuted, shear, magnitude, start, side, settles, history)


@inlined
def select_axis(along_x: bool, along_y: bool, numbers: Any) -> Any:
    """One of three numbers: the first for x, the second for y, the third for z."""
    other = numbers[1] if along_y else numbers[2]
    return numbers[0] if along_x else other


@inlined
def sheared(ray: Ray, point: Numbers | Vector) -> tuple[float, float]:
    """Coordinates of a point (three numbers) in the sheared frame, in which the ray is at (0, 0)."""
    along = point[ray.axis] - ray.permuted_origin[0]
    across, up = point[ray.across] - ray.permuted_origin[1], point[ray.up] - ray.permuted_origin[2]
    return (across - ray.shear[0] * along, up - ray.shear[1] * along)

"""A ray on its way through the scene, with what every surface test needs of it worked out once.

The shear (Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013) turns space so that the ray
runs along one axis: a point of the scene becomes two numbers, and it lies left or right of the ray by their signs.
A corner gets the same two numbers from whichever face asks, so faces that share an edge leave no gap.
"""

from typing import Any, NamedTuple

from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector


class Ray(NamedTuple):
    origin: Vector
    direction: Vector  # a unit vector
    inverse: Vector  # 1/direction, component by component; infinite where that is 0
    axis: int  # the direction's largest component
    across: int  # the next one, in the order x, y, z, x
    up: int  # and the one after that
    turned: Vector  # the origin in the order of these three
    shear: tuple[float, float]  # the two others over the largest
    reach: float  # the scale of the origin's rounding errors: |x| + |y| + |z| of what it was computed from
    start: int  # the surface it leaves (its `coincident`), -1 for a ray from the eye
    side: float  # +1.0: it leaves to the side its start's normal points to, -1.0: to the other


@inlined
def make_ray(origin: Vector, direction: Vector, start: int, side: float, reach: float) -> Ray:
    x, y, z = abs(direction[0]), abs(direction[1]), abs(direction[2])
    inverse = (1.0 / direction[0], 1.0 / direction[1], 1.0 / direction[2])
    # Choices between numbers at hand, no branches: which axis it is cannot be foreseen.
    along_x, along_y = x >= y and x >= z, y >= z
    axis = 0 if along_x else (1 if along_y else 2)
    across, up = select_axis(along_x, along_y, (1, 2, 0)), select_axis(along_x, along_y, (2, 0, 1))
    o, d = origin, direction
    turned = (
        select_axis(along_x, along_y, (o[0], o[1], o[2])),
        select_axis(along_x, along_y, (o[1], o[2], o[0])),
        select_axis(along_x, along_y, (o[2], o[0], o[1])),
    )
    most = select_axis(along_x, along_y, inverse)
    shear = (
        select_axis(along_x, along_y, (d[1], d[2], d[0])) * most,
        select_axis(along_x, along_y, (d[2], d[0], d[1])) * most,
    )
    return Ray(origin, direction, inverse, axis, across, up, turned, shear, reach, start, side)


@inlined
def select_axis(along_x: bool, along_y: bool, numbers: Any) -> Any:
    other = numbers[1] if along_y else numbers[2]
    return numbers[0] if along_x else other


@inlined
def sheared(ray: Ray, point: Any) -> tuple[float, float]:
    """Where a point, a row of three, lies beside the ray, which itself is at (0, 0)."""
    along = point[ray.axis] - ray.turned[0]
    across, up = point[ray.across] - ray.turned[1], point[ray.up] - ray.turned[2]
    return (across - ray.shear[0] * along, up - ray.shear[1] * along)

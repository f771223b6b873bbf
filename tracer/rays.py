"""A ray on its way through the scene, with what every surface test needs of it worked out once.

The shear (Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013) turns space so that the ray
runs along one axis: a point of the scene becomes two numbers, and it lies left or right of the ray by their signs.
A corner gets the same two numbers from whichever face asks, so faces that share an edge leave no gap.
"""

from typing import NamedTuple

from tracer.jit import compiled
from tracer.vector import Vector


class Ray(NamedTuple):
    origin: Vector
    direction: Vector  # a unit vector
    inverse: Vector  # 1/direction, component by component; infinite where that is 0
    axis: int  # the direction's largest component
    shear: tuple[float, float]  # the two others over the largest
    reach: float  # the scale of the origin's rounding errors: |x| + |y| + |z| of what it was computed from
    start: int  # the surface it leaves (its `twin`), -1 for a ray from the eye
    side: float  # +1.0: it leaves to the side its start's normal points to, -1.0: to the other


@compiled
def make_ray(origin: Vector, direction: Vector, start: int, side: float, reach: float) -> Ray:
    x, y, z = abs(direction[0]), abs(direction[1]), abs(direction[2])
    inverse = (1.0 / direction[0], 1.0 / direction[1], 1.0 / direction[2])
    if x >= y and x >= z:
        axis, shear = 0, (direction[1] * inverse[0], direction[2] * inverse[0])
    elif y >= z:
        axis, shear = 1, (direction[2] * inverse[1], direction[0] * inverse[1])
    else:
        axis, shear = 2, (direction[0] * inverse[2], direction[1] * inverse[2])
    return Ray(origin, direction, inverse, axis, shear, reach, start, side)


@compiled
def sheared(ray: Ray, point: Vector) -> tuple[float, float]:
    """Where a point lies beside the ray, which itself is at (0, 0)."""
    x, y, z = point[0] - ray.origin[0], point[1] - ray.origin[1], point[2] - ray.origin[2]
    if ray.axis == 0:
        along, across, up = x, y, z
    elif ray.axis == 1:
        along, across, up = y, z, x
    else:
        along, across, up = z, x, y
    return (across - ray.shear[0] * along, up - ray.shear[1] * along)

"""Which surface a ray meets next, and what it meets on the way to a light.

Surfaces are met in the order of (t, number of the surface), and a search starts behind the last one met in that order:
there is no smallest distance below which hits are thrown away. A ray that starts on a surface meets that surface again
only where its own geometry says so (`again`), never through rounding.
"""

import math
from typing import Any

import numpy as np

from tracer.jit import compiled, routine
from tracer.rays import Ray
from tracer.shapes import again, intersect
from tracer.vector import Vector, scale


SMALLEST = 5e-324  # the number after 0


@compiled
def distance(world: Any, s: int, ray: Ray, floor: float, floor_id: int, above: float) -> float:
    """Distance to surface s, if it comes after the hit (floor, floor_id); `above` is the number after `floor`."""
    least = floor if s > floor_id else above
    if s == ray.start:
        t = again(world, world.surfaces[s], ray)
        return t if t >= least else math.inf
    return intersect(world, world.surfaces[s], ray, least)


@compiled
def closest(world: Any, ray: Ray, floor: float, floor_id: int, stack: Any) -> tuple[float, int, bool]:
    """(t, surface, tied): the first hit after (floor, floor_id); surface -1 for none, tied: another is as close."""
    return closest_within(world, ray, floor, floor_id, math.inf, stack)


@routine
def closest_within(
    world: Any, ray: Ray, floor: float, floor_id: int, limit: float, stack: Any
) -> tuple[float, int, bool]:
    """`closest` among the hits no farther than `limit`."""
    above = np.nextafter(floor, math.inf) if floor > 0.0 else SMALLEST
    best, found, tied = limit, -1, False
    for k in range(len(world.unbounded)):
        s = world.unbounded[k]
        t = distance(world, s, ray, floor, floor_id, above)
        if t < best or (t == best and found < 0 and t < math.inf):
            best, found, tied = t, s, False
        elif t == best and t < math.inf:
            found, tied = min(found, s), True
    depth = 0
    node = 0 if len(world.hierarchy) > 0 else -1
    while node >= 0:
        box = world.hierarchy[node]
        if enters(box, ray, best):
            if box.count == 0:
                near, far = node + 1, box.second
                if ray.direction[box.axis] < 0.0:
                    near, far = far, near
                stack[depth] = far
                depth += 1
                node = near
                continue
            for k in range(box.second, box.second + box.count):
                s = world.order[k]
                t = distance(world, s, ray, floor, floor_id, above)
                if t < best or (t == best and found < 0 and t < math.inf):
                    best, found, tied = t, s, False
                elif t == best and t < math.inf:
                    found, tied = min(found, s), True
        if depth == 0:
            break
        depth -= 1
        node = stack[depth]
    return (best, found, tied)


# Three roundings on either side of the comparison, each at most 2^-53 of its value (pbr-book 4ed, 6.1.2 and 6.8.2).
OUTWARD = 1.0 + 8 * 2.0**-53


@compiled
def enters(box: Any, ray: Ray, best: float) -> bool:
    """Whether the ray can meet anything in the box no farther than `best`. A 0 * inf is no limit: comparing is false."""
    near, far = 0.0, best
    for k in range(3):
        low = (box.low[k] - ray.origin[k]) * ray.inverse[k]
        high = (box.high[k] - ray.origin[k]) * ray.inverse[k]
        if ray.inverse[k] < 0.0:  # and not the direction: it may be -0, its inverse is then -inf
            low, high = high, low
        high *= OUTWARD
        if low > near:
            near = low
        if high < far:
            far = high
    return near <= far


CLEAR, GLASS, OPAQUE = range(3)


@routine
def obstruction(world: Any, ray: Ray, end: float, glass_blocks: bool, stack: Any) -> int:
    """What stands nearer than `end`: OPAQUE as soon as anything that lets no light through is found, else GLASS, CLEAR."""
    above = SMALLEST
    worst = CLEAR
    for k in range(len(world.unbounded)):
        s = world.unbounded[k]
        if distance(world, s, ray, 0.0, -1, above) < end:
            if blocks(world, s, glass_blocks):
                return OPAQUE
            worst = GLASS
    depth = 0
    node = 0 if len(world.hierarchy) > 0 else -1
    while node >= 0:
        box = world.hierarchy[node]
        if enters(box, ray, end):
            if box.count == 0:
                stack[depth] = box.second
                depth += 1
                node += 1
                continue
            for k in range(box.second, box.second + box.count):
                s = world.order[k]
                if distance(world, s, ray, 0.0, -1, above) < end:
                    if blocks(world, s, glass_blocks):
                        return OPAQUE
                    worst = GLASS
        if depth == 0:
            break
        depth -= 1
        node = stack[depth]
    return worst


@compiled
def blocks(world: Any, s: int, glass_blocks: bool) -> bool:
    return glass_blocks or transmit(world, s) == 0.0


@compiled
def transmit(world: Any, s: int) -> float:
    return world.materials[world.objects[world.surfaces[s].object].material].transmit


@routine
def occluder(world: Any, ray: Ray, end: float, glass_blocks: bool, stack: Any) -> tuple[float, int]:
    """(t, surface) of the nearest one that blocks."""
    t, s, _ = closest(world, ray, 0.0, -1, stack)
    while s >= 0 and t < end and not blocks(world, s, glass_blocks):
        t, s, _ = closest(world, ray, t, s, stack)
    return (t, s)


@routine
def filtering(world: Any, ray: Ray, end: float, stack: Any) -> tuple[float, int]:
    """(product of `transmit` over the surfaces crossed nearer than `end`, first of them or -1), nearest first.

    Surfaces of one object at the same distance are one: a ray through the edge between two faces crosses once.
    """
    share, first = 1.0, -1
    last_t, last_object = -1.0, -1
    t, s, _ = closest(world, ray, 0.0, -1, stack)
    while s >= 0 and t < end:
        crossed = world.surfaces[s].object
        if t != last_t or crossed != last_object:
            share *= transmit(world, s)
        if first < 0:
            first = s
        last_t, last_object = t, crossed
        t, s, _ = closest(world, ray, t, s, stack)
    return (share, first)


@compiled
def towards_light(light: Any, point: Vector) -> tuple[Vector, float]:
    """(unit direction, distance) from a point to a light; a light at infinity is infinitely far."""
    if light.distant:
        return ((light.towards[0], light.towards[1], light.towards[2]), math.inf)
    x, y, z = light.position[0] - point[0], light.position[1] - point[1], light.position[2] - point[2]
    far = math.sqrt(x * x + y * y + z * z)
    return (scale(1.0 / far, (x, y, z)), far)

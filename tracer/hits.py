"""Which surface a ray meets next.

Surfaces are met in the order of (t, number of the surface), and a search starts behind the last one met in that order:
there is no smallest distance below which hits are thrown away. A ray that starts on a surface meets that surface again
only where its own geometry says so (`again`), never through rounding; so with any other in the very same place.
"""

import math
from typing import Any

import numpy as np

from tracer.jit import compiled, routine
from tracer.pairs import SMALLEST, U
from tracer.rays import Ray
from tracer.shapes import again, intersect


@compiled
def distance(
    world: Any, s: int, ray: Ray, floor: float, floor_id: int, above: float, ceiling: float, exactly: bool
) -> float:
    """Distance to surface s, if it comes after the hit (floor, floor_id) and not beyond the ceiling.

    `above` is the number after `floor`. Not `exactly`: only whether there is one will be asked.
    """
    least = floor if s > floor_id else above
    if world.surfaces[s].twin == ray.start:
        t = again(world, world.surfaces[s], ray)
        return t if t >= least else math.inf
    return intersect(world, world.surfaces[s], ray, least, ceiling, exactly)


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
        t = distance(world, s, ray, floor, floor_id, above, best, True)
        best, found, tied = nearer(t, s, best, found, tied)
    depth = 0
    node = 0 if len(world.hierarchy) > 0 and entry(world.hierarchy[0], ray, best) < math.inf else -1
    while node >= 0:
        box = world.hierarchy[node]
        if box.count > 0:
            for k in range(box.second, box.second + box.count):
                s = world.order[k]
                t = distance(world, s, ray, floor, floor_id, above, best, True)
                best, found, tied = nearer(t, s, best, found, tied)
            node = -1
        else:
            # Both halves at once: the nearer first, the other only while it may hold something nearer than is known.
            node, other = node + 1, box.second
            near, far = entry(world.hierarchy[node], ray, best), entry(world.hierarchy[other], ray, best)
            if far < near:
                near, far = far, near
                node, other = other, node
            if far < math.inf:
                stack[depth].node, stack[depth].near = other, far
                depth += 1
            if near == math.inf:
                node = -1
        while node < 0 and depth > 0:
            depth -= 1
            if stack[depth].near <= best:
                node = stack[depth].node
    return (best, found, tied)


@compiled
def nearer(t: float, s: int, best: float, found: int, tied: bool) -> tuple[float, int, bool]:
    """What is known after surface s was found at t (infinite: not): of several at one distance, the first surface."""
    if t < best or (t == best and found < 0 and t < math.inf):
        return (t, s, False)
    if t == best and t < math.inf:
        return (best, min(found, s), True)
    return (best, found, tied)


# Three roundings on either side of the comparison, each at most 2^-53 of its value (pbr-book 4ed, 6.1.2 and 6.8.2).
OUTWARD = 1.0 + 8 * U


@compiled
def entry(box: Any, ray: Ray, best: float) -> float:
    """Where the ray enters the box, 0 from inside; infinite if not before `best`.

    A 0 * inf sets no limit: comparing with it is false.
    """
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
    return near if near <= far else math.inf


@compiled
def transmit(world: Any, s: int) -> float:
    return world.materials[world.objects[world.surfaces[s].object].material].transmit

"""Which surface a ray meets next.

Surfaces are met in the order of (t, number of the surface), and a search starts behind the last one met in that order:
there is no smallest distance below which hits are thrown away. A ray that starts on a surface meets that surface again
only where its own geometry says so (`again`), never through rounding; so with any other in the very same place.
"""

import math
from typing import Any

import numpy as np

from tracer.accel.traversal import make_traversal
from tracer.compile.intrinsics import as_unsigned
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import SMALLEST
from tracer.rays import Ray
from tracer.shapes import intersect, next_hit


@inlined
def hit_distance(
    world: Any, s: int, ray: Ray, floor: float, floor_id: int, above: float, ceiling: float, exactly: bool
) -> float:
    """Distance to surface s, if it comes after the hit (floor, floor_id) and not beyond the ceiling.

    `above` is the number after `floor`. Not `exactly`: only whether there is one will be asked.
    """
    least = floor if s > floor_id else above
    surface = world.surfaces[as_unsigned(s)]
    if surface.coincident == ray.start:
        t = next_hit(world, surface, ray)
        return t if t >= least else math.inf
    return intersect(world, surface, ray, least, ceiling, exactly)


@inlined
def closest(world: Any, ray: Ray, floor: float, floor_id: int, space: Any) -> tuple[float, int, bool]:
    """(t, surface, tied): the first hit after (floor, floor_id); surface -1 for none, tied: another is as close."""
    return closest_within(world, ray, floor, floor_id, math.inf, space)


@compiled
def closest_within(
    world: Any, ray: Ray, floor: float, floor_id: int, limit: float, space: Any
) -> tuple[float, int, bool]:
    """`closest` among the hits no farther than `limit`."""
    above = np.nextafter(floor, math.inf) if floor > 0.0 else SMALLEST
    return search_nearest(world, ray, (floor, floor_id, above), (limit, -1, False), space)


@inlined
def try_surface(
    world: Any, s: int, ray: Ray, after: tuple[float, int, float], known: tuple[float, int, bool], space: Any
) -> tuple[float, int, bool]:
    space.tests[0] += 1
    best, found, tied = known
    t = hit_distance(world, s, ray, after[0], after[1], after[2], best, True)
    return update_closest(t, s, best, found, tied)


search_nearest = make_traversal(try_surface, nearest_first=True)


@inlined
def update_closest(t: float, s: int, best: float, found: int, tied: bool) -> tuple[float, int, bool]:
    """What is known after surface s was found at t (infinite: not): of several at one distance, the first surface."""
    if t < best or (t == best and found < 0 and t < math.inf):
        return (t, s, False)
    if t == best and t < math.inf:
        return (best, min(found, s), True)
    return (best, found, tied)


@inlined
def transmit(world: Any, s: int) -> float:
    return world.materials[world.objects[world.surfaces[s].object].material].transmit

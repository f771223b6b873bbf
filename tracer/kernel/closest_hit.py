"""Closest-hit search: the surface that a ray meets next.

Hits are ordered by (t, surface id), and a search starts after the last hit in that order. So there is no smallest
distance below which hits are discarded. A ray that starts on a surface meets that surface again only where the geometry
says so (`next_hit`), never because of rounding. The same holds for a surface that coincides with it.
"""

import math

import numpy as np

from tracer.accel.traversal import make_traversal
from tracer.compile.intrinsics import as_unsigned
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import SMALLEST
from tracer.kernel.arrays import Arrays
from tracer.kernel.workspace import Space
from tracer.rays import Ray


@inlined
def hit_distance(
    world: Arrays, s: int, ray: Ray, t_min: float, min_id: int, next_t: float, t_max: float, exact: bool
) -> float:
    """Distance to surface s, if the hit comes after (t_min, min_id) and at most at t_max; else inf.

    `next_t` is the float after `t_min`. Unless `exact`, the result only tells whether there is a hit.
    """
    least = t_min if s > min_id else next_t
    surface = world.surfaces[as_unsigned(s)]
    if surface.coincident == ray.start:
        t = world.formulas.next_hit(world, surface, ray)
        return t if t >= least else math.inf
    return world.formulas.intersect(world, surface, ray, least, t_max, exact)


@inlined
def closest(world: Arrays, ray: Ray, t_min: float, min_id: int, space: Space) -> tuple[float, int, bool]:
    """(t, surface, tied) of the first hit after (t_min, min_id). Surface -1: none; tied: another is at the same t."""
    return closest_within(world, ray, t_min, min_id, math.inf, space)


@compiled
def closest_within(
    world: Arrays, ray: Ray, t_min: float, min_id: int, limit: float, space: Space
) -> tuple[float, int, bool]:
    """`closest` among the hits with t <= limit."""
    next_t = np.nextafter(t_min, math.inf) if t_min > 0.0 else SMALLEST
    return search_closest(world, ray, (t_min, min_id, next_t), (limit, -1, False), space)


@inlined
def try_surface(
    world: Arrays, s: int, ray: Ray, after: tuple[float, int, float], found: tuple[float, int, bool], space: Space
) -> tuple[float, int, bool]:
    """Test surface s."""
    space.tests[0] += 1
    best, surface, tied = found
    t = hit_distance(world, s, ray, after[0], after[1], after[2], best, True)
    return update_closest(t, s, best, surface, tied)


search_closest = make_traversal(try_surface, nearest_first=True)


@inlined
def update_closest(t: float, s: int, best: float, found: int, tied: bool) -> tuple[float, int, bool]:
    """Update the closest hit with surface `s` at distance `t` (inf: no hit). Ties go to the lower surface id."""
    if t < best or (t == best and found < 0 and t < math.inf):
        return (t, s, False)
    if t == best and t < math.inf:
        return (best, min(found, s), True)
    return (best, found, tied)


@inlined
def transmit(world: Arrays, s: int) -> float:
    """The `transmit` of the material of surface s."""
    return world.materials[world.objects[world.surfaces[s].object].material].transmit

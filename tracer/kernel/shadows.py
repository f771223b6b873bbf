"""Shadow rays: the fraction of a light's radiance that reaches a point.

An opaque surface on the way blocks the light. Each transparent one multiplies it by its `transmit`, without bending
the ray. This is a simplification: light that really gets there through glass is bent on its way. With
`glass_blocks`, transparent surfaces block it, too.

A shadow ray starts in the solids that its hit says. Where it leaves a closed solid that it is not in, it crosses
nothing: rounding has put that surface on the wrong side of the hit. Other rays treat it in the same way
(`coincident_surfaces`).
"""

import math

import numpy as np

from tracer.accel.traversal import STOP, make_traversal
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Rows
from tracer.formulas.double_double import SMALLEST
from tracer.formulas.media import contains, set_inside
from tracer.formulas.vector import LONGEST, SHORTEST, Vector, length, near_one, scale, subtract, vector
from tracer.kernel.arrays import Arrays, LightRow
from tracer.kernel.closest_hit import closest, hit_distance, transmit
from tracer.kernel.coincident_surfaces import is_entering
from tracer.kernel.workspace import CrossingRow, Space
from tracer.rays import Ray

OPAQUE, OVERFLOW = -1, -2  # instead of a number of crossings


@inlined
def light_direction(light: LightRow, point: Vector) -> tuple[Vector, float]:
    """(unit direction, distance) from a point to a light. A light at infinity is at distance inf."""
    if light.distant:
        return ((light.towards[0], light.towards[1], light.towards[2]), math.inf)
    to_light = subtract(vector(light.position), point)
    distance = length(to_light)
    if distance < SHORTEST or distance > LONGEST:
        return scaled_direction(to_light)
    return (scale(1.0 / distance, to_light), distance)


@compiled
def scaled_direction(v: Vector) -> tuple[Vector, float]:
    """(unit direction, length) of a vector whose squares underflow or overflow; (0, 0) for the zero vector."""
    noinline()
    scaled, exponent = near_one(v)
    distance = length(scaled)
    if distance == 0.0:
        return (v, 0.0)
    return (scale(1.0 / distance, scaled), math.ldexp(distance, exponent))


@inlined
def transmittance(
    world: Arrays, ray: Ray, end: float, glass_blocks: bool, row: int, behind: bool, space: Space
) -> tuple[float, int]:
    """(share of the light that passes, first transparent surface crossed or -1), over the distance `end`.

    The ray starts at the hit of a row: `behind` the surface, or before it. The share is 0 where an opaque surface is in
    the way.
    """
    count = collect_crossings(world, ray, end, space)
    if count == 0:
        return (1.0, -1)
    if count == OPAQUE:
        return (0.0, -1)
    if count == OVERFLOW:
        enter_solids(space, row, behind)
        share, first = filter_stepwise(world, ray, end, space)
    else:
        doubtful = not adds_up(world, count, row, behind, space)
        if doubtful:
            enter_solids(space, row, behind)
        share, first = filter_sorted(world, ray, count, doubtful, space)
    return (0.0, -1) if glass_blocks and first >= 0 else (share, first)


@inlined
def adds_up(world: Arrays, count: int, row: int, behind: bool, space: Space) -> bool:
    """Whether the ray crosses each closed solid that it does not start in an even number of times: it enters and leaves
    it. If not, it leaves one that it is not in, or the light lies in one.
    """
    for k in range(count):
        solid = world.surfaces[space.crossed[k].surface].solid
        if solid >= 0 and world.closed[solid] and not contains(space.solids[row, 1 if behind else 0], solid):
            times = 0
            for j in range(count):
                times += world.surfaces[space.crossed[j].surface].solid == solid
            if times % 2 == 1:
                return False
    return True


@inlined
def enter_solids(space: Space, row: int, behind: bool) -> None:
    """Start with the solids around a hit."""
    side = 1 if behind else 0
    for k in range(len(space.around)):
        space.around[k] = space.solids[row, side, k]


@inlined
def is_crossed(world: Arrays, ray: Ray, t: float, s: int, space: Space) -> bool:
    """Whether the ray crosses the transparent surface s at t. The solids around it change."""
    solid = world.surfaces[s].solid
    if solid < 0 or not world.closed[solid]:
        return True
    enters = is_entering(world, s, ray, t)
    crossed = enters or contains(space.around, solid)
    set_inside(space.around, solid, enters)
    return crossed


@compiled
def collect_crossings(world: Arrays, ray: Ray, end: float, space: Space) -> int:
    """Any-hit search: the number of transparent surfaces met before `end`, stored in no order in `space.crossed`.

    OPAQUE as soon as a surface is found that lets no light through; OVERFLOW if there are too many.
    """
    return search_occluders(world, ray, (), (end, 0), space)[1]


@inlined
def test_occluder(
    world: Arrays, s: int, ray: Ray, _: tuple[()], found: tuple[float, int], space: Space
) -> tuple[float, int]:
    """(search limit, count) after a test of surface s."""
    space.tests[0] += 1
    end, count = found
    if hit_distance(world, s, ray, 0.0, -1, SMALLEST, end, False) >= end:
        return found
    if transmit(world, s) == 0.0:
        return (STOP, OPAQUE)
    return (end, add_crossings(world, s, ray, end, space.crossed, count))


search_occluders = make_traversal(test_occluder, nearest_first=False)


@compiled
def add_crossings(world: Arrays, s: int, ray: Ray, end: float, crossed: Rows[CrossingRow], count: int) -> int:
    """Store each crossing of the transparent surface s. A ball may be crossed twice."""
    noinline()
    t, above = 0.0, SMALLEST
    while True:
        t = hit_distance(world, s, ray, t, s, above, end, True)
        if t >= end:
            return count
        if count == OVERFLOW or count == len(crossed):
            return OVERFLOW
        crossed[count].t = t
        crossed[count].surface = s
        count += 1
        above = np.nextafter(t, math.inf)


@compiled
def filter_sorted(world: Arrays, ray: Ray, count: int, doubtful: bool, space: Space) -> tuple[float, int]:
    """(product of `transmit`, first surface) over the stored crossings, nearest first.

    Surfaces of one object at the same distance count once: a ray through the edge of two faces crosses once. If the
    crossings are `doubtful`, those are left out where the ray leaves a solid that it is not in.
    """
    noinline()
    crossed = space.crossed
    share, first = 1.0, -1
    last_t, last_object = -1.0, -1
    for done in range(count):
        k = done
        for j in range(done + 1, count):
            nearer = crossed[j].t < crossed[k].t
            if nearer or (crossed[j].t == crossed[k].t and crossed[j].surface < crossed[k].surface):
                k = j
        t, s = crossed[k].t, crossed[k].surface
        crossed[k].t, crossed[k].surface = crossed[done].t, crossed[done].surface
        if doubtful and not is_crossed(world, ray, t, s, space):
            continue
        if t != last_t or world.surfaces[s].object != last_object:
            share *= transmit(world, s)
        first = s if first < 0 else first
        last_t, last_object = t, world.surfaces[s].object
    return (share, first)


@compiled
def filter_stepwise(world: Arrays, ray: Ray, end: float, space: Space) -> tuple[float, int]:
    """`filter_sorted` for any number of crossings, with one closest-hit search for each."""
    noinline()
    share, first = 1.0, -1
    last_t, last_object = -1.0, -1
    t, s, _ = closest(world, ray, 0.0, -1, space)
    while s >= 0 and t < end:
        if is_crossed(world, ray, t, s, space):
            this = world.surfaces[s].object
            if t != last_t or this != last_object:
                share *= transmit(world, s)
            if first < 0:
                first = s
            last_t, last_object = t, this
        t, s, _ = closest(world, ray, t, s, space)
    return (share, first)


@compiled
def nearest_occluder(
    world: Arrays, ray: Ray, end: float, glass_blocks: bool, row: int, behind: bool, space: Space
) -> tuple[float, int]:
    """(t, surface) of the nearest surface that blocks the light, as for `transmittance`."""
    enter_solids(space, row, behind)
    t, s, _ = closest(world, ray, 0.0, -1, space)
    while s >= 0 and t < end and transmit(world, s) > 0.0:
        if is_crossed(world, ray, t, s, space) and glass_blocks:
            break
        t, s, _ = closest(world, ray, t, s, space)
    return (t, s)

"""What a ray meets on its way to a light, and how much of the light gets through.

An opaque surface on the way blocks it. Each transparent one multiplies it by its `transmit`, straight through and
unbent: a simplification, since the light that really arrives there was bent on its way. Or, if the scene wants it,
glass blocks too.
"""

import math
from typing import Any

import numpy as np

from tracer.accel.traversal import STOP, make_traversal
from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import SMALLEST
from tracer.formulas.vector import Vector, length, scale, subtract, unit, vector
from tracer.kernel.closest_hit import closest, hit_distance, transmit
from tracer.rays import Ray

# A transparent surface crossed on the way, and the room for so many before the slower way is taken.
CROSSING = np.dtype([("t", np.float64), ("surface", np.int64)])
MAX_CROSSINGS = 32

# Between these lengths squares neither vanish nor overflow.
SHORTEST, LONGEST = 1e-140, 1e140

OPAQUE, OVERFLOW = -1, -2  # instead of a number of crossings


@inlined
def light_direction(light: Any, point: Vector) -> tuple[Vector, float]:
    """(unit direction, distance) from a point to a light; a light at infinity is infinitely far."""
    if light.distant:
        return ((light.towards[0], light.towards[1], light.towards[2]), math.inf)
    way = subtract(vector(light.position), point)
    far = length(way)
    if far < SHORTEST or far > LONGEST:
        return scaled_direction(way)
    return (scale(1.0 / far, way), far)


@compiled
def scaled_direction(way: Vector) -> tuple[Vector, float]:
    """(unit direction, length) of a vector whose squares are out of range; nowhere where the light is in the point."""
    noinline()
    size = max(abs(way[0]), max(abs(way[1]), abs(way[2])))
    if size == 0.0:
        return (way, 0.0)
    way = (way[0] / size, way[1] / size, way[2] / size)
    return (unit(way), size * length(way))


@inlined
def transmittance(world: Any, ray: Ray, end: float, glass_blocks: bool, space: Any) -> tuple[float, int]:
    """(share of the light, first transparent surface crossed or -1); 0 where an opaque one is nearer than `end`."""
    count = collect_crossings(world, ray, end, glass_blocks, space)
    if count == 0:
        return (1.0, -1)
    if count == OPAQUE:
        return (0.0, -1)
    if count == OVERFLOW:
        return filter_stepwise(world, ray, end, space)
    return filter_sorted(world, space.crossed, count)


@compiled
def collect_crossings(world: Any, ray: Ray, end: float, glass_blocks: bool, space: Any) -> int:
    """How many times transparent surfaces are crossed nearer than `end`, gathered in no order; OPAQUE as soon as
    anything is found that lets no light through; TOO_MANY."""
    return search_occluders(world, ray, glass_blocks, (end, 0), space)[1]


@inlined
def test_occluder(
    world: Any, s: int, ray: Ray, glass_blocks: bool, known: tuple[float, int], space: Any
) -> tuple[float, int]:
    """(how far to look on, count) after surface s has been looked at."""
    space.tests[0] += 1
    end, count = known
    if hit_distance(world, s, ray, 0.0, -1, SMALLEST, end, False) >= end:
        return known
    if glass_blocks or transmit(world, s) == 0.0:
        return (STOP, OPAQUE)
    return (end, add_crossings(world, s, ray, end, space.crossed, count))


search_occluders = make_traversal(test_occluder, nearest_first=False)


@compiled
def add_crossings(world: Any, s: int, ray: Ray, end: float, crossed: Any, count: int) -> int:
    """Note where the transparent surface s is crossed: a ball may be crossed twice."""
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
def filter_sorted(world: Any, crossed: Any, count: int) -> tuple[float, int]:
    """(product of `transmit`, first surface) over the crossings gathered, nearest first.

    Surfaces of one object at the same distance are one: a ray through the edge between two faces crosses once.
    """
    noinline()
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
        if t != last_t or world.surfaces[s].object != last_object:
            share *= transmit(world, s)
        first = s if first < 0 else first
        last_t, last_object = t, world.surfaces[s].object
    return (share, first)


@compiled
def filter_stepwise(world: Any, ray: Ray, end: float, space: Any) -> tuple[float, int]:
    """The same, crossing by crossing, however many there are."""
    noinline()
    share, first = 1.0, -1
    last_t, last_object = -1.0, -1
    t, s, _ = closest(world, ray, 0.0, -1, space)
    while s >= 0 and t < end:
        this = world.surfaces[s].object
        if t != last_t or this != last_object:
            share *= transmit(world, s)
        if first < 0:
            first = s
        last_t, last_object = t, this
        t, s, _ = closest(world, ray, t, s, space)
    return (share, first)


@compiled
def nearest_occluder(world: Any, ray: Ray, end: float, glass_blocks: bool, space: Any) -> tuple[float, int]:
    """(t, surface) of the nearest one that blocks."""
    t, s, _ = closest(world, ray, 0.0, -1, space)
    while s >= 0 and t < end and not glass_blocks and transmit(world, s) > 0.0:
        t, s, _ = closest(world, ray, t, s, space)
    return (t, s)

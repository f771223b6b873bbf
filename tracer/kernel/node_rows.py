"""Rows of the node table: how they begin, and how a shadow ray's is filled in for whoever reads it."""

import math
from typing import Any

from tracer.compile.jit import compiled, inlined
from tracer.formulas.vector import Vector, add, dot, multiply, scale, store, vector
from tracer.kernel.closest_hit import transmit
from tracer.kernel.limits import Limits
from tracer.kernel.nodes import BLOCKED, FILTERED, LIT, NONE, SHADOW
from tracer.kernel.shadows import nearest_occluder, transmittance
from tracer.rays import Ray, make_ray


@inlined
def start_row(
    limits: Limits, table: Any, i: int, parent: int, kind: int, depth: int, factor: Vector, weight: Vector
) -> Any:
    """Row i as it is before anything is known of the ray but where it comes from."""
    row = table[i]
    row.kind = kind
    row.depth = depth
    store(row.factor, factor)
    store(row.weight, weight)
    row.surface = NONE
    row.child = NONE
    row.sibling = NONE
    row.end = NONE
    row.cut = 0.0
    if limits.records:
        nowhere = (math.nan, math.nan, math.nan)
        row.id = i
        row.parent = parent
        row.t = math.nan
        store(row.point, nowhere)
        store(row.normal, nowhere)
        row.object = NONE
        row.light = NONE
        row.n1 = math.nan
        row.n2 = math.nan
        row.theta1 = math.nan
        row.theta2 = math.nan
        row.radicand = math.nan
        row.error = math.nan
        row.turn = math.nan
    return row


@compiled
def record_shadow(
    world: Any,
    limits: Limits,
    space: Any,
    i: int,
    parent: int,
    light: int,
    ray: Ray,
    far: float,
    visible: float,
    glass: int,
    share: Vector,
) -> None:
    """Row i: a shadow ray to a light at distance `far`, with what stands in its way by name."""
    t, met, end = far, glass, FILTERED if glass >= 0 else LIT
    if visible == 0.0:
        nearest, s = nearest_occluder(world, ray, far, limits.glass_blocks, space)
        if nearest < far:  # else it was so much glass that nothing is left
            t, met, end = nearest, s, BLOCKED
    write_shadow(world, limits, space.table, i, parent, light, ray, t, met, end, visible, share)


@compiled
def record_unlit(
    world: Any, limits: Limits, space: Any, i: int, parent: int, light: int, to_light: Vector, far: float
) -> None:
    """Row i: a shadow ray to a light that adds nothing at its parent's hit, wherever it gets to.

    Where the surface faces away from the light, it is itself the first that stands in the way: at no distance.
    """
    row = space.table[parent]
    s, nothing = row.surface, (0.0, 0.0, 0.0)
    faces_it = dot(vector(row.face), to_light) > 0.0
    own = 1.0 if faces_it else transmit(world, s)
    side = row.hit_side if faces_it else -row.hit_side
    ray = make_ray(vector(row.point), to_light, world.surfaces[s].coincident, side, rounding_scale(row))
    if own == 0.0 or (limits.glass_blocks and not faces_it):
        write_shadow(world, limits, space.table, i, parent, light, ray, 0.0, s, BLOCKED, 0.0, nothing)
        return
    visible, glass = transmittance(world, ray, far, limits.glass_blocks, space)
    first = glass if faces_it else s
    record_shadow(world, limits, space, i, parent, light, ray, far, own * visible, first, nothing)


@inlined
def write_shadow(
    world: Any,
    limits: Limits,
    table: Any,
    i: int,
    parent: int,
    light: int,
    ray: Ray,
    t: float,
    met: int,
    end: int,
    visible: float,
    share: Vector,
) -> None:
    """Row i, when all is known of the shadow ray: it ends at t, and met is a surface or -1."""
    attenuation = (visible, visible, visible)
    weight = multiply(vector(table[parent].weight), attenuation)
    row = start_row(limits, table, i, parent, SHADOW, table[parent].depth, attenuation, weight)
    row.light = light
    store(row.origin, ray.origin)
    store(row.direction, ray.direction)
    store(row.local, share)
    store(row.radiance, share)
    row.end = end
    row.start, row.side, row.reach, row.surface = ray.start, ray.side, ray.reach, met
    if met >= 0:
        row.object = world.surfaces[met].object
    if t < math.inf:
        row.t = t
        store(row.point, add(ray.origin, scale(t, ray.direction)))


@inlined
def rounding_scale(row: Any) -> float:
    """How large the numbers are that a hit was computed from: its rounding errors are small beside this.

    What the ray's own start was computed from counts too: a ray in a corner meets the next wall where it starts.
    """
    return max(row.reach, abs(row.origin[0]) + abs(row.origin[1]) + abs(row.origin[2]) + row.t)

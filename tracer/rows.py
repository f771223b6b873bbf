"""Rows of the node table: how they begin, and how a shadow ray's is filled in for whoever reads it."""

import math
from typing import Any

from tracer.jit import compiled, routine
from tracer.limits import Limits
from tracer.nodes import BLOCKED, FILTERED, LIT, NONE, SHADOW
from tracer.rays import Ray
from tracer.shadows import occluder
from tracer.vector import Vector, add, multiply, scale, store, vector


@compiled
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
    row.children = 0
    row.first_child = NONE
    row.end = NONE
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
    return row


@routine
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
    table = space.table
    attenuation = (visible, visible, visible)
    weight = multiply(vector(table[parent].weight), attenuation)
    row = start_row(limits, table, i, parent, SHADOW, table[parent].depth, attenuation, weight)
    row.light = light
    store(row.origin, ray.origin)
    store(row.direction, ray.direction)
    store(row.local, share)
    store(row.radiance, share)
    t, met = far, glass
    row.end = FILTERED if glass >= 0 else LIT
    if visible == 0.0:
        row.end = BLOCKED
        t, met = occluder(world, ray, far, limits.glass_blocks, space.stack)
    if met >= 0:
        row.object = world.surfaces[met].object
    if t < math.inf:
        row.t = t
        store(row.point, add(ray.origin, scale(t, ray.direction)))


@compiled
def way_length(row: Any) -> float:
    """How large the numbers are that a hit was computed from: its rounding errors are small beside this.

    What the ray's own start was computed from counts too: a ray in a corner meets the next wall where it starts.
    """
    return max(row.reach, abs(row.origin[0]) + abs(row.origin[1]) + abs(row.origin[2]) + row.t)

"""Rows of the node table: how they start, and how those of shadow rays are filled in for readers."""

import math

from tracer.compile.intrinsics import reference, vector_at
from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Rows
from tracer.formulas.vector import Vector, add, dot, multiply, scale, store, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.closest_hit import transmit
from tracer.kernel.limits import Limits
from tracer.kernel.nodes import BLOCKED, FILTERED, LIT, NONE, SHADOW, NodeRow
from tracer.kernel.shadows import nearest_occluder, transmittance
from tracer.kernel.workspace import Space
from tracer.rays import APPROACH, BEFORE, HistoryRow, Ray, make_ray
from tracer.shapes.outline import PLANE_ERROR


@inlined
def start_row(
    limits: Limits, table: Rows[NodeRow], i: int, parent: int, kind: int, depth: int, factor: Vector, weight: Vector
) -> NodeRow:
    """Initialise row i, before its ray is traced. All other fields are set to absent."""
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
    return row


@compiled
def record_shadow(
    world: Arrays,
    limits: Limits,
    space: Space,
    i: int,
    parent: int,
    light: int,
    ray: Ray,
    distance: float,
    visible: float,
    glass: int,
    behind: bool,
    share: Vector,
) -> None:
    """Write row i, a shadow ray to a light at `distance`. `visible` is the share of light that passes.

    `glass` is the first transparent surface crossed, -1 for none; `share` the light's share of the local term. The ray
    starts `behind` the surface or before it.
    """
    t, met, end = distance, glass, FILTERED if glass >= 0 else LIT
    if visible == 0.0:
        nearest, s = nearest_occluder(world, ray, distance, limits.glass_blocks, parent, behind, space)
        if nearest < distance:  # otherwise glass alone has absorbed all light
            t, met, end = nearest, s, BLOCKED
    write_shadow(world, limits, space.table, i, parent, light, ray, t, met, end, visible, share)


@compiled
def record_unlit(
    world: Arrays, limits: Limits, space: Space, i: int, parent: int, light: int, to_light: Vector, distance: float
) -> None:
    """Write row i, a shadow ray to a light that adds nothing to the local term, whether it is reached or not.

    An opaque surface that faces away from the light blocks its own shadow ray, at distance 0.
    """
    row = space.table[parent]
    s, nothing = row.surface, (0.0, 0.0, 0.0)
    faces_it = dot(vector(row.face_normal), to_light) > 0.0
    own = 1.0 if faces_it else transmit(world, s)
    side = row.hit_side if faces_it else -row.hit_side
    start, size = world.surfaces[s].coincident, rounding_scale(row)
    ray = make_ray(vector(row.point), to_light, start, side, size, reference(space.way[0]))
    if own == 0.0 or (limits.glass_blocks and not faces_it):
        write_shadow(world, limits, space.table, i, parent, light, ray, 0.0, s, BLOCKED, 0.0, nothing)
        return
    visible, glass = transmittance(world, ray, distance, limits.glass_blocks, parent, not faces_it, space)
    first = glass if faces_it else s
    record_shadow(world, limits, space, i, parent, light, ray, distance, own * visible, first, not faces_it, nothing)


@inlined
def write_shadow(
    world: Arrays,
    limits: Limits,
    table: Rows[NodeRow],
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
    """Write row i of a shadow ray that ends at distance t, where it met the surface `met` (-1: none)."""
    attenuation = (visible, visible, visible)
    weight = multiply(vector(table[parent].weight), attenuation)
    row = start_row(limits, table, i, parent, SHADOW, table[parent].depth, attenuation, weight)
    row.light = light
    store(row.origin, ray.origin)
    store(row.direction, ray.direction)
    store(row.local, share)
    store(row.radiance, share)
    row.end = end
    row.start, row.side, row.magnitude, row.surface = ray.start, ray.side, ray.magnitude, met
    store(row.history.approach, vector_at(ray.history, APPROACH))
    store(row.history.before, vector_at(ray.history, BEFORE))
    if met >= 0:
        row.object = world.surfaces[met].object
    if t < math.inf:
        row.t = t
        store(row.point, add(ray.origin, scale(t, ray.direction)))


@inlined
def rounding_scale(row: NodeRow) -> float:
    """The magnitude of the numbers that a hit was computed from: its rounding errors are relative to it.

    It includes that of the ray's origin: a ray that starts in a corner meets the next wall at distance 0.
    """
    return max(row.magnitude, abs(row.origin[0]) + abs(row.origin[1]) + abs(row.origin[2]) + row.t)


@inlined
def write_way(row: NodeRow, way: HistoryRow) -> None:
    """Write the way by which the hit of a row was reached: the `history` of the rays that leave it.

    A ray shorter than its rounding errors has reached the place of its own origin.
    """
    approach, before = vector(row.history.approach), vector(row.history.before)
    if row.t > PLANE_ERROR * rounding_scale(row):
        approach, before = scale(row.t, vector(row.direction)), approach
    store(way.approach, approach)
    store(way.before, before)

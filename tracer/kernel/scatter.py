"""The rays that a hit sends out: a reflected one, a refracted one, both or none, each with its factor.

In Whitted's model every surface reflects kr and transmits kt. In Fresnel's model, transparent surfaces divide kr + kt
between the two according to the angle. On total internal reflection one ray gets kr + kt. Where the indices are
equal, nothing is reflected.
"""

import math
from typing import NamedTuple

from tracer.choices import WHITTED
from tracer.compile.jit import compiled, inlined
from tracer.formulas.optics import cosine, shares
from tracer.formulas.vector import Vector, max_component, multiply, store, vector
from tracer.kernel.arrays import Arrays, MaterialRow
from tracer.kernel.limits import Limits
from tracer.kernel.node_rows import rounding_scale, start_row, write_way
from tracer.kernel.nodes import DEPTH, INVALID, NODES, NONE, REFLECTION, REFRACTION, SURFACE, TIR, WEIGHT, NodeRow
from tracer.kernel.workspace import Space


class Scattered(NamedTuple):
    """The rays that a hit sends out. A factor of 0 means no ray."""

    kind: int  # of the reflected ray: REFLECTION or TIR
    reflected: float  # factor of the reflected ray
    refracted: float  # factor of the refracted ray
    mirror: Vector  # direction of the reflected ray
    through: Vector  # direction of the refracted ray


@inlined
def scatter(world: Arrays, limits: Limits, row: NodeRow) -> Scattered:
    """The rays that the hit of a row sends out."""
    material = world.materials[world.objects[row.object].material]
    kr, kt = material.reflect, material.transmit
    d = vector(row.direction)
    mirror = world.formulas.mirrored(d, vector(row.normal))
    if kt == 0.0:
        return Scattered(REFLECTION, kr, 0.0, mirror, d)
    thin = world.objects[row.object].sheet
    if row.n1 == row.n2 and not thin:
        return Scattered(REFLECTION, 0.0, kt if limits.model == WHITTED else kr + kt, mirror, d)
    if row.radicand <= 0.0 and not thin:
        return Scattered(TIR, kr + kt, 0.0, mirror, d)
    reflected, refracted, through = dielectric_shares(world, limits, row, material, thin)
    return Scattered(REFLECTION, reflected, refracted, mirror, through)


@inlined
def dielectric_shares(
    world: Arrays, limits: Limits, row: NodeRow, material: MaterialRow, thin: bool
) -> tuple[float, float, Vector]:
    """(factor of the reflected ray, of the refracted ray, its direction) at a transparent surface.

    A thin sheet sends the refracted ray straight on, and reflects like one surface of its material.
    """
    d, n = vector(row.direction), vector(row.normal)
    kr, kt, n2 = material.reflect, material.transmit, material.ior if thin else row.n2
    c1 = cosine(d, n)
    through = d if thin else world.formulas.transmission(d, n, row.n1, n2, c1, math.sqrt(row.radicand))
    if limits.model == WHITTED:
        return (kr, kt, through)
    r, t = shares(c1, world.formulas.sine(d, n), row.n1, n2)
    return ((kr + kt) * r, (kr + kt) * t, through)


@inlined
def append_children(world: Arrays, limits: Limits, space: Space, i: int, count: int, planned: int) -> tuple[int, int]:
    """Append the rays that row i sends out. Returns the new (rows, planned rows).

    A ray that is cut gets no row; row i's `end` says why.
    """
    row = space.table[i]
    if row.surface < 0:
        return (count, planned)
    rays = scatter(world, limits, row)
    if rays.reflected == 0.0 and rays.refracted == 0.0:
        row.end = SURFACE
    if rays.reflected > 0.0:
        count, planned = append_child(world, limits, space, i, rays, False, count, planned)
    if rays.refracted > 0.0:
        count, planned = append_child(world, limits, space, i, rays, True, count, planned)
    return (count, planned)


@compiled
def append_child(
    world: Arrays, limits: Limits, space: Space, i: int, rays: Scattered, refracted: bool, count: int, planned: int
) -> tuple[int, int]:
    """Append one of the rays that row i sends out, or cut it. Returns the new (rows, planned rows)."""
    parent = space.table[i]
    heaviest = max_component(vector(parent.weight)) * (rays.refracted if refracted else rays.reflected)
    rows = 1 + len(world.lights)
    reason = cut_reason(limits, parent, rays, refracted, heaviest)
    if reason == NONE and planned + rows > limits.max_nodes:
        reason = NODES
    if reason != NONE:
        parent.end = reason
        parent.cut += heaviest
        if reason == NODES:
            space.tree[2] = 1.0
        return (count, planned)
    start_child(world, limits, space, i, rays, refracted, count)
    return (count + 1, planned + rows)


@inlined
def cut_reason(limits: Limits, parent: NodeRow, rays: Scattered, refracted: bool, heaviest: float) -> int:
    """The reason to cut a ray that does not depend on other rays; NONE if it may be followed."""
    direction = rays.through if refracted else rays.mirror
    if not math.isfinite(direction[0] + direction[1] + direction[2]):
        return INVALID
    if parent.depth >= limits.depth:
        return DEPTH
    if heaviest < limits.min_weight or heaviest == 0.0:
        return WEIGHT
    return NONE


@inlined
def start_child(
    world: Arrays, limits: Limits, space: Space, i: int, rays: Scattered, refracted: bool, count: int
) -> None:
    """Write row `count`, one of the rays that row i sends out, as it is before it is traced."""
    table, solids = space.table, space.solids
    parent = table[i]
    k = rays.refracted if refracted else rays.reflected
    factor = (k, k, k)
    kind = REFRACTION if refracted else rays.kind
    row = start_row(limits, table, count, i, kind, parent.depth + 1, factor, multiply(vector(parent.weight), factor))
    store(row.origin, vector(parent.point))
    store(row.direction, rays.through if refracted else rays.mirror)
    row.start = world.surfaces[parent.surface].coincident
    row.side = -parent.hit_side if refracted else parent.hit_side
    row.magnitude = rounding_scale(parent)
    write_way(parent, row.history)
    own = 1 if refracted else 0
    for k_word in range(solids.shape[2]):
        solids[count, 0, k_word] = solids[i, own, k_word]
        solids[count, 1, k_word] = solids[i, own, k_word]
    if parent.child < 0:
        parent.child = count
    else:
        table[parent.child].sibling = count

"""What a hit sends out: a reflected ray, a refracted one, both or none, each with its weight.

Whitted gives every surface fixed weights, kr and kt. By Fresnel's law transparent surfaces share kt between the two by
the angle. On total internal reflection one ray gets both weights; where the indices are equal, nothing is reflected.
"""

import math
from typing import Any, NamedTuple

from tracer.compile.jit import compiled, inlined
from tracer.formulas.optics import cosine, fresnel_shares, mirrored, radicand, sine, transmission
from tracer.formulas.vector import Vector, max_component, multiply, store, vector
from tracer.kernel.limits import WHITTED, Limits
from tracer.kernel.node_rows import rounding_scale, start_row
from tracer.kernel.nodes import DEPTH, INVALID, NODES, NONE, REFLECTION, REFRACTION, SURFACE, TIR, WEIGHT


class Scattered(NamedTuple):
    """The rays that a hit sends out; a factor of 0 stands for none."""

    kind: int  # of the reflected ray: total internal reflection is one, too
    reflected: float  # its factor
    refracted: float  # the refracted ray's
    through: Vector  # the refracted ray's direction


@inlined
def scatter(world: Any, limits: Limits, row: Any) -> Scattered:
    """What becomes of a ray at its hit."""
    material = world.materials[world.objects[row.object].material]
    kr, kt = material.reflect, material.transmit
    d = vector(row.direction)
    if kt == 0.0:
        return Scattered(REFLECTION, kr, 0.0, d)
    thin = world.objects[row.object].solid < 0
    if row.n1 == row.n2 and not thin:
        return Scattered(REFLECTION, 0.0, kt, d)
    if row.radicand <= 0.0 and not thin:
        return Scattered(TIR, kr + kt, 0.0, d)
    reflected, refracted, through = dielectric_shares(limits, row, material, thin)
    return Scattered(REFLECTION, reflected, refracted, through)


@inlined
def append_children(world: Any, limits: Limits, space: Any, i: int, count: int, planned: int) -> tuple[int, int]:
    """(rows, rows planned) after the rays that row i sends out: each a row, or in row i's `end` why it is cut."""
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


@inlined
def dielectric_shares(limits: Limits, row: Any, material: Any, thin: bool) -> tuple[float, float, Vector]:
    """(weight of the reflected ray, of the refracted ray, its direction) where a transparent surface splits the ray.

    A thin sheet sends it straight on, and reflects as a single surface of its material does.
    """
    d, n = vector(row.direction), vector(row.normal)
    kr, kt, n2 = material.reflect, material.transmit, material.ior if thin else row.n2
    c1 = cosine(d, n)
    through = d if thin else transmission(d, n, row.n1, n2, c1, math.sqrt(row.radicand))
    if limits.model == WHITTED:
        return (kr, kt, through)
    s1 = sine(d, n)
    root = radicand(s1, row.n1, n2)
    if root <= 0.0:
        return (kr + kt, 0.0, through)
    r, t = fresnel_shares(c1, s1, math.sqrt(root), row.n1, n2)
    return (kr + kt * r, kt * t, through)


@compiled
def append_child(
    world: Any, limits: Limits, space: Any, i: int, rays: Scattered, refracted: bool, count: int, planned: int
) -> tuple[int, int]:
    """(rows, rows planned): one of the rays that row i sends out, or in its `end` and `cut` that it is not followed."""
    parent = space.table[i]
    heaviest = max_component(vector(parent.weight)) * (rays.refracted if refracted else rays.reflected)
    room = 1 + len(world.lights)
    reason = cut_reason(limits, parent, rays, refracted, heaviest)
    if reason == NONE and planned + room > limits.max_nodes:
        reason = NODES
    if reason != NONE:
        parent.end = reason
        parent.cut += heaviest
        return (count, planned)
    start_child(world, limits, space, i, rays, refracted, count)
    return (count + 1, planned + room)


@inlined
def cut_reason(limits: Limits, parent: Any, rays: Scattered, refracted: bool, heaviest: float) -> int:
    """Why a ray is not followed, whatever else is: its end; -1 where it may be."""
    through = rays.through
    if refracted and not math.isfinite(through[0] + through[1] + through[2]):
        return INVALID
    if parent.depth >= limits.depth:
        return DEPTH
    if heaviest < limits.min_weight or heaviest == 0.0:
        return WEIGHT
    return NONE


@inlined
def start_child(world: Any, limits: Limits, space: Any, i: int, rays: Scattered, refracted: bool, count: int) -> None:
    """Row `count`: one of the rays that row i sends out, as it is before it is traced."""
    table, solids = space.table, space.solids
    parent = table[i]
    d, n = vector(parent.direction), vector(parent.normal)
    k = rays.refracted if refracted else rays.reflected
    factor = (k, k, k)
    kind = REFRACTION if refracted else rays.kind
    row = start_row(limits, table, count, i, kind, parent.depth + 1, factor, multiply(vector(parent.weight), factor))
    store(row.origin, vector(parent.point))
    store(row.direction, rays.through if refracted else mirrored(d, n))
    row.start = world.surfaces[parent.surface].coincident
    row.side = -parent.hit_side if refracted else parent.hit_side
    row.reach = rounding_scale(parent)
    own = 1 if refracted else 0
    for k_word in range(solids.shape[2]):
        solids[count, 0, k_word] = solids[i, own, k_word]
        solids[count, 1, k_word] = solids[i, own, k_word]
    if parent.child < 0:
        parent.child = count
    else:
        table[parent.child].sibling = count

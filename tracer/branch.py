"""What a hit sends out: a reflected ray, a refracted one, both or none, each with its weight.

Whitted gives every surface fixed weights, kr and kt. By Fresnel's law transparent surfaces share kt between the two by
the angle. On total internal reflection one ray gets both weights; where the indices are equal, nothing is reflected.
"""

import math
from typing import Any

from tracer.jit import compiled, routine
from tracer.limits import WHITTED, Limits
from tracer.nodes import DEPTH, INVALID, NODES, REFLECTION, REFRACTION, SURFACE, TIR, WEIGHT
from tracer.optics import cosine, fresnel_shares, mirrored, radicand, sine, transmission
from tracer.rows import start_row, way_length
from tracer.vector import Vector, largest, multiply, store, vector


@compiled
def spawn(world: Any, limits: Limits, space: Any, i: int, count: int, planned: int) -> tuple[int, int, float]:
    """(rows, rows planned, weight cut) after the reflected and the refracted ray of row i, where it sends them."""
    row = space.table[i]
    if row.surface < 0:
        return (count, planned, 0.0)
    material = world.materials[world.objects[row.object].material]
    kr, kt = material.reflect, material.transmit
    d, n = vector(row.direction), vector(row.normal)
    reflected, refracted, kind = kr, 0.0, REFLECTION
    through = d
    if kt > 0.0:
        thin = world.objects[row.object].solid < 0
        if row.n1 == row.n2 and not thin:
            reflected, refracted = 0.0, kt
        elif row.radicand <= 0.0 and not thin:
            reflected, kind = kr + kt, TIR
        else:
            reflected, refracted, through = bend(limits, row, material, thin)
    if reflected == 0.0 and refracted == 0.0:
        row.end = SURFACE
        return (count, planned, 0.0)
    row.first_child = count
    cut = 0.0
    if reflected > 0.0:
        count, planned, lost = send(
            world, limits, space, i, count, planned, kind, mirrored(d, n), reflected, row.hit_side
        )
        cut += lost
    if refracted > 0.0:
        count, planned, lost = send(
            world, limits, space, i, count, planned, REFRACTION, through, refracted, -row.hit_side
        )
        cut += lost
    row.children = count - row.first_child
    return (count, planned, cut)


@compiled
def bend(limits: Limits, row: Any, material: Any, thin: bool) -> tuple[float, float, Vector]:
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


@routine
def send(
    world: Any,
    limits: Limits,
    space: Any,
    i: int,
    count: int,
    planned: int,
    kind: int,
    direction: Vector,
    k: float,
    side: float,
) -> tuple[int, int, float]:
    """(rows, rows planned, weight cut): one child of row i, or in its end the reason why that is not followed."""
    table, solids = space.table, space.solids
    parent = table[i]
    factor = (k, k, k)
    weight = multiply(vector(parent.weight), factor)
    heaviest = largest(weight)
    room = 1 + len(world.lights)
    if not math.isfinite(direction[0] + direction[1] + direction[2]):
        parent.end = INVALID
    elif parent.depth >= limits.depth:
        parent.end = DEPTH
    elif heaviest < limits.min_weight:
        parent.end = WEIGHT
    elif planned + room > limits.max_nodes:
        parent.end = NODES
    else:
        row = start_row(limits, table, count, i, kind, parent.depth + 1, factor, weight)
        store(row.origin, vector(parent.point))
        store(row.direction, direction)
        row.start = parent.surface
        row.side = side
        row.reach = way_length(parent)
        own = 1 if kind == REFRACTION else 0
        for k_word in range(solids.shape[2]):
            solids[count, 0, k_word] = solids[i, own, k_word]
            solids[count, 1, k_word] = solids[i, own, k_word]
        return (count + 1, planned + room, 0.0)
    return (count, planned, heaviest)

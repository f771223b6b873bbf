"""One pixel's tree of rays into a node table: what an image is made of and what a click shows.

Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980. The table itself is the queue: a level's
rays are traced in their order, their shadow rays follow, then the rays they send out, and so on down to the last depth.
The sums then run back up. An image keeps the first row's radiance of every table, a click keeps the table.
"""

import math
from typing import Any

from tracer.compile.intrinsics import noinline
from tracer.compile.jit import compiled, inlined
from tracer.formulas.media import index_of, medium
from tracer.formulas.optics import cosine, mirrored, radicand, sine, transmission
from tracer.formulas.shading import ambient, phong, surface_color
from tracer.formulas.vector import Vector, add, dot, multiply, scale, store, vector
from tracer.kernel.interface import next_interface
from tracer.kernel.limits import Limits
from tracer.kernel.node_rows import record_shadow, record_unlit, rounding_scale
from tracer.kernel.nodes import BACKGROUND, SHADOW
from tracer.kernel.scatter import append_children
from tracer.kernel.shadows import light_direction, transmittance
from tracer.rays import make_ray
from tracer.shapes import interaction


@inlined
def trace_tree(world: Any, limits: Limits, space: Any) -> int:
    """Rows of the tree whose camera ray stands in row 0; -1 where the table is too short for it.

    `space.solids` has for each row the set of solids before and behind its hit; row 0's is given too.
    """
    table = space.table
    lights = len(world.lights)
    first, end = 0, 1
    planned = 1 + lights  # rows spoken for: a ray comes with room for its shadow rays
    while first < end:
        if end + (end - first) * (lights + 2) > len(table):
            return -1
        for i in range(first, end):
            trace_ray(world, space, i)
        count = end
        for i in range(first, end):
            count = direct_light(world, limits, space, i, count)
        next_first = count
        for i in range(first, end):
            count, planned = append_children(world, limits, space, i, count, planned)
        if end == first + 1 and not limits.records and is_pass_through(table, first):
            count = replace_by_child(space, first, count)
            next_first = first
        first, end = next_first, count
    accumulate_radiance(table, end)
    return end


@inlined
def is_pass_through(table: Any, i: int) -> bool:
    """Whether a ray adds nothing to what its only child brings, and takes nothing from it."""
    row = table[i]
    if row.child < 0 or row.cut > 0.0 or table[row.child].sibling >= 0:
        return False
    dark = row.local[0] == 0.0 and row.local[1] == 0.0 and row.local[2] == 0.0
    return dark and table[row.child].factor[0] == 1.0


@compiled
def replace_by_child(space: Any, i: int, count: int) -> int:
    """Put row i's only child, the last row, in its place: a million mirrors in a row take no more room than one.

    The rows it takes with it are counted here. The number of rows that are left.
    """
    noinline()
    table, solids = space.table, space.solids
    for k in range(i, count - 1):
        space.rays[table[k].kind] += 1
    row, child = table[i], table[count - 1]
    child.sibling = row.sibling
    store(child.factor, vector(row.factor))
    table[i] = child
    for word in range(solids.shape[2]):
        solids[i, 0, word] = solids[count - 1, 0, word]
        solids[i, 1, word] = solids[count - 1, 1, word]
    return i + 1


@compiled
def trace_ray(world: Any, space: Any, i: int) -> None:
    """Find what ray i meets and write it into its row."""
    row = space.table[i]
    solids = space.solids
    d = vector(row.direction)
    ray = make_ray(vector(row.origin), d, row.start, row.side, row.reach)
    t, s = next_interface(world, ray, solids[i], space)
    n1 = index_of(world, medium(solids[i, 0]))
    row.n1 = n1
    if s < 0:
        row.end = BACKGROUND
        store(row.local, vector(world.background))
        return
    point, n, shading_n = interaction(world, world.surfaces[s], ray, t)
    side = 1.0 if dot(n, d) < 0.0 else -1.0
    n, shading_n = scale(side, n), scale(side, shading_n)
    row.t = t
    row.surface = s
    row.object = world.surfaces[s].object
    row.hit_side = side
    store(row.point, point)
    this = world.objects[row.object]
    material = world.materials[this.material]
    if material.transmit > 0.0:
        if this.solid >= 0:
            row.n2 = index_of(world, medium(solids[i, 1]))
        else:
            row.n2 = n1
        if shading_n != n and not is_usable(d, n, shading_n, n1, row.n2):
            shading_n = n
        row.radicand = radicand(sine(d, shading_n), n1, row.n2)
    elif shading_n != n and dot(mirrored(d, shading_n), n) <= 0.0:
        shading_n = n
    store(row.face, n)
    store(row.normal, shading_n)


@compiled
def is_usable(d: Vector, n: Vector, shading_n: Vector, n1: float, n2: float) -> bool:
    """Whether an interpolated normal sends the reflected ray to the front of the face and the refracted one behind."""
    if dot(d, shading_n) >= 0.0 or dot(mirrored(d, shading_n), n) <= 0.0:
        return False
    root = radicand(sine(d, shading_n), n1, n2)
    if root <= 0.0:
        return True
    return dot(transmission(d, shading_n, n1, n2, cosine(d, shading_n), math.sqrt(root)), n) < 0.0


@compiled
def direct_light(world: Any, limits: Limits, space: Any, i: int, count: int) -> int:
    """Row i's local term, light by light; the number of rows after its shadow rays, which only a reader has use for.

    What cannot add to the local term is followed only for the reader, too.
    """
    table = space.table
    row = table[i]
    if row.surface < 0:
        return count
    s = row.surface
    this = world.objects[row.object]
    material = world.materials[this.material]
    point, n, d = vector(row.point), vector(row.normal), vector(row.direction)
    color = surface_color(material, this, point)
    local = ambient(material, color, vector(world.ambient))
    shines = material.diffuse > 0.0 or material.specular > 0.0
    if shines or limits.records:
        face_n = vector(row.face)
        for j in range(len(world.lights)):
            light = world.lights[j]
            to_light, far = light_direction(light, point)
            if shines and dot(n, to_light) > 0.0 and dot(face_n, to_light) > 0.0:
                ray = make_ray(point, to_light, world.surfaces[s].coincident, row.hit_side, rounding_scale(row))
                visible, glass = transmittance(world, ray, far, limits.glass_blocks, space)
                share = (0.0, 0.0, 0.0)
                if visible > 0.0:
                    share = scale(visible, phong(material, color, vector(light.color), n, to_light, d))
                    local = add(local, share)
                if limits.records:
                    record_shadow(world, limits, space, count, i, j, ray, far, visible, glass, share)
                    count += 1
                else:
                    space.rays[SHADOW] += 1
            elif limits.records:
                record_unlit(world, limits, space, count, i, j, to_light, far)
                count += 1
    store(row.local, local)
    return count


@inlined
def accumulate_radiance(table: Any, count: int) -> None:
    """Colour flows back: radiance = local + sum of factor * radiance over the children, in row order."""
    for i in range(count - 1, -1, -1):
        row = table[i]
        if row.kind != SHADOW:
            total = vector(row.local)
            k = row.child
            while k >= 0:
                total = add(total, multiply(vector(table[k].factor), vector(table[k].radiance)))
                k = table[k].sibling
            store(row.radiance, total)

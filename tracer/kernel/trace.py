"""Traces one pixel's ray tree breadth-first into the node table, for images and for clicks.

Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980. `tracer/whitted.py` is the same
algorithm as a plain recursion. Here the table itself is the queue: the rays of a level are traced, their shadow rays
follow, then the rays that they send out, down to the last depth. Then the radiances are summed upwards. An image
keeps the radiance of the first row, a click keeps the table.
"""

import math

from tracer.compile.intrinsics import noinline, reference
from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Rows
from tracer.formulas.media import index_of, medium
from tracer.formulas.optics import cosine, radicand
from tracer.formulas.shading import ambient, phong, surface_color
from tracer.formulas.vector import Vector, add, dot, multiply, scale, store, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.coincident_surfaces import next_interface
from tracer.kernel.limits import Limits
from tracer.kernel.node_rows import record_shadow, record_unlit, rounding_scale, write_way
from tracer.kernel.nodes import BACKGROUND, SHADOW, NodeRow
from tracer.kernel.scatter import append_children
from tracer.kernel.shadows import light_direction, transmittance
from tracer.kernel.workspace import Space
from tracer.rays import make_ray


@inlined
def trace_tree(world: Arrays, limits: Limits, space: Space) -> int:
    """Trace the tree whose camera ray is row 0. Returns its number of rows, -1 if the table is too short for it."""
    table = space.table
    lights = len(world.lights)
    first, end = 0, 1
    planned = 1 + lights  # a planned ray includes its shadow rays
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
def is_pass_through(table: Rows[NodeRow], i: int) -> bool:
    """Whether the radiance of row i equals that of its only child."""
    row = table[i]
    if row.child < 0 or row.cut > 0.0 or table[row.child].sibling >= 0:
        return False
    dark = row.local[0] == 0.0 and row.local[1] == 0.0 and row.local[2] == 0.0
    return dark and table[row.child].factor[0] == 1.0


@compiled
def replace_by_child(space: Space, i: int, count: int) -> int:
    """Replace row i by its only child, the last row, so that a million mirrors in a row need no more memory than one.

    Counts the rays of the removed rows. Returns the number of rows left.
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
def trace_ray(world: Arrays, space: Space, i: int) -> None:
    """Find what ray i hits, and write it into its row."""
    row = space.table[i]
    solids = space.solids
    d = vector(row.direction)
    ray = make_ray(vector(row.origin), d, row.start, row.side, row.magnitude, reference(row.history), True)
    t, s = 0.0, row.surface  # an opaque one that the eye lies on
    if s < 0:
        t, s = next_interface(world, ray, solids[i], space)
    n1 = index_of(world, medium(solids[i, 0]))
    row.n1 = n1
    if s < 0:
        row.end = BACKGROUND
        store(row.local, vector(world.background))
        return
    point, n, shading_n = world.formulas.interaction(world, world.surfaces[s], ray, t)
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
        row.n2 = n1 if this.sheet else index_of(world, medium(solids[i, 1]))
        if shading_n != n and not is_usable(world, d, n, shading_n, n1, row.n2):
            shading_n = n
        row.radicand = radicand(world.formulas.sine(d, shading_n), n1, row.n2)
    elif shading_n != n and not dot(world.formulas.mirrored(d, shading_n), n) > 0.0:
        shading_n = n
    store(row.face_normal, n)
    store(row.normal, shading_n)


@compiled
def is_usable(world: Arrays, d: Vector, n: Vector, shading_n: Vector, n1: float, n2: float) -> bool:
    """Whether an interpolated normal sends the reflected ray to the front of the face, and the refracted one behind."""
    if dot(d, shading_n) >= 0.0 or dot(world.formulas.mirrored(d, shading_n), n) <= 0.0:
        return False
    root = radicand(world.formulas.sine(d, shading_n), n1, n2)
    if root <= 0.0:
        return True
    return dot(world.formulas.transmission(d, shading_n, n1, n2, cosine(d, shading_n), math.sqrt(root)), n) < 0.0


@compiled
def direct_light(world: Arrays, limits: Limits, space: Space, i: int, count: int) -> int:
    """Compute the local term of row i, light by light. Returns the number of rows, with its shadow rays if recorded.

    A shadow ray that cannot add to the local term is traced only if it is recorded.
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
    is_lit = material.diffuse > 0.0 or material.specular > 0.0
    if is_lit or limits.records:
        face_n = vector(row.face_normal)
        write_way(row, space.way[0])
        start, size = world.surfaces[s].coincident, rounding_scale(row)
        for j in range(len(world.lights)):
            light = world.lights[j]
            to_light, distance = light_direction(light, point)
            if is_lit and dot(n, to_light) > 0.0 and dot(face_n, to_light) > 0.0:
                ray = make_ray(point, to_light, start, row.hit_side, size, reference(space.way[0]))
                visible, glass = transmittance(world, ray, distance, limits.glass_blocks, i, False, space)
                share = (0.0, 0.0, 0.0)
                if visible > 0.0:
                    share = scale(visible, phong(material, color, vector(light.color), n, to_light, d))
                    local = add(local, share)
                if limits.records:
                    record_shadow(world, limits, space, count, i, j, ray, distance, visible, glass, False, share)
                    count += 1
                else:
                    space.rays[SHADOW] += 1
            elif limits.records:
                record_unlit(world, limits, space, count, i, j, to_light, distance)
                count += 1
    store(row.local, local)
    return count


@inlined
def accumulate_radiance(table: Rows[NodeRow], count: int) -> None:
    """Sum up the tree: radiance = local + sum of factor * radiance over the children, in row order."""
    for i in range(count - 1, -1, -1):
        row = table[i]
        if row.kind != SHADOW:
            total = vector(row.local)
            k = row.child
            while k >= 0:
                total = add(total, multiply(vector(table[k].factor), vector(table[k].radiance)))
                k = table[k].sibling
            store(row.radiance, total)

"""One pixel's tree of rays into a node table: what an image is made of and what a click shows.

Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980. The table itself is the queue: a level's
rays are traced in their order, their shadow rays follow, then the rays they send out, and so on down to the last depth.
The sums then run back up. An image keeps the first row's radiance of every table, a click keeps the table.
"""

import math
from typing import Any, NamedTuple

from tracer.interface import meet_interface
from tracer.jit import compiled, routine
from tracer.media import index_of, medium
from tracer.nodes import (
    BACKGROUND,
    BLOCKED,
    DEPTH,
    FILTERED,
    INVALID,
    LIT,
    NODES,
    NONE,
    REFLECTION,
    REFRACTION,
    SHADOW,
    SURFACE,
    TIR,
    WEIGHT,
)
from tracer.optics import cosine, fresnel_shares, radicand, reflect, sine, transmission
from tracer.rays import Ray, make_ray
from tracer.shading import ambient, phong, surface_color
from tracer.shadows import light_through, occluder, towards_light
from tracer.shapes import locate
from tracer.vector import Vector, add, dot, largest, multiply, scale, store, vector

WHITTED, FRESNEL = range(2)
MODELS = ("whitted", "fresnel")


class Limits(NamedTuple):
    """How far a tree goes, and what its edges weigh."""

    depth: int
    min_weight: float  # a ray whose largest weight is below is cut
    max_nodes: int  # rows a tree may have
    model: int
    glass_blocks: bool  # shadow rays: glass casts a full shadow instead of filtering the light
    records: bool  # the table will be read (a click): fill in what an image has no use for


@compiled
def trace_tree(world: Any, limits: Limits, space: Any) -> tuple[int, float]:
    """(rows, residual) of the tree whose camera ray stands in row 0; (-1, 0) where the table is too short for it.

    `space.solids` has for each row the set of solids before and behind its hit; row 0's is given too.
    """
    table = space.table
    lights = len(world.lights)
    first, end, depth = 0, 1, 0
    residual = 0.0
    planned = 1 + lights  # rows spoken for: a ray comes with room for its shadow rays
    while first < end:
        if end + (end - first) * (lights + 2) > len(table):
            return (-1, 0.0)
        for i in range(first, end):
            trace_ray(world, space, i)
        count = end
        for i in range(first, end):
            count = gather_light(world, limits, space, i, count)
        next_first = count
        for i in range(first, end):
            count, planned, cut = spawn(world, limits, space, i, count, planned)
            residual += cut
        first, end, depth = next_first, count, depth + 1
    sum_up(space, end)
    return (end, residual)


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


@compiled
def trace_ray(world: Any, space: Any, i: int) -> None:
    """Find what ray i meets and write it into its row."""
    row = space.table[i]
    solids = space.solids
    d = vector(row.direction)
    ray = make_ray(vector(row.origin), d, row.start, row.side, row.reach)
    t, s = meet_interface(world, ray, solids[i], space.stack)
    n1 = index_of(world, medium(solids[i, 0]))
    row.n1 = n1
    if s < 0:
        row.end = BACKGROUND
        store(row.local, vector(world.background))
        return
    point, n, shading_n = locate(world, world.surfaces[s], ray, t)
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
    elif shading_n != n and dot(reflect(d, shading_n), n) <= 0.0:
        shading_n = n
    store(row.face, n)
    store(row.normal, shading_n)


@routine
def is_usable(d: Vector, n: Vector, shading_n: Vector, n1: float, n2: float) -> bool:
    """Whether an interpolated normal sends the reflected ray to the front of the face and the refracted one behind."""
    if dot(d, shading_n) >= 0.0 or dot(reflect(d, shading_n), n) <= 0.0:
        return False
    root = radicand(sine(d, shading_n), n1, n2)
    if root <= 0.0:
        return True
    return dot(transmission(d, shading_n, n1, n2, cosine(d, shading_n), math.sqrt(root)), n) < 0.0


@compiled
def gather_light(world: Any, limits: Limits, space: Any, i: int, count: int) -> int:
    """Row i's local term, light by light, with one shadow row for each light in front of its surface."""
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
    if material.diffuse > 0.0 or material.specular > 0.0:
        face_n = vector(row.face)
        for j in range(len(world.lights)):
            light = world.lights[j]
            to_light, far = towards_light(light, point)
            if dot(n, to_light) > 0.0 and dot(face_n, to_light) > 0.0:
                ray = make_ray(point, to_light, s, row.hit_side, way_length(row))
                visible, glass = light_through(world, ray, far, limits.glass_blocks, space)
                share = (0.0, 0.0, 0.0)
                if visible > 0.0:
                    share = scale(visible, phong(material, color, vector(light.color), n, to_light, d))
                    local = add(local, share)
                table[count].kind = SHADOW
                if limits.records:
                    record_shadow(world, limits, space, count, i, j, ray, far, visible, glass, share)
                count += 1
    store(row.local, local)
    return count


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
            world, limits, space, i, count, planned, kind, reflect(d, n), reflected, row.hit_side
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
    c1, s1 = cosine(d, n), sine(d, n)
    root = radicand(s1, row.n1, n2)
    c2 = math.sqrt(max(root, 0.0))
    through = d if thin else transmission(d, n, row.n1, n2, c1, c2)
    if limits.model == WHITTED:
        return (kr, kt, through)
    if root <= 0.0:
        return (kr + kt, 0.0, through)
    r, t = fresnel_shares(c1, s1, c2, row.n1, n2)
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


@compiled
def way_length(row: Any) -> float:
    """How large the numbers are that a hit was computed from: its rounding errors are small beside this.

    What the ray's own start was computed from counts too: a ray in a corner meets the next wall where it starts.
    """
    return max(row.reach, abs(row.origin[0]) + abs(row.origin[1]) + abs(row.origin[2]) + row.t)


@compiled
def sum_up(space: Any, count: int) -> None:
    """Colour flows back: radiance = local + sum of factor * radiance over the children, in row order."""
    table = space.table
    for i in range(count - 1, -1, -1):
        row = table[i]
        if row.kind != SHADOW:
            total = vector(row.local)
            for k in range(row.first_child, row.first_child + row.children):
                total = add(total, multiply(vector(table[k].factor), vector(table[k].radiance)))
            store(row.radiance, total)

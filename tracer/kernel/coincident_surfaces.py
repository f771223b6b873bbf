"""Interfaces: what a ray meets at one distance, and which media lie before and behind it.

All surfaces at bitwise equal t are one interface. If one of them is opaque, the ray ends there. Otherwise the ray
crosses them all, and its set of solids changes (`tracer.formulas.media`). Where the medium changes, the surface of
the solid of higher priority is visible. Where it does not, the surfaces are hidden: they add no row and no depth,
and are not shaded. A thin sheet bounds no medium and is always shown.
"""

from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Numbers
from tracer.formulas.media import contains, medium, set_inside
from tracer.formulas.vector import dot, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.closest_hit import closest, closest_within, transmit
from tracer.kernel.workspace import Space
from tracer.rays import Ray
from tracer.shapes.outline import PLANE_ERROR, side_of


@inlined
def next_interface(world: Arrays, ray: Ray, solids: Numbers, space: Space) -> tuple[float, int]:
    """(t, surface) of the first interface that is shown; surface -1 for none.

    `solids` (2, words) are the sets of solids just before that interface and just behind it. Hidden surfaces on the way
    change both.
    """
    before, behind = solids[0], solids[1]
    t, s, tied = closest(world, ray, 0.0, -1, space)
    while s >= 0:
        if not tied and transmit(world, s) == 0.0:
            return (t, s)
        shown, last_t, last = cross_surfaces(world, ray, t, s, tied, before, behind, space)
        if shown >= 0:
            return (t, shown)
        for k in range(len(before)):
            before[k] = behind[k]
        t, s, tied = closest(world, ray, last_t, last, space)
    return (t, s)


@compiled
def cross_surfaces(
    world: Arrays, ray: Ray, t: float, s: int, tied: bool, before: Numbers, behind: Numbers, space: Space
) -> tuple[int, float, int]:
    """Cross all surfaces at t, solid by solid. Returns (surface shown or -1, t and id of the last surface crossed).

    Faces of one mesh whose distances rounding cannot tell apart belong to the same crossing. Entering twice, at the
    edge between two faces, counts once. A ray that enters and leaves, at an edge on the silhouette, is outside behind a
    convex edge and inside behind a concave one.
    """
    opaque, sheet = -1, -1
    solid, enters, leaves = -1, -1, -1
    first, last_t, last = s, t, s
    here = t
    while s >= 0:
        this = world.surfaces[s].solid
        same_crossing = this >= 0 and this == solid
        if here != t and not same_crossing:
            break
        last_t, last = here, s
        if transmit(world, s) == 0.0:
            opaque = s if opaque < 0 else opaque
        elif this < 0:
            sheet = s if sheet < 0 else sheet
        else:
            if this != solid:
                if solid >= 0:
                    change_medium(world, solid, enters, leaves, before, behind)
                solid, enters, leaves = this, -1, -1
            if is_entering(world, s, ray, here):
                enters = s
            else:
                leaves = s
        # Surfaces farther away belong to this crossing only if rounding may have put them there.
        limit = t + (distance_uncertainty(world, last, ray) if solid >= 0 else 0.0)
        if not tied and limit == t:
            break
        here, s, _ = closest_within(world, ray, last_t, last, limit, space)
    if opaque >= 0:
        return (opaque, last_t, last)
    if solid >= 0:
        change_medium(world, solid, enters, leaves, before, behind)
    old, new = medium(before), medium(behind)
    if old == new:
        return (sheet, last_t, last)
    if last == first and last_t == t:  # the only surface crossed has changed the medium
        return (first, last_t, last)
    seen = max(old, new) if min(old, new) < 0 else min(old, new)
    shown, here = first, t
    while world.surfaces[shown].solid != seen or is_entering(world, shown, ray, here) != contains(behind, seen):
        here, shown, _ = closest(world, ray, here, shown, space)
    return (shown, last_t, last)


@inlined
def is_entering(world: Arrays, s: int, ray: Ray, t: float) -> bool:
    """Whether the ray enters the solid of surface s at distance t."""
    _, n, _ = world.formulas.interaction(world, world.surfaces[s], ray, t)
    return dot(n, ray.direction) < 0.0


@inlined
def distance_uncertainty(world: Arrays, s: int, ray: Ray) -> float:
    """Bound on the difference that rounding makes between the distances to two faces of a mesh that meet at the hit; 0
    for other shapes.
    """
    surface = world.surfaces[s]
    if surface.count != 3:
        return 0.0
    return 2.0 * PLANE_ERROR * (surface.r + ray.magnitude) / abs(dot(vector(surface.normal), ray.direction))


@inlined
def change_medium(world: Arrays, solid: int, enters: int, leaves: int, before: Numbers, behind: Numbers) -> None:
    """Add a solid to the set behind the surface, or remove it. `enters` and `leaves` are surfaces at which the ray
    enters and leaves it, -1 for none.

    If an open solid is left without having been entered, the ray must have been inside all along: then it is added to
    the set before the surface.
    """
    if enters >= 0 and leaves >= 0:
        side = side_of(world, world.surfaces[leaves], world.surfaces[enters])
        if side == 1 or side == -1:  # before the first face: a concave edge
            set_inside(behind, solid, side == 1)
        return
    if leaves >= 0 and not world.closed[solid] and not contains(before, solid):
        set_inside(before, solid, True)
    set_inside(behind, solid, enters >= 0)


@inlined
def is_concave(world: Arrays, enters: int, leaves: int) -> bool:
    """Whether the edge at which a ray enters a face and leaves another is concave: the second lies before the first."""
    return side_of(world, world.surfaces[leaves], world.surfaces[enters]) == 1

"""What a ray meets at one distance: which surface is seen there, and which media lie before and behind it.

Surfaces at bitwise equal t are one interface. An opaque one among them ends it. Otherwise the ray changes its set of
solids, and the surface belongs to whichever medium outranks the other; where the medium stays the same, the surface is
hidden: no row, no depth, no shading. A thin sheet bounds no medium and is always seen.
"""

from typing import Any

from tracer.compile.jit import compiled, inlined
from tracer.formulas.media import contains, medium, set_inside
from tracer.formulas.vector import dot, vector
from tracer.kernel.closest_hit import closest, closest_within, transmit
from tracer.rays import Ray
from tracer.shapes import interaction
from tracer.shapes.planar import PLANE_ERROR


@inlined
def is_entering(world: Any, s: int, ray: Ray, t: float) -> bool:
    _, n, _ = interaction(world, world.surfaces[s], ray, t)
    return dot(n, ray.direction) < 0.0


@inlined
def next_interface(world: Any, ray: Ray, solids: Any, space: Any) -> tuple[float, int]:
    """(t, surface) of the first interface the ray shows; surface -1 for none.

    `solids`: (2, words); the set the ray is in just before that interface, and just behind it. Hidden surfaces on the
    way change both.
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
    world: Any, ray: Ray, t: float, s: int, tied: bool, before: Any, behind: Any, space: Any
) -> tuple[int, float, int]:
    """(surface shown or -1, t and surface last passed): goes through all surfaces at t, solid by solid.

    Faces of one mesh that rounding cannot tell from t belong to the same crossing. Entered twice, at the edge of two
    faces, is entered; entered and left, at the edge that one sees as its outline, is grazed: nothing changes.
    """
    opaque, sheet = -1, -1
    solid, closed, enters, leaves = -1, False, False, False
    first, last_t, last = s, t, s
    here = t
    while s >= 0:
        this = world.objects[world.surfaces[s].object]
        same_crossing = this.solid >= 0 and this.solid == solid
        if here != t and not same_crossing:
            break
        last_t, last = here, s
        if transmit(world, s) == 0.0:
            opaque = s if opaque < 0 else opaque
        elif this.solid < 0:
            sheet = s if sheet < 0 else sheet
        else:
            if this.solid != solid:
                if solid >= 0:
                    change_medium(ray, solid, closed, enters, leaves, before, behind)
                solid, closed, enters, leaves = this.solid, this.closed, False, False
            entering = is_entering(world, s, ray, here)
            enters, leaves = enters or entering, leaves or not entering
        # What lies behind matters only as far as rounding could have pulled it there.
        limit = t + (distance_uncertainty(world, last, ray) if solid >= 0 else 0.0)
        if not tied and limit == t:
            break
        here, s, _ = closest_within(world, ray, last_t, last, limit, space)
    if opaque >= 0:
        return (opaque, last_t, last)
    if solid >= 0:
        change_medium(ray, solid, closed, enters, leaves, before, behind)
    old, new = medium(before), medium(behind)
    if old == new:
        return (sheet, last_t, last)
    seen = max(old, new) if min(old, new) < 0 else min(old, new)
    shown = first
    while world.objects[world.surfaces[shown].object].solid != seen:
        _, shown, _ = closest(world, ray, t, shown, space)
    return (shown, last_t, last)


@inlined
def distance_uncertainty(world: Any, s: int, ray: Ray) -> float:
    """How far apart two faces of a mesh may come out along the ray where they really meet; 0 for other shapes."""
    surface = world.surfaces[s]
    if surface.count != 3:
        return 0.0
    return 2.0 * PLANE_ERROR * (surface.r + ray.reach) / abs(dot(vector(surface.normal), ray.direction))


@inlined
def change_medium(ray: Ray, solid: int, closed: bool, enters: bool, leaves: bool, before: Any, behind: Any) -> None:
    """Put a solid in or out of the set behind the surface.

    An open solid that is left without having been entered was around the ray all along: only its surface can tell.
    """
    if enters and leaves:
        return
    if leaves and not closed and not contains(before, solid):
        set_inside(before, solid, True)
    set_inside(behind, solid, enters)

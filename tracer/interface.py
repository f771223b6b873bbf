"""What a ray meets at one distance: which surface is seen there, and which media lie before and behind it.

Surfaces at bitwise equal t are one interface. An opaque one among them ends it. Otherwise the ray changes its set of
solids, and the surface belongs to whichever medium outranks the other; where the medium stays the same, the surface is
hidden: no row, no depth, no shading. A thin sheet bounds no medium and is always seen.
"""

from typing import Any

from tracer.hits import closest, transmit
from tracer.jit import compiled, routine
from tracer.media import contains, medium, put
from tracer.rays import Ray
from tracer.shapes import locate
from tracer.vector import dot


@compiled
def is_entering(world: Any, s: int, ray: Ray, t: float) -> bool:
    _, n, _ = locate(world, world.surfaces[s], ray, t)
    return dot(n, ray.direction) < 0.0


@compiled
def meet_interface(world: Any, ray: Ray, solids: Any, stack: Any) -> tuple[float, int]:
    """(t, surface) of the first interface the ray shows; surface -1 for none.

    `solids`: (2, words); the set the ray is in just before that interface, and just behind it. Hidden surfaces on the
    way change both.
    """
    before, behind = solids[0], solids[1]
    t, s, tied = closest(world, ray, 0.0, -1, stack)
    while s >= 0:
        material_transmits = transmit(world, s) > 0.0
        if not tied and not material_transmits:
            return (t, s)
        shown, last = cross(world, ray, t, s, tied, before, behind, stack)
        if shown >= 0:
            return (t, shown)
        for k in range(len(before)):
            before[k] = behind[k]
        t, s, tied = closest(world, ray, t, last, stack)
    return (t, s)


@routine
def cross(
    world: Any, ray: Ray, t: float, s: int, tied: bool, before: Any, behind: Any, stack: Any
) -> tuple[int, int]:
    """(surface shown or -1, last surface at this t): goes through all surfaces at t, solid by solid."""
    opaque, sheet, first_solid = -1, -1, -1
    last = s
    here = t
    while s >= 0 and here == t:
        last = s
        this = world.objects[world.surfaces[s].object]
        if transmit(world, s) == 0.0:
            if opaque < 0:
                opaque = s
        elif this.solid < 0:
            if sheet < 0:
                sheet = s
        else:
            if first_solid < 0:
                first_solid = s
            change_medium(world, this, s, ray, t, before, behind)
        if not tied:
            break
        here, s, _ = closest(world, ray, t, s, stack)
    if opaque >= 0:
        return (opaque, last)
    old, new = medium(before), medium(behind)
    if old != new:
        seen = max(old, new) if min(old, new) < 0 else min(old, new)
        return (surface_of(world, ray, t, seen, first_solid, last, tied, stack), last)
    return (sheet, last)


@routine
def change_medium(world: Any, this: Any, s: int, ray: Ray, t: float, before: Any, behind: Any) -> None:
    """Put the solid in or out of the set behind the surface, by the side from which the ray comes.

    Two faces of one solid at the same t, one entered and one left, are an edge that is grazed: nothing changes. A solid
    that is left without having been entered was around the ray from its start, if it starts in the eye or if the solid
    is open, so that only its surface can tell.
    """
    entering = is_entering(world, s, ray, t)
    was_inside = contains(before, this.solid)
    is_inside = contains(behind, this.solid)
    if was_inside != is_inside and entering != is_inside:
        put(behind, this.solid, was_inside)
        return
    if not entering and not was_inside and (ray.start < 0 or not this.closed):
        put(before, this.solid, True)
    put(behind, this.solid, entering)


@routine
def surface_of(world: Any, ray: Ray, t: float, solid: int, s: int, last: int, tied: bool, stack: Any) -> int:
    """The first surface from s to last, all at distance t, that bounds the solid."""
    while tied and s < last and world.objects[world.surfaces[s].object].solid != solid:
        _, s, _ = closest(world, ray, t, s, stack)
    return s

"""The first interface on a ray, and the media before and behind it (as `tracer.kernel.coincident_surfaces`)."""

from collections.abc import Sequence
from typing import NamedTuple

from tracer.tree.verified.balls import BallVector
from tracer.tree.verified.face import Crossing, Face
from tracer.tree.verified.scenery import Scenery

Solids = frozenset[int]  # ranks


class Interface(NamedTuple):
    """An interface on a ray; `shown` is None if it meets nothing."""

    shown: Crossing | None
    faces: tuple[Face, ...]  # all that lie there
    before: Solids
    behind: Solids


def medium(solids: Solids) -> int:
    """The rank of the solid that fills the space, -1 for empty space."""
    return min(solids, default=-1)


def first_interface(
    scenery: Scenery, o: BallVector, d: BallVector, start: Sequence[Face], inside: Solids
) -> Interface | None:
    """The first interface that is shown; None if it is not certain which."""
    crossings = scenery.crossings(o, d, start)
    if crossings is None:
        return None
    while crossings:
        certain = [c.t for c in crossings if c.certain]
        if not certain:
            return None
        nearest = min(certain, key=lambda t: t.upper())
        here = [c for c in crossings if not c.t > nearest and (c.certain or not c.face.avoids(o, d, nearest))]
        if not all(c.certain and (c is here[0] or c.face.is_same(here[0].face)) for c in here):
            return None
        found = cross(scenery, here, inside)
        if found is None or found.shown:
            return found
        inside = found.behind
        crossings = [c for c in crossings if not any(c is one for one in here)]
    return Interface(None, (), inside, inside)


def cross(scenery: Scenery, here: Sequence[Crossing], inside: Solids) -> Interface | None:
    """The interface of all crossings at one distance; None if it is not certain what it does."""
    faces = tuple(c.face for c in here)
    here = sorted(here, key=lambda c: c.face.surface)
    opaque = [c for c in here if scenery.material(c.face.surface).transmit == 0.0]
    before, behind = set(inside), set(inside)
    enters: dict[int, bool] = {}
    for c in here:
        solid = int(scenery.solids[c.face.surface])
        if solid >= 0 and (c.entering is None or enters.setdefault(solid, c.entering) != c.entering):
            return None
    for solid, entering in enters.items():
        if entering:
            behind.add(solid)
        else:
            if not scenery.world.arrays.closed[solid] and solid not in before:
                before.add(solid)
            behind.discard(solid)
    if opaque:
        return Interface(opaque[0], faces, frozenset(before), frozenset(before))
    old, new = medium(frozenset(before)), medium(frozenset(behind))
    shown = None
    if old == new:
        shown = next((c for c in here if scenery.solids[c.face.surface] < 0), None)
    else:
        seen = max(old, new) if min(old, new) < 0 else min(old, new)
        shown = next(c for c in here if scenery.solids[c.face.surface] == seen and c.entering == (seen in behind))
    return Interface(shown, faces, frozenset(before), frozenset(behind))

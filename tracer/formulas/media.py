"""Nested media: the set of solids that a ray is inside of, and which of them decides its index of refraction.

Where transparent solids overlap, the one of highest priority fills the space (Schmidt & Budge, "Simple Nested
Dielectrics in Ray Traced Images", journal of graphics tools 7(2), 2002). The set is a bit mask. Solids are numbered
by rank: by falling priority, and in the file's order among equals. So the lowest bit set is the medium.

Entering a solid sets its bit and leaving clears it, whatever it was before. So if rounding lets a ray meet a surface
twice, the second time changes nothing; and where the medium does not change, there is no interface.
"""

from typing import Protocol

from tracer.compile.jit import inlined
from tracer.compile.rows import Numbers

VACUUM = 1.0  # index of refraction of empty space

# Indices of refraction for yellow light (589 nm) from tables; those of air, water and glass as on the slide.
INDICES = {
    "vacuum": 1.0,
    "air": 1.0003,
    "ice": 1.31,
    "water": 1.33,
    "ethanol": 1.361,
    "glycerol": 1.473,
    "acrylic": 1.49,
    "glass": 1.52,
    "quartz": 1.544,
    "amber": 1.55,
    "flint glass": 1.62,
    "sapphire": 1.77,
    "diamond": 2.417,
}


WORD = 32  # solids in a word of the mask: half of its bits, so that no shift reaches the sign


@inlined
def contains(solids: Numbers, rank: int) -> bool:
    """Whether the bit of a solid is set."""
    return (solids[rank >> 5] >> (rank & 31)) & 1 != 0


@inlined
def set_inside(solids: Numbers, rank: int, inside: bool) -> None:
    """Set or clear the bit of a solid."""
    bit = 1 << (rank & 31)
    if inside:
        solids[rank >> 5] |= bit
    else:
        solids[rank >> 5] &= ~bit


@inlined
def medium(solids: Numbers) -> int:
    """Rank of the solid that fills the space, -1 for empty space."""
    for k in range(len(solids)):
        word = solids[k]
        if word != 0:
            rank = WORD * k
            while word & 1 == 0:
                word >>= 1
                rank += 1
            return rank
    return -1


class MediaArrays(Protocol):
    """The array of the world that `index_of` reads."""

    @property
    def indices(self) -> Numbers: ...


@inlined
def index_of(world: MediaArrays, rank: int) -> float:
    """Index of refraction of the solid of a rank, or of empty space."""
    return world.indices[rank] if rank >= 0 else VACUUM

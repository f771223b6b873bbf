"""The set of solids a ray is in, as bits; which of them decides the index of refraction.

Schmidt & Budge, "Simple Nested Dielectrics in Ray Traced Images", journal of graphics tools 7(2), 2002: where
transparent solids overlap, the one of highest priority fills the space. The solids are numbered by rank, highest
priority first and in the file's order among equals, so the lowest bit that is set is the medium.

Entering sets a bit and leaving clears it, whatever it was before. So a surface that rounding lets a ray meet twice
changes nothing the second time, and what changes nothing is no interface.
"""

from typing import Any

from tracer.compile.jit import inlined

VACUUM = 1.0  # index of refraction of empty space

# Indices for yellow light (589 nm) as tables give them; air, water and glass as on the slide.
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


WORD = 32  # solids a word of the set holds: half of what fits, so that no shift meets the sign


@inlined
def contains(solids: Any, rank: int) -> bool:
    return (solids[rank >> 5] >> (rank & 31)) & 1 != 0


@inlined
def set_inside(solids: Any, rank: int, inside: bool) -> None:
    """Set or clear a solid's bit."""
    bit = 1 << (rank & 31)
    if inside:
        solids[rank >> 5] |= bit
    else:
        solids[rank >> 5] &= ~bit


@inlined
def medium(solids: Any) -> int:
    """Rank of the solid that fills this space, -1 for empty space."""
    for k in range(len(solids)):
        word = solids[k]
        if word != 0:
            rank = WORD * k
            while word & 1 == 0:
                word >>= 1
                rank += 1
            return rank
    return -1


@inlined
def index_of(world: Any, rank: int) -> float:
    return world.indices[rank] if rank >= 0 else VACUUM

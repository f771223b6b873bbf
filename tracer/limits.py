"""How far a tree of rays goes, and by which model its edges weigh."""

from typing import NamedTuple

WHITTED, FRESNEL = range(2)
MODELS = ("whitted", "fresnel")


ANY_DEPTH = 2**31 - 1  # what a row's depth can count to
LEVEL_BY_LEVEL = -1.0  # instead of a tolerance


class Limits(NamedTuple):
    """How far a tree goes, and what its edges weigh."""

    depth: int  # at most ANY_DEPTH
    min_weight: float  # a ray whose largest weight is below is cut
    max_nodes: int  # rows a tree may have
    tolerance: float  # the heaviest ray first until those left weigh no more than this in sum; below 0: level by level
    model: int
    glass_blocks: bool  # shadow rays: glass casts a full shadow instead of filtering the light
    records: bool  # the table will be read (a click): fill in what an image has no use for

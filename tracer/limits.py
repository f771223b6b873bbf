"""How far a tree of rays goes, and by which model its edges weigh."""

from typing import NamedTuple

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

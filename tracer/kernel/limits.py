"""How far a tree of rays goes, and by which model its edges weigh."""

from numbers import Integral, Real
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from tracer.kernel.world import World

WHITTED, FRESNEL = range(2)
MODELS = ("whitted", "fresnel")


MAX_NODES = 10**6  # rays of a tree, where no one asks for more or fewer
MAX_DEPTH = 2**31 - 1  # what a row's depth can count to
BREADTH_FIRST = -1.0  # instead of a tolerance


class Limits(NamedTuple):
    """How far a tree goes, and what its edges weigh."""

    depth: int  # at most ANY_DEPTH
    min_weight: float  # a ray whose largest weight is below is cut
    max_nodes: int  # rows a tree may have
    tolerance: float  # the heaviest ray first until those left weigh no more than this in sum; below 0: level by level
    model: int
    glass_blocks: bool  # shadow rays: glass casts a full shadow instead of filtering the light
    records: bool  # the table will be read (a click): fill in what an image has no use for


def make_limits(
    world: "World",
    depth: int | None = None,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    max_nodes: int = MAX_NODES,
    model: str | None = None,
    *,
    records: bool,
) -> Limits:
    """The kernel's limits, with the scene's own values where none are given; ValueError for what can be none."""
    tracing = world.scene.tracing
    if depth is None:
        depth = tracing.depth if tolerance is None else MAX_DEPTH
    model = model or tracing.model
    if not (isinstance(depth, Integral) and 0 <= depth <= MAX_DEPTH):
        raise ValueError(f"depth must be a whole number, 0 .. {MAX_DEPTH}, got {depth!r}")
    if not (isinstance(min_weight, Real) and min_weight >= 0.0):
        raise ValueError(f"min_weight must be a number >= 0, got {min_weight!r}")
    if tolerance is not None and not (isinstance(tolerance, Real) and tolerance >= 0.0):
        raise ValueError(f"tolerance must be a number >= 0, got {tolerance!r}")
    if not (isinstance(max_nodes, Integral) and max_nodes >= 1):
        raise ValueError(f"max_nodes must be a whole number >= 1, got {max_nodes!r}")
    if model not in MODELS:
        raise ValueError(f"model must be one of {', '.join(MODELS)}, got {model!r}")
    least = BREADTH_FIRST if tolerance is None else float(tolerance)
    blocks = tracing.shadows == "block"
    return Limits(int(depth), float(min_weight), int(max_nodes), least, MODELS.index(model), blocks, records)

"""Limits of a ray tree, and the model that weights its rays."""

from numbers import Integral, Real
from typing import NamedTuple

from tracer.choices import BLOCK, MODELS, SHADOWS
from tracer.kernel.world import World

MAX_NODES = 10**6  # rows of a tree, unless asked otherwise
MAX_DEPTH = 2**31 - 1  # limit of a row's `depth`
BREADTH_FIRST = -1.0  # value of `tolerance` for breadth-first tracing


class Limits(NamedTuple):
    """The limits as kernels take them."""

    depth: int  # at most MAX_DEPTH
    min_weight: float  # a ray whose largest weight is below it is cut
    max_nodes: int  # rows of a tree
    tolerance: float  # best-first, until the weights of the rays left sum up to this at most; below 0: breadth-first
    model: int  # as MODELS numbers them
    glass_blocks: bool  # transparent surfaces block shadow rays instead of filtering them
    records: bool  # the table will be read (a click): fill in what an image does not need


def make_limits(
    world: World,
    depth: int | None = None,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    max_nodes: int = MAX_NODES,
    model: str | None = None,
    *,
    records: bool,
) -> Limits:
    """The limits for a world. A `depth` or `model` of None is taken from the scene. ValueError for a value that is not
    allowed.
    """
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
    blocks = tracing.shadows == SHADOWS[BLOCK]
    return Limits(int(depth), float(min_weight), int(max_nodes), least, MODELS.index(model), blocks, records)

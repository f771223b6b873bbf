"""Limits of a ray tree, and the model that weights its rays.

An image has a limit of rays in total, which ends images of scenes that reflect without end. It is divided evenly: every
tree of the image gets the same limit of rows, `image_max_nodes`, before the first ray is traced. So the tree of one
pixel can be traced again with the limit of its image, and ends at the same ray.
"""

import math
from numbers import Integral, Real
from typing import NamedTuple

from tracer.choices import BLOCK, MODELS, SHADOWS
from tracer.kernel.world import World
from tracer.scene.radiance_bound import radiance_bound

MAX_NODES = 10**6  # rows of a tree, unless asked otherwise
MAX_RAYS = 10**10  # rays of an image for each sample that a pixel can get, unless asked otherwise
LEAST_ROWS = 1000  # the same for each pixel, where an image is so large that this is more
MAX_DEPTH = 2**31 - 1  # limit of a row's `depth`
BREADTH_FIRST = -1.0  # value of `tolerance` for breadth-first tracing


class Limits(NamedTuple):
    """The limits as kernels take them."""

    depth: int  # at most MAX_DEPTH
    min_weight: float  # a ray whose largest weight is below it is cut
    max_nodes: int  # rows of a tree as it is recorded: each ray, with all shadow rays that its hit could have
    tolerance: float  # best-first, until the weights of the rays left sum up to this at most; below 0: breadth-first
    model: int  # as MODELS numbers them
    glass_blocks: bool  # transparent surfaces block shadow rays instead of filtering them
    records: bool  # the table will be read (a click): fill in what an image does not need


def default_max_rays(pixels: int, samples: int = 1) -> int:
    """The limit of rays of an image, unless asked otherwise.

    MAX_RAYS is some minutes of work between facing mirrors (14 to 45 million rays a second on two processors), and at
    640x480 leaves each tree 32 552 rows, a hundred times as many as a glass ball needs at depth 20. It is multiplied by
    the number of samples, so that the trees of an image end at the same rays however many samples its pixels get.
    """
    return samples * max(MAX_RAYS, LEAST_ROWS * pixels)


def image_max_nodes(
    world: World, pixels: int, samples: int = 1, max_rays: int | None = None, max_nodes: int | None = None
) -> int:
    """The limit of rows for every tree of an image with so many pixels, and at most `samples` samples of a pixel:
    `max_nodes` if it is given.

    Otherwise it is an equal share of the limit of rays, but at least one hit with its shadow rays, and at most
    MAX_NODES. ValueError for a `max_rays` that is not allowed.
    """
    if max_nodes is not None:
        if max_rays is not None:
            raise ValueError("give max_rays (of the image) or max_nodes (of each tree), not both")
        return max_nodes
    if max_rays is None:
        max_rays = default_max_rays(pixels, samples)
    if not (isinstance(max_rays, Integral) and max_rays >= 1):
        raise ValueError(f"max_rays must be a whole number >= 1, got {max_rays!r}")
    return min(MAX_NODES, max(1 + len(world.scene.lights), int(max_rays) // (pixels * samples)))


def make_limits(
    world: World,
    depth: int | None = None,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    max_nodes: int = MAX_NODES,
    model: str | None = None,
    *,
    missing: float | None = None,
    records: bool,
) -> Limits:
    """The limits for a world. A `depth` or `model` of None is taken from the scene. `missing` is a limit on the light
    that is missing, in place of `tolerance`, the same on the weight.

    ValueError for a value that is not allowed; MissingBoundError if the light that is missing has no bound.
    """
    if missing is not None:
        if tolerance is not None:
            raise ValueError("give a tolerance (of weight) or missing (light), not both")
        if not (isinstance(missing, Real) and 0.0 <= missing < math.inf):
            raise ValueError(f"missing must be a number >= 0, got {missing!r}")
        tolerance = radiance_bound(world.scene).weight(float(missing))
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

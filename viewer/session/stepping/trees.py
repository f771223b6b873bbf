"""The trees of the picked place: the one on show, and the one for which the panel of the tree has room."""

import tracer
from tracer.formulas.vector import Vector
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree

LAYOUT_DEPTH = 3  # the tree is laid out for at least this depth, so that no node moves when the depth is stepped 0..3


def trace_place(
    world: World,
    pixel: tuple[int, int],
    ray: tuple[Vector, Vector] | None,
    sample: int | None,
    depth: int,
    model: str,
    max_nodes: int,
) -> tuple[RayTree, RayTree]:
    """The tree of a pixel's sample, or of a ray if one is given, and the same tree at least LAYOUT_DEPTH deep, whose
    first rows are those of the first. ValueError as of `tracer.trace`.
    """
    deeper = max(depth, LAYOUT_DEPTH)
    place, sample = (None, None) if ray else (pixel, sample)
    tree, *others = (
        tracer.trace(world, place, ray, sample=sample, depth=levels, model=model, max_nodes=max_nodes)
        for levels in dict.fromkeys((depth, deeper))
    )
    return tree, others[0] if others else tree

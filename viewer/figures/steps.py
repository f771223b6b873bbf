"""Steps of a figure that grows: by depth, ray by ray, or hit by hit as the radiance is summed up."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree


@dataclass(frozen=True)
class Step:
    """One page: some rows of a tree."""

    tree: RayTree
    rows: frozenset[int]
    summed: frozenset[int]  # rows whose radiance is shown
    current: int | None = None  # the row that the page adds
    name: str = ""  # in file names: d2, r05, c03


def by_depth(trees: Sequence[RayTree]) -> list[Step]:
    """One page per depth, each with a whole tree."""
    return [Step(t, frozenset(range(len(t))), frozenset(range(len(t))), name=f"d{t.depth}") for t in trees]


def by_ray(tree: RayTree) -> list[Step]:
    """One page per ray, in the order in which they are traced."""
    digits = len(str(len(tree) - 1))
    return [
        Step(tree, frozenset(range(i + 1)), frozenset(), current=i, name=f"r{i:0{digits}}") for i in range(len(tree))
    ]


def by_color(tree: RayTree) -> list[Step]:
    """One page per hit, in the order in which radiance is summed up: a hit comes after all hits below it."""
    everything = frozenset(range(len(tree)))
    hits = [i for i in range(len(tree) - 1, -1, -1) if tree.nodes["kind"][i] != SHADOW]
    digits = len(str(len(hits)))
    return [Step(tree, everything, frozenset(), name=f"c{0:0{digits}}")] + [
        Step(tree, everything, frozenset(hits[: k + 1]), current=i, name=f"c{k + 1:0{digits}}")
        for k, i in enumerate(hits)
    ]


def without_lights(steps: Sequence[Step]) -> list[Step]:
    """The steps without shadow rays, and without the pages that add one."""
    found = []
    for step in steps:
        shadows = {i for i in step.rows if step.tree.nodes["kind"][i] == SHADOW}
        if step.current not in shadows:
            found.append(replace(step, rows=step.rows - shadows))
    return found

"""One step of a figure that grows: which rays are there, and how far the colour has flowed back."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree

STEPS = ("depth", "rays", "colour")


@dataclass(frozen=True)
class Stage:
    """A page: this tree, of it these rows; `summed` are those whose colour is known, `current` what the page is about.

    The colour of a whole tree is known: only where it is watched as it flows back, not all of it.
    """

    tree: RayTree
    rows: frozenset[int]
    summed: frozenset[int]
    current: int | None = None
    name: str = ""  # in a file's name: d2, r05, c03


def by_depth(trees: Sequence[RayTree]) -> list[Stage]:
    """A page a depth."""
    return [Stage(t, frozenset(range(len(t))), frozenset(range(len(t))), name=f"d{t.depth}") for t in trees]


def by_ray(tree: RayTree) -> list[Stage]:
    """A page a ray, in the order in which they are traced."""
    digits = len(str(len(tree) - 1))
    return [
        Stage(tree, frozenset(range(i + 1)), frozenset(), current=i, name=f"r{i:0{digits}}") for i in range(len(tree))
    ]


def by_colour(tree: RayTree) -> list[Stage]:
    """A page a hit, in the order in which colour flows back: a hit's is known when those below it are."""
    everything = frozenset(range(len(tree)))
    hits = [i for i in range(len(tree) - 1, -1, -1) if tree.nodes["kind"][i] != SHADOW]
    digits = len(str(len(hits)))
    return [Stage(tree, everything, frozenset(), name=f"c{0:0{digits}}")] + [
        Stage(tree, everything, frozenset(hits[: k + 1]), current=i, name=f"c{k + 1:0{digits}}")
        for k, i in enumerate(hits)
    ]


def without_lights(stages: Sequence[Stage]) -> list[Stage]:
    """The same without rays to lights; nor is there a page about one."""
    found = []
    for stage in stages:
        shadows = {i for i in stage.rows if stage.tree.nodes["kind"][i] == SHADOW}
        if stage.current not in shadows:
            found.append(replace(stage, rows=stage.rows - shadows))
    return found

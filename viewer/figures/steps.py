"""Steps of a figure that grows: by depth, ray by ray, or hit by hit as the radiance is summed up."""

from collections.abc import Sequence, Set
from dataclasses import dataclass, replace

from tracer.kernel.nodes import KINDS, SHADOW
from tracer.tree.raytree import RayTree


@dataclass(frozen=True)
class Step:
    """One page: some rows of a tree."""

    tree: RayTree
    rows: frozenset[int]
    summed: frozenset[int]  # rows whose radiance is shown
    current: int | None = None  # the row that the page adds
    name: str = ""  # in file names: d2, r05, c03

    @staticmethod
    def whole(tree: RayTree, name: str = "") -> "Step":
        """The page with the whole tree."""
        rows = frozenset(range(len(tree)))
        return Step(tree, rows, rows, name=name)


def by_depth(trees: Sequence[RayTree]) -> list[Step]:
    """One page per depth, each with a whole tree."""
    return [Step.whole(t, f"d{t.depth}") for t in trees]


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


def of_kinds(steps: Sequence[Step], kinds: Set[str]) -> list[Step]:
    """The steps without the rays of other kinds, without the rays below these, and without the pages that add one.

    The camera ray stays.
    """
    if kinds >= set(KINDS):
        return list(steps)
    found = []
    for step in steps:
        rows = _closed_under_parents(step, kinds)
        if step.current is None or step.current in rows:
            found.append(replace(step, rows=rows))
    return found


def without_lights(steps: Sequence[Step]) -> list[Step]:
    """The steps without shadow rays, and without the pages that add one."""
    return of_kinds(steps, set(KINDS) - {"shadow"})


def _closed_under_parents(step: Step, kinds: Set[str]) -> frozenset[int]:
    """The rows of these kinds whose ancestors are of these kinds, too."""
    tree, kept = step.tree, set[int]()
    parents = tree.nodes["parent"].tolist()
    for i in sorted(step.rows):
        if i == 0 or (parents[i] in kept and tree.kind(i) in kinds):
            kept.add(i)
    return frozenset(kept)

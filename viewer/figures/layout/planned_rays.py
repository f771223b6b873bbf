"""The rays that a tree figure is planned for, in lists: a plan tries many layouts of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from tracer.kernel.nodes import REFRACTION, SHADOW, TIR
from tracer.tree.raytree import RayTree


@dataclass(frozen=True)
class PlannedRays:
    """The steps of one tree, the deepest last, and rows of that one."""

    trees: Sequence[RayTree]
    rows: frozenset[int]  # that may be drawn or folded; the others are left out. With each row, its parent is in it
    first: frozenset[int] = frozenset()  # that are folded last

    @property
    def tree(self) -> RayTree:
        return self.trees[-1]

    @cached_property
    def weights(self) -> list[float]:
        """The largest component of each row's weight."""
        return self.tree.nodes["weight"].max(axis=1).tolist()

    @cached_property
    def depths(self) -> list[int]:
        return self.tree.nodes["depth"].tolist()

    @cached_property
    def deepest(self) -> int:
        """The largest depth."""
        return max(self.depths)

    @cached_property
    def parents(self) -> list[int]:
        return self.tree.nodes["parent"].tolist()

    @cached_property
    def is_shadow(self) -> list[bool]:
        return (self.tree.nodes["kind"] == SHADOW).tolist()

    @cached_property
    def is_refracted(self) -> list[bool]:
        return (self.tree.nodes["kind"] == REFRACTION).tolist()

    @cached_property
    def is_tir(self) -> list[bool]:
        """Whether each row is a ray of total internal reflection."""
        return (self.tree.nodes["kind"] == TIR).tolist()

    @property
    def shadow_rays(self) -> dict[int, list[int]]:
        """The shadow rays of each row that has some."""
        return self._below[True]

    @property
    def rays(self) -> dict[int, list[int]]:
        """The other rays that each row sends out, if it does."""
        return self._below[False]

    @cached_property
    def _below(self) -> tuple[dict[int, list[int]], dict[int, list[int]]]:
        """(rays, shadow rays) by the row that sends them out."""
        found: tuple[dict[int, list[int]], dict[int, list[int]]] = ({}, {})
        for i, (parent, is_shadow) in enumerate(zip(self.parents, self.is_shadow, strict=True)):
            below = found[is_shadow]
            if parent in below:
                below[parent].append(i)
            elif i:
                below[parent] = [i]
        return found

    @cached_property
    def heaviest(self) -> list[int]:
        """The planned hits, the heaviest first; before all others, the first hit and those that are folded last."""
        hits = (i for i in sorted(self.rows) if not self.is_shadow[i])
        return sorted(hits, key=lambda i: (i > 0 and i not in self.first, -self.weights[i]))

    @cached_property
    def branch_sizes(self) -> list[int]:
        """The number of planned rows in each row's branch, itself among them."""
        parents, sizes = self.parents, [int(i in self.rows) for i in range(len(self.parents))]
        for i in range(len(sizes) - 1, 0, -1):  # parents come before their children
            sizes[parents[i]] += sizes[i]
        return sizes

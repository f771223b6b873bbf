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

    @cached_property
    def shadow_rays(self) -> list[list[int]]:
        """The shadow rays of each row."""
        return self._below(True)

    @cached_property
    def rays(self) -> list[list[int]]:
        """The other rays that each row sends out."""
        return self._below(False)

    def _below(self, shadow: bool) -> list[list[int]]:
        found: list[list[int]] = [[] for _ in self.parents]
        for i, parent in enumerate(self.parents):
            if parent >= 0 and self.is_shadow[i] == shadow:
                found[parent].append(i)
        return found

    @cached_property
    def branch_sizes(self) -> list[int]:
        """The number of planned rows in each row's branch, itself among them."""
        sizes = [int(i in self.rows) for i in range(len(self.parents))]
        for i in range(len(sizes) - 1, 0, -1):  # parents come before their children
            sizes[self.parents[i]] += sizes[i]
        return sizes

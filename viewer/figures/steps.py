"""Steps of a figure that grows.

By depth, each page has a whole tree. Within one tree, the rays appear first, level by level or ray by ray, with all
shadow rays of a hit in one step. Then the radiance is summed up, hit by hit, and each hit comes after all hits below
it. There are two orders:

- breadth-first, as the kernel does it: the rows of the table from the first to the last, then their sums from the last
  to the first;
- depth-first, as the recursive procedure does it (`tracer.whitted`): a ray is followed to its end before the next one
  is sent out, and the radiance of a hit is known as soon as its children have returned. So the two are mixed.
"""

from collections.abc import Callable, Sequence, Set
from dataclasses import dataclass, replace
from functools import cached_property
from typing import overload

import numpy as np

from tracer.kernel.nodes import KINDS, SHADOW
from tracer.tree.raytree import RayTree
from viewer.figures.catalogue import BREADTH, RECURSION


@dataclass(frozen=True)
class Step:
    """One page: some rows of a tree."""

    tree: RayTree
    rows: frozenset[int]
    summed: frozenset[int]  # rows whose radiance is shown
    current: frozenset[int] = frozenset()  # the rows that the page adds, or the hit whose radiance it sums up
    name: str = ""  # in file names: d2, r05, c03
    kinds: Set[str] = frozenset(KINDS)  # of rays that are shown

    @property
    def sum(self) -> int | None:
        """The hit whose radiance this page sums up, if it does that."""
        return next(iter(self.current)) if self.current and self.current <= self.summed else None


@dataclass(frozen=True)
class Change:
    """The difference between a step and the one before: rows that appear, or the hit that is summed up."""

    rows: tuple[int, ...]
    sums: bool = False


class Steps(Sequence[Step]):
    """The steps of one tree. Each is made when it is asked for, in a time proportional to the rows that it shows."""

    def __init__(self, tree: RayTree, changes: Sequence[Change], letter: str, whole: int = 0) -> None:
        """The steps that follow from these changes. If `whole`, the first page shows the first `whole` changes at once,
        and none of them is `current`.
        """
        self.tree, self.changes, self.letter, self.whole = tree, changes, letter, whole
        self._rows = [row for change in changes if not change.sums for row in change.rows]
        self._sums = [row for change in changes if change.sums for row in change.rows]
        # How many of these there are after each change.
        self._revealed = np.cumsum([0 if change.sums else len(change.rows) for change in changes]).tolist()
        self._summed = np.cumsum([len(change.rows) if change.sums else 0 for change in changes]).tolist()

    def __len__(self) -> int:
        return len(self.changes) - self._begin

    @overload
    def __getitem__(self, k: int) -> Step: ...
    @overload
    def __getitem__(self, k: slice) -> list[Step]: ...
    def __getitem__(self, k: int | slice) -> Step | list[Step]:
        if isinstance(k, slice):
            return [self[j] for j in range(*k.indices(len(self)))]
        if not -len(self) <= k < len(self):
            raise IndexError(k)
        k %= len(self)
        at = self._begin + k
        rows, sums = self._rows[: self._revealed[at]], self._sums[: self._summed[at]]
        current = frozenset(() if k == 0 and self.whole else self.changes[at].rows)
        name = f"{self.letter}{k:0{len(str(len(self) - 1))}}"
        return Step(self.tree, frozenset(rows), frozenset(sums), current, name)

    @cached_property
    def count_reveals(self) -> int:
        """How many of the changes add rays."""
        return sum(not change.sums for change in self.changes)

    @property
    def _begin(self) -> int:
        """The number of the change after which the first page is."""
        return max(self.whole - 1, 0)

    @cached_property
    def _places(self) -> dict[tuple[int, bool], int]:
        """The index of the step that adds a row, or (True) sums it up."""
        found = {}
        for k, change in enumerate(self.changes):
            found |= {(row, change.sums): max(k - self._begin, 0) for row in change.rows}
        return found

    def find(self, row: int, sums: bool) -> int | None:
        """The index of the step that adds a row, or with `sums` of the one that sums it up; None if there is none."""
        return self._places.get((row, sums))


def by_depth(trees: Sequence[RayTree], lights: bool = True) -> list[Step]:
    """One page per depth, each with a whole tree."""
    return [whole(tree, lights) for tree in trees]


def whole(tree: RayTree, lights: bool = True) -> Step:
    """A whole tree. Without `lights`, there are no shadow rays."""
    rows = frozenset(np.flatnonzero(_shown(tree, lights)).tolist())
    return Step(tree, rows, rows, name=f"d{tree.depth}")


def by_level(tree: RayTree, lights: bool = True) -> Steps:
    """One page per level of the tree, then one per hit as the radiance is summed up. Breadth-first."""
    depths = tree.nodes["depth"]
    levels = [
        Change(tuple(np.flatnonzero((depths == depth) & _shown(tree, lights)).tolist()))
        for depth in range(int(depths.max()) + 1)
    ]
    return Steps(tree, [*levels, *_sums(tree)], "l")


def by_ray(tree: RayTree, order: str = BREADTH, lights: bool = True) -> Steps:
    """One page per ray, and one for all shadow rays of a hit; then, or between them (RECURSION), one per hit as the
    radiance is summed up.
    """
    return Steps(tree, _CHANGES[order](tree, lights), "r")


def by_color(tree: RayTree, order: str = BREADTH, lights: bool = True) -> Steps:
    """The whole tree, then one page per hit as the radiance is summed up."""
    changes = _CHANGES[order](tree, lights)
    reveals, sums = ([change for change in changes if change.sums is wanted] for wanted in (False, True))
    return Steps(tree, [*reveals, *sums], "c", whole=len(reveals))


def _breadth(tree: RayTree, lights: bool) -> list[Change]:
    changes: list[Change] = []
    parents, shadows, shown = tree.nodes["parent"], tree.nodes["kind"] == SHADOW, _shown(tree, lights)
    for i in np.flatnonzero(shown).tolist():
        before = changes[-1].rows if changes else ()
        if shadows[i] and before and shadows[before[0]] and parents[before[0]] == parents[i]:
            changes[-1] = Change((*before, i))
        else:
            changes.append(Change((i,)))
    return changes + _sums(tree)


def _sums(tree: RayTree) -> list[Change]:
    """The kernel sums from the last row to the first, so children come before their parents."""
    return [Change((i,), True) for i in np.flatnonzero(tree.nodes["kind"] != SHADOW)[::-1].tolist()]


def _recursion(tree: RayTree, lights: bool) -> list[Change]:
    changes = []
    shadows = (tree.nodes["kind"] == SHADOW).tolist()
    waiting = [(0, False)]  # (row, whether its children have returned): a stack, as deep trees exceed Python's
    while waiting:
        i, returned = waiting.pop()
        changes.append(Change((i,), returned))
        if returned:
            continue
        below = tree.children[i]
        to_lights = tuple(c for c in below if shadows[c])
        if to_lights and lights:
            changes.append(Change(to_lights))
        waiting.append((i, True))
        waiting += [(c, False) for c in reversed(below) if not shadows[c]]
    return changes


def _shown(tree: RayTree, lights: bool) -> np.ndarray:
    return (tree.nodes["kind"] != SHADOW) | lights


_CHANGES: dict[str, Callable[[RayTree, bool], list[Change]]] = {BREADTH: _breadth, RECURSION: _recursion}


def adding(steps: Steps, kinds: Set[str]) -> list[int]:
    """The pages by ray that add rays of these kinds: those that add only others, or rays below these, look like the
    page before.
    """
    kept = of_kinds(whole(steps.tree), kinds).rows
    return [k for k in range(steps.count_reveals) if kept.intersection(steps.changes[k].rows)]


def of_kinds(step: Step, kinds: Set[str]) -> Step:
    """The step without the rays of other kinds and the rays below these. The camera ray stays."""
    if kinds >= set(KINDS):
        return step
    tree, kept = step.tree, set[int]()
    parents = tree.nodes["parent"].tolist()
    for i in sorted(step.rows):  # parents come before their children
        if i == 0 or (parents[i] in kept and tree.kind(i) in kinds):
            kept.add(i)
    return replace(step, rows=frozenset(kept), kinds=frozenset(kinds))

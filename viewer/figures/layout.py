"""Where the nodes of a ray tree stand: the tidy tree of Reingold & Tilford, IEEE Trans. Softw. Eng. 7(2), 1981.

Reflected rays go to the left of their hit, refracted ones to the right, and the hit stands over their middle. Between
them, half a level down, short stubs lead to the lights, as in Whitted's figure. Nothing of one level comes closer than
its width; the same subtree looks the same wherever it stands.
"""

from dataclasses import dataclass

import numpy as np

from tracer.nodes import REFRACTION, SHADOW
from tracer.tree import RayTree

# In node widths. A node's name stands to its right.
LEFT, RIGHT = 0.32, 0.92
STUB_GAP = 0.32  # between two stubs
STUB_HALF = 0.16
LEAN = 0.5  # how far to its side an only child stands
EDGE_ROOM = 0.2  # between a stub and the edges beside it


@dataclass(frozen=True)
class Place:
    """Where a node stands: x in node widths, y in levels (a stub to a light stands half a level below its hit)."""

    x: float
    y: float


@dataclass
class _Subtree:
    """Positions relative to its root, and how far it reaches left and right at each half level below the root."""

    offsets: dict[int, float]
    left: list[float]
    right: list[float]


def layout(tree: RayTree, rows: set[int]) -> dict[int, Place]:
    """Places of these rows (with every row its parent must be there); the root at x = 0."""
    subtrees: dict[int, _Subtree] = {}
    for i in sorted(rows, reverse=True):
        if tree.nodes["kind"][i] != SHADOW:
            subtrees[i] = _join(tree, i, [child for child in tree.children[i] if child in rows], subtrees)
    half = tree.nodes["kind"] == SHADOW
    offsets = subtrees[0].offsets
    return {i: Place(x, float(tree.nodes["depth"][i]) + (0.5 if half[i] else 0.0)) for i, x in offsets.items()}


def _join(tree: RayTree, i: int, children: list[int], subtrees: dict[int, _Subtree]) -> _Subtree:
    """The subtree of row i from those of the rays it sends out, which are used up."""
    kinds = tree.nodes["kind"]
    stubs = [child for child in children if kinds[child] == SHADOW]
    thrown_back = [child for child in children if kinds[child] not in (SHADOW, REFRACTION)]
    let_through = [child for child in children if kinds[child] == REFRACTION]
    rays = [*thrown_back, *let_through]
    shifts = _apart([subtrees[child] for child in rays])
    if thrown_back and let_through:
        # The edges must leave room for the stubs where they pass them, halfway down.
        wanted = 4.0 * (0.5 * STUB_GAP * max(len(stubs) - 1, 0) + EDGE_ROOM) if stubs else 0.0
        grow = max(0.0, wanted - (shifts[-1] - shifts[0]))
        shifts = [shift + (grow if k >= len(thrown_back) else 0.0) for k, shift in enumerate(shifts)]
        middle = 0.5 * (shifts[0] + shifts[-1])
    elif rays:
        middle = shifts[-1] + LEAN if thrown_back else shifts[0] - LEAN
    else:
        middle = 0.0
    shifts = [shift - middle for shift in shifts]
    offsets = {i: 0.0}
    left, right = [-LEFT, 0.0], [RIGHT, 0.0]
    for child, x in zip(stubs, _stub_places(len(stubs), bool(thrown_back), bool(let_through)), strict=True):
        offsets[child] = x
        left[1], right[1] = min(left[1], x - STUB_HALF), max(right[1], x + STUB_HALF)
    for child, shift in zip(rays, shifts, strict=True):
        sub = subtrees.pop(child)
        offsets |= {row: x + shift for row, x in sub.offsets.items()}
        left[1], right[1] = min(left[1], 0.5 * shift), max(right[1], 0.5 * shift)
        for level, (low, high) in enumerate(zip(sub.left, sub.right, strict=True), start=2):
            if level == len(left):
                left.append(low + shift)
                right.append(high + shift)
            left[level], right[level] = min(left[level], low + shift), max(right[level], high + shift)
    return _Subtree(offsets, left, right)


def _apart(subtrees: list[_Subtree]) -> list[float]:
    """Shifts that put subtrees side by side, each as far left as the outlines of those before it allow."""
    shifts: list[float] = []
    edge: list[float] = []
    for sub in subtrees:
        shift = max((edge[level] - reach for level, reach in enumerate(sub.left[: len(edge)])), default=0.0)
        shifts.append(shift)
        for level, reach in enumerate(sub.right):
            if level == len(edge):
                edge.append(reach + shift)
            edge[level] = max(edge[level], reach + shift)
    return shifts


def _stub_places(count: int, ray_left: bool, ray_right: bool) -> list[float]:
    """Where the stubs to the lights hang: in the middle, or on the side where no ray goes."""
    if ray_left != ray_right:
        sign = 1.0 if ray_left else -1.0
        return [sign * (0.5 * EDGE_ROOM + STUB_GAP * k) for k in range(count)]
    return [STUB_GAP * (k - 0.5 * (count - 1)) for k in range(count)]


def with_parents_only(parents: np.ndarray, wanted: set[int]) -> set[int]:
    """Rows whose every ancestor is wanted too: a branch that is switched off takes what hangs on it along."""
    kept: set[int] = set()
    for i in sorted(wanted):
        if i == 0 or int(parents[i]) in kept:
            kept.add(i)
    return kept

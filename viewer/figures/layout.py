"""Where the nodes of a ray tree stand: the tidy tree of Reingold & Tilford, IEEE Trans. Softw. Eng. 7(2), 1981.

A parent stands over the middle of the rays it sends out; no two nodes of a level come closer than their widths; the same
subtree looks the same wherever it stands. Reflected rays go left, refracted ones right, and between them, half a level
down, short stubs lead to the lights, as in Whitted's figure.
"""

from dataclasses import dataclass

from tracer.nodes import REFRACTION, SHADOW
from tracer.tree import RayTree

RAY_WIDTH = 1.0
STUB_WIDTH = 0.5


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
        subtrees[i] = _join(tree, i, [child for child in tree.children[i] if child in rows], subtrees)
    root = subtrees[0]
    half = tree.nodes["kind"] == SHADOW
    return {i: Place(x, float(tree.nodes["depth"][i]) + (0.5 if half[i] else 0.0)) for i, x in root.offsets.items()}


def _join(tree: RayTree, i: int, children: list[int], subtrees: dict[int, _Subtree]) -> _Subtree:
    """The subtree of row i from those of its children, which are used up."""
    kinds = tree.nodes["kind"]
    half_width = 0.5 * (STUB_WIDTH if kinds[i] == SHADOW else RAY_WIDTH)
    ordered = sorted(children, key=lambda child: (_rank(kinds[child]), child))
    # Each is pushed right of those before it, as far as their outlines demand.
    shifts: list[float] = []
    left: list[float] = []
    right: list[float] = []
    for child in ordered:
        sub = subtrees[child]
        down = 1 if kinds[child] == SHADOW else 2
        shift = 0.0
        for level, reach in enumerate(sub.left):
            if level + down < len(right) and right[level + down] > -1e9:
                shift = max(shift, right[level + down] - reach)
        # Neighbours of one parent keep apart even where one hangs half a level lower.
        if shifts:
            shift = max(shift, shifts[-1] + 0.5 * STUB_WIDTH)
        shifts.append(shift)
        for level, (low, high) in enumerate(zip(sub.left, sub.right, strict=True)):
            at = level + down
            while len(left) <= at:
                left.append(1e9)
                right.append(-1e9)
            left[at], right[at] = min(left[at], low + shift), max(right[at], high + shift)
    middle = 0.5 * (shifts[0] + shifts[-1]) if shifts else 0.0
    offsets = {i: 0.0}
    for child, shift in zip(ordered, shifts, strict=True):
        for row, x in subtrees.pop(child).offsets.items():
            offsets[row] = x + shift - middle
    reach_left = [-half_width, *(x - middle for x in left[1:])]
    reach_right = [half_width, *(x - middle for x in right[1:])]
    return _Subtree(offsets, reach_left, reach_right)


def _rank(kind: int) -> int:
    """Reflected, then the lights, then refracted, from left to right."""
    return 2 if kind == REFRACTION else 1 if kind == SHADOW else 0


def heaviest_rows(tree: RayTree, most: int, rows: set[int]) -> set[int]:
    """At most about `most` of these rows: the heaviest rays with their shadow rays. A child is never heavier than its
    parent, so every row that is kept keeps its parent."""
    if len(rows) <= most:
        return rows
    weights = tree.nodes["weight"].max(axis=1)
    rays = sorted((i for i in rows if tree.nodes["kind"][i] != SHADOW), key=lambda i: (-weights[i], i))
    kept: set[int] = set()
    for i in rays:
        shadows = {child for child in tree.children[i] if child in rows and tree.nodes["kind"][child] == SHADOW}
        if kept and len(kept) + 1 + len(shadows) > most:
            break
        kept |= {i} | shadows
    return kept

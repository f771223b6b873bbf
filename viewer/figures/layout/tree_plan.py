"""The layout of a tree figure, computed once for the deepest tree, so that nothing moves from step to step.

Each hit is a box, and all boxes have one size, so that equal subtrees look the same. Reflected rays leave at a box's
left side, refracted ones at its right, and stubs to the lights hang below: no lines cross. With the eye at the left,
all rays leave at the right side, reflected ones upwards. If the tree does not fit, the lightest branches are folded
into boxes that give their number of rays and weight.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.figures.layout.folds import Fold, fold_branches
from viewer.figures.layout.light_line import NO_LINE, SIGNS, WORDS
from viewer.figures.layout.placing import (
    LayoutTask,
    Places,
    levels_down,
    levels_right,
    place_downwards,
    place_rightwards,
)
from viewer.figures.layout.sizes import EDGE_LABEL, FOLD, SHORT, SMALLEST, STUB, Sizes, TreeStyle, name_in_box
from viewer.figures.lights import many_lights
from viewer.figures.marks import Point

MORE = 40  # if the whole tree does not fit, this many of the other rays are tried one by one, the heaviest first


@dataclass(frozen=True)
class TreePlan:
    """Positions in points. `rows` are drawn as themselves; `inside` gives the fold of the others, apart from the shadow
    rays for which a line stands.
    """

    tree: RayTree  # the deepest
    style: TreeStyle
    rows: frozenset[int]
    folds: dict[int, Fold]  # by the row in whose place they stand
    inside: dict[int, int]  # a folded row -> the row of its fold
    places: Places
    box: tuple[float, float]
    fits: bool  # on its part of the canvas
    lights_left_out: bool = False  # for want of room

    @property
    def size(self) -> float:
        return self.style.size

    @property
    def at(self) -> dict[int, Point]:
        """Centres of boxes, and of the signs at the ends of stubs."""
        return self.places.at

    @property
    def hang(self) -> float:
        """From a box's middle down to the signs below it."""
        return 0.5 * self.box[1] + STUB * self.size

    @property
    def fold_height(self) -> float:
        return FOLD * self.size

    @property
    def top(self) -> float:
        """From a box's middle up to the label of its ray."""
        return 0.5 * self.box[1] + EDGE_LABEL * self.size

    def name(self, i: int) -> str:
        return name_in_box(self.tree, i, self.style.longest)


def plan_tree(trees: Sequence[RayTree], style: TreeStyle) -> TreePlan:
    """The plan for these steps of one tree, the deepest last. If text is so large that not even the first hit fits, it
    is smaller.
    """
    plan = _plan_lights(trees, style)
    while not plan.fits and plan.size > SMALLEST:
        plan = _plan_lights(trees, replace(style, size=max(SMALLEST, math.ceil(plan.size) - 1.0)))
    return plan


def _plan_lights(trees: Sequence[RayTree], style: TreeStyle) -> TreePlan:
    """The plan for a text size. No ray is folded for the lines that stand for many shadow rays: if their words do not
    fit, they have signs, and if these do not, they are left out.
    """
    if style.line == NO_LINE or not many_lights(trees[-1]):
        return _named(trees, style)
    bare = _named(trees, replace(style, line=NO_LINE))
    for form in (WORDS, SIGNS):
        plan = _named(trees, replace(style, line=form))
        if plan.fits and len(plan.rows) >= len(bare.rows):
            return plan
    return replace(bare, lights_left_out=True)


def _named(trees: Sequence[RayTree], style: TreeStyle) -> TreePlan:
    """The plan in which names of lights are left to the legend, and names of objects cut, if more rays fit then."""
    best = _plan(trees, style)
    for shorter in (replace(style, named=False), replace(style, named=False, longest=SHORT)):
        if best.fits and not best.folds:
            break
        found = _plan(trees, shorter)
        if (found.fits, len(found.rows)) > (best.fits, len(best.rows)):
            best = found
    return best


def fitting_size(trees: Sequence[RayTree], style: TreeStyle) -> float | None:
    """The largest text size, in whole points, with which all rays fit; None if no size does."""
    rays = {i for i in range(len(trees[-1])) if trees[-1].nodes["kind"][i] != SHADOW}
    deepest = int(trees[-1].nodes["depth"].max())
    for size in range(int(style.size), int(SMALLEST) - 1, -1):
        asked = replace(style, size=float(size), longest=SHORT, named=False, line=NO_LINE)
        if deepest <= _last_level(trees, asked) and _try(trees, rays, asked, deepest):
            return float(size)
    return None


def _plan(trees: Sequence[RayTree], style: TreeStyle) -> TreePlan:
    """The plan with as many levels as possible, or with one less if that shows more of the weight."""
    last = _last_level(trees, style)
    weights = trees[-1].nodes["weight"].max(axis=1)
    hits = trees[-1].nodes["kind"] != SHADOW
    plans = [_plan_of(trees, style, levels) for levels in range(last, max(last - 2, -1), -1)]
    return max(plans, key=lambda plan: float(sum(weights[i] for i in sorted(plan.rows) if hits[i])))


def _plan_of(trees: Sequence[RayTree], style: TreeStyle, last: int) -> TreePlan:
    tree = trees[-1]
    weights, kinds = tree.nodes["weight"].max(axis=1), tree.nodes["kind"]
    rays = [i for i in range(len(tree)) if kinds[i] != SHADOW and (weights[i] >= style.fold or i == 0)]
    rays = {i for i in rays if tree.nodes["depth"][i] <= last}
    heaviest = sorted(rays, key=lambda i: (-weights[i], i))
    low, high = 0, len(heaviest)
    best = _try(trees, set(heaviest), style, last)
    if best is not None:
        low = high
    while low + 1 < high:  # bisection for the most rays that fit: `low` do, `high` do not
        middle = (low + high) // 2
        found = _try(trees, set(heaviest[:middle]), style, last)
        if found is None:
            high = middle
        else:
            low, best = middle, found
    if best is None:  # even the first hit alone is too large: draw it all the same
        return _try(trees, {0}, style, 0, anyhow=True)  # type: ignore[return-value]
    kept = set(heaviest[:low])
    # A branch of one ray takes no more room as itself than as a fold. If one does not fit, a lighter one may.
    single = sorted(r for fold in best.folds.values() for r in fold.roots if not tree.children[r] and r in rays)
    parents = tree.nodes["parent"]
    for i in (*single, *heaviest[low : low + MORE]):
        if i not in kept and int(parents[i]) in kept:
            found = _try(trees, kept | {i}, style, last)
            if found is not None:
                best = found
                kept.add(i)
    return best


def _last_level(trees: Sequence[RayTree], style: TreeStyle) -> int:
    """The level below which there are no boxes."""
    deepest = int(trees[-1].nodes["depth"].max())
    if style.eye == "left":
        return levels_right(Sizes.of(trees, range(len(trees[-1])), {}, {}, style), style.size, style.where)
    whole = levels_down(style.size, hung=False)
    return whole if deepest <= whole else max(0, levels_down(style.size, hung=True))


def _try(
    trees: Sequence[RayTree], kept: set[int], style: TreeStyle, last: int, anyhow: bool = False
) -> TreePlan | None:
    """The plan with these rays, and all others folded; None if it does not fit."""
    rows, folds, inside = fold_branches(trees[-1], kept, last, style.lights)
    sizes = Sizes.of(trees, rows, folds, inside, style)
    boxes = {row for row, fold in folds.items() if fold.under is None}
    task = LayoutTask(trees[-1], rows, boxes, sizes, style.size, style.where, hung=len(boxes) < len(folds))
    places = (place_rightwards if style.eye == "left" else place_downwards)(task, anyhow)
    if places is None:
        return None
    return TreePlan(trees[-1], style, frozenset(rows), folds, inside, places, (sizes.column, sizes.box), not anyhow)

"""The layout of a tree figure, computed once for the deepest tree, so that nothing moves from step to step.

Each hit is a box, and all boxes have one size, so that equal subtrees look the same. Reflected rays leave at a box's
left side, refracted ones at its right, and stubs to the lights hang below: no lines cross. With the eye at the left,
all rays leave at the right side, reflected ones upwards. If the tree does not fit, it becomes compact: the signs of
shadow rays stand in the boxes. If that does not fit either, the lightest branches are folded into boxes that give
their number of rays and weight. In a place that is narrow and high, the tree may become an outline.
"""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.figures.labels import hit_label
from viewer.figures.layout.folds import Fold, fold_branches
from viewer.figures.layout.light_line import NO_LINE, SIGNS, WORDS
from viewer.figures.layout.outline import PITCH, place_as_outline
from viewer.figures.layout.places import LayoutTask, Places
from viewer.figures.layout.placing import (
    levels_down,
    levels_right,
    place_downwards,
    place_rightwards,
)
from viewer.figures.layout.planned_rays import PlannedRays
from viewer.figures.layout.sizes import (
    BOX,
    EDGE_LABEL,
    FOLD,
    OUTLINE,
    PADDING,
    SHORT,
    SMALLEST,
    STUB,
    HitSizes,
    RaySizes,
    Sizes,
    TreeStyle,
    name_in_box,
)
from viewer.figures.lights import many_lights
from viewer.figures.marks import Point

MORE = 40  # if the whole tree does not fit, this many of the other rays are tried one by one, the heaviest first,
VAIN = 4  # until so many in turn do not fit
NARROW = 1.3  # width over height of a place in which the tree may be an outline


@dataclass(frozen=True)
class TreePlan:
    """Positions in points. `rows` are drawn as themselves. The others are folded, apart from the shadow rays for which
    a line stands.
    """

    tree: RayTree  # the deepest
    style: TreeStyle
    rows: frozenset[int]
    folds: dict[int, Fold]  # by the row in whose place they stand
    places: Places
    box: tuple[float, float]
    label: float  # width of the widest label of a ray
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
    def seen(self) -> tuple[bool, int, bool]:
        """A measure of how much is seen, to choose between plans."""
        hits = sum(self.tree.nodes["kind"][i] != SHADOW for i in self.rows)
        return (self.fits, hits, not self.lights_left_out)

    @property
    def shows_rays(self) -> bool:
        """Whether it shows more than the first hit, or there is no more."""
        nodes = self.tree.nodes
        sent = np.flatnonzero((nodes["parent"] == 0) & (nodes["kind"] != SHADOW)).tolist()
        return not self.rows.isdisjoint(sent) or all(nodes["weight"][i].max() < self.style.fold for i in sent)

    @property
    def hang(self) -> float:
        """From a box's middle down to the signs below it."""
        return 0.5 * self.box[1] + STUB * self.size

    @property
    def fold_height(self) -> float:
        return (BOX if self.style.eye == OUTLINE else FOLD) * self.size

    @property
    def top(self) -> float:
        """From a box's middle up to the label of its ray."""
        return 0.5 * self.box[1] + EDGE_LABEL * self.size

    def folded(self, rows: Iterable[int]) -> Counter[int]:
        """The number of these rows in each fold, by its row."""
        fold_of = {root: row for row, fold in self.folds.items() for root in fold.roots}
        parents = self.tree.nodes["parent"].tolist()
        for i in sorted(rows) if fold_of else ():  # parents come before their children
            if parents[i] in fold_of:
                fold_of.setdefault(i, fold_of[parents[i]])
        return Counter(fold_of[i] for i in rows if i in fold_of)

    def name(self, i: int) -> str:
        return name_in_box(self.tree, i, self.style.longest)


def plan_tree(rays: PlannedRays, style: TreeStyle) -> TreePlan:
    """The plan for a tree. If text is so large that not even the first hit fits, or no ray that it sends out, it is
    smaller.
    """
    sizes = RaySizes(rays)
    asked = plan = _plan_forms(sizes, style)
    while not (plan.fits and plan.shows_rays) and plan.size > SMALLEST:
        plan = _plan_forms(sizes, replace(style, size=max(SMALLEST, math.ceil(plan.size) - 1.0)))
    return plan if plan.shows_rays or not asked.fits else asked


def _plan_forms(sizes: RaySizes, style: TreeStyle) -> TreePlan:
    """The plan for a text size: with stubs to the lights, or compact if more is seen then."""
    rays = sizes.rays
    low = replace(style, compact=True, named=False, line=SIGNS if style.lights else NO_LINE)
    plans = []
    if style.eye != "top" or _levels(rays, style) >= _levels(rays, low):  # otherwise it shows fewer levels
        plan = _plan_lights(sizes, style)
        if plan.fits and not plan.folds and not plan.lights_left_out:
            return plan
        plans.append(plan)
    plans.append(_named(sizes, low))
    if style.lights and many_lights(rays.tree):
        bare = _named(sizes, replace(low, lights=0, line=NO_LINE))
        plans.append(replace(bare, lights_left_out=True))
    left, top, right, bottom = style.where
    too_deep = _levels(rays, low) < rays.deepest
    if style.eye == "top" and (too_deep or right - left < NARROW * (bottom - top)):
        plans.append(_named(sizes, replace(low, eye=OUTLINE)))
    return max(plans, key=lambda plan: plan.seen)


def _levels(rays: PlannedRays, style: TreeStyle) -> int:
    """The number of the tree's levels for which there is room."""
    return min(levels_down(style, hung=False), rays.deepest)


def _plan_lights(sizes: RaySizes, style: TreeStyle) -> TreePlan:
    """The plan for a text size. No ray is folded for the lines that stand for many shadow rays: if their words do not
    fit, they have signs, and if these do not, they are left out.
    """
    if style.line == NO_LINE or not many_lights(sizes.rays.tree):
        return _named(sizes, style)
    bare = _named(sizes, replace(style, line=NO_LINE))
    for form in (WORDS, SIGNS):
        plan = _named(sizes, replace(style, line=form))
        if plan.fits and len(plan.rows) >= len(bare.rows):
            return plan
    return replace(bare, lights_left_out=True)


def _named(sizes: RaySizes, style: TreeStyle) -> TreePlan:
    """The plan in which names of lights are left to the legend, and names of objects cut, if more rays fit then."""
    best, tree = _plan(sizes, style), sizes.rays.tree
    shorter = [replace(style, named=False)] if style.named and style.lights else []
    _, met = np.unique(tree.nodes["object"], return_index=True)  # one row for each object
    if any(len(hit_label(tree, int(i))) > SHORT for i in met):
        shorter.append(replace(style, named=False, longest=SHORT))
    for asked in shorter:
        if best.fits and not best.folds:
            break
        found = _plan(sizes, asked)
        if (found.fits, len(found.rows)) > (best.fits, len(best.rows)):
            best = found
    return best


def fitting_size(rays: PlannedRays, style: TreeStyle) -> float | None:
    """The largest text size, in whole points, with which all rays fit; None if no size does."""
    hits = {i for i in rays.rows if not rays.is_shadow[i]}
    sizes = RaySizes(rays)
    for size in range(int(style.size), int(SMALLEST) - 1, -1):
        for compact in (False, True):
            asked = replace(style, size=float(size), longest=SHORT, named=False, line=NO_LINE, compact=compact)
            measured = sizes.in_style(asked)
            if rays.deepest <= _last_level(measured) and _try(measured, hits, rays.deepest):
                return float(size)
    return None


def _plan(sizes: RaySizes, style: TreeStyle) -> TreePlan:
    """The plan with as many levels as possible, or with one less if that shows more of the weight."""
    measured, rays = sizes.in_style(style), sizes.rays
    last = _last_level(measured)
    count = 1 if last > rays.deepest else 2  # below the deepest level, one less changes nothing
    plans = [_plan_of(measured, levels) for levels in range(last, max(last - count, -1), -1)]
    return max(plans, key=lambda plan: sum(rays.weights[i] for i in sorted(plan.rows) if not rays.is_shadow[i]))


def _plan_of(measured: HitSizes, last: int) -> TreePlan:
    """The plan with the most of the heaviest rays that fit above and on a level."""
    rays = measured.rays
    heaviest = _heaviest(measured, last)
    low, high = 0, len(heaviest)
    best = _try(measured, set(heaviest), last)
    if best is not None:
        return best
    while low + 1 < high:  # bisection for the most rays that fit: `low` do, `high` do not
        middle = (low + high) // 2
        found = _try(measured, set(heaviest[:middle]), last)
        if found is None:
            high = middle
        else:
            low, best = middle, found
    if best is None:  # even the first hit alone is too large: draw it all the same
        return _try(measured, {0}, 0, anyhow=True)  # type: ignore[return-value]
    kept = set(heaviest[:low])
    # A branch of one ray takes no more room as itself than as a fold. If one does not fit, a lighter one may.
    single = sorted(
        r
        for fold in best.folds.values()
        for r in fold.roots
        if r not in rays.rays and r not in rays.shadow_rays and r in heaviest
    )
    failed = 0
    for i in (*single, *heaviest[low : low + MORE]):
        if i not in kept and rays.parents[i] in kept and failed < VAIN:
            found = _try(measured, kept | {i}, last)
            if found is None:
                failed += 1
            else:
                best, failed = found, 0
                kept.add(i)
    return best


def _heaviest(measured: HitSizes, last: int) -> list[int]:
    """The rays down to a level that the style does not fold, the heaviest first."""
    rays, least = measured.rays, measured.style.fold
    depths, weights, always = rays.depths, rays.weights, rays.first | {0}
    return [i for i in rays.heaviest if depths[i] <= last and (weights[i] >= least or i in always)]


def _last_level(measured: HitSizes) -> int:
    """The level below which there are no boxes."""
    style, deepest = measured.style, measured.rays.deepest
    if style.eye == "left":
        return levels_right(Sizes.of(measured, measured.rays.rows, {}), style)
    if style.eye == OUTLINE:
        return deepest + 1  # no fold hangs under a hit
    whole = levels_down(style, hung=False)
    return whole if deepest <= whole else max(0, levels_down(style, hung=True))


PLACINGS = {"top": place_downwards, "left": place_rightwards, OUTLINE: place_as_outline}


def _too_many(rays: PlannedRays, boxes: set[int], style: TreeStyle) -> bool:
    """Whether there is no room for so many boxes, however short the text in them is."""
    size, (left, top, right, bottom) = style.size, style.where
    if style.eye == OUTLINE:
        return (len(boxes) - 1) * PITCH * size > bottom - top
    most = max(Counter(rays.depths[i] for i in boxes).values())  # on one level
    return most * BOX * size > bottom - top if style.eye == "left" else most * 2.0 * PADDING * size > right - left


def _try(measured: HitSizes, kept: set[int], last: int, anyhow: bool = False) -> TreePlan | None:
    """The plan with these rays, and all others folded; None if it does not fit."""
    tree, style = measured.tree, measured.style
    if _too_many(measured.rays, kept, style) and not anyhow:  # most attempts end here, before anything is measured
        return None
    rows, folds = fold_branches(measured.rays, kept, last, style.lights)
    boxes = {row for row, fold in folds.items() if fold.under is None}
    if _too_many(measured.rays, kept | boxes, style) and not anyhow:
        return None
    sizes = Sizes.of(measured, rows, folds)
    task = LayoutTask(measured.rays, rows, boxes, sizes, style, hung=len(boxes) < len(folds))
    places = PLACINGS[style.eye](task, anyhow)
    if places is None:
        return None
    return TreePlan(tree, style, frozenset(rows), folds, places, (sizes.column, sizes.box), sizes.label, not anyhow)

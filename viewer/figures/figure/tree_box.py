"""The boxes of a tree figure: the hits, and the folded branches."""

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.srgb import LUMINANCE, display_color
from viewer.base.theme import Color, Theme
from viewer.figures import signs
from viewer.figures.font import text_width
from viewer.figures.labels import end_label, hit_label, ray_label, ray_title
from viewer.figures.layout.folds import Fold
from viewer.figures.layout.light_line import SIGN, box_signs, signs_width
from viewer.figures.layout.sizes import BARE_NOTE, CUT, LINE, NOTE, OUTLINE, PADDING, SWATCH
from viewer.figures.layout.tree_plan import TreePlan
from viewer.figures.lights import shadow_rays
from viewer.figures.marks import Box, Disc, Mark, Point, Stroke, Text
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle

ROUND = 0.28  # radius of a box's corners, in text sizes


def hit_box(plan: TreePlan, step: Step, i: int, style: FigureStyle) -> list[Mark]:
    """The box of hit i, with the name of the object, and the signs or the note of its end."""
    tree, theme, size = step.tree, style.theme, plan.size
    name, (x, y), (wide, _) = f"hit-{i}", plan.at[i], plan.box
    words = hit_label(tree, i)
    fill = plan.style.swatches and i in step.summed
    left, taken = x - 0.5 * wide + PADDING * size, SWATCH * size * plan.style.swatches
    if not plan.style.compact:  # name and colour stand in the middle
        left = x - 0.5 * (taken + text_width(plan.name(i), size))
    marks: list[Mark] = [
        Box(name, (x, y), plan.box, ROUND * size, theme.panel, _outline(tree, i, step, style),
            title=f"{words}, met by {ray_label(tree, i)}"),
    ]  # fmt: skip
    if fill:
        at = (left + 0.5 * SWATCH * size, y)
        marks.append(Disc(name, at, 0.5 * size, swatch(tree, i, theme), Stroke(theme.text, 1.0)))
    if plan.style.compact:
        marks.append(Text(name, (left + taken, y), plan.name(i), size, theme.text, "start", inside=name))
        return marks + _signs(plan, step, i, style)
    marks.append(Text(name, (x + 0.5 * taken, y), plan.name(i), size, theme.text, inside=name))
    note = end_label(tree, i)
    if note and _is_leaf(tree, i):
        marks.append(Text(name, _under(plan, i), note, size, theme.muted))
    return marks


def _outline(tree: RayTree, i: int, step: Step, style: FigureStyle) -> Stroke:
    theme = style.theme
    if i == style.selected:
        return Stroke(theme.accent, 2.6)
    if tree.end(i) == "background":
        return Stroke(theme.muted, 1.4, (3.0, 3.0))
    return Stroke(theme.text, 2.6 if i in step.current else 1.4)


def _is_leaf(tree: RayTree, i: int) -> bool:
    """Whether no ray follows at hit i but shadow rays."""
    return all(tree.nodes["kind"][c] == SHADOW for c in tree.children[i])


def _signs(plan: TreePlan, step: Step, i: int, style: FigureStyle) -> list[Mark]:
    """In a compact box, at its right end: the signs of the shadow rays, and of rays that were cut."""
    tree, theme, size = step.tree, style.theme, plan.size
    (x, y), (wide, _) = plan.at[i], plan.box
    right = x + 0.5 * wide - PADDING * size
    marks: list[Mark] = []
    note = end_label(tree, i)
    if note.startswith("cut") and _is_leaf(tree, i):
        marks += signs.cut(f"hit-{i}", (right - 0.5 * CUT * size, y), size, theme.muted, note)
    right -= CUT * size  # also without it, so that no sign moves with the depth
    if not plan.style.lights:
        return marks
    left = right - signs_width(tree, i, True, size)
    for part, row in box_signs(tree, i, size):
        if row is not None and row not in step.rows:
            continue
        name = f"lights-{i}" if row is None else f"ray-{row}"
        at = (left + part.left + 0.45 * size, y)
        marks += signs.light_end(part.sign, name, at, size, theme, "" if row is None else ray_title(tree, row))
        if row is not None and (row in step.current or row == style.selected):
            marks.append(Disc(name, at, 0.62 * size, None, Stroke(theme.accent, 1.8)))
        if part.text:
            place = (at[0] + (SIGN - 0.45) * size, y)
            marks.append(Text(name, place, part.text, size, theme.ray("shadow"), "start", inside=f"hit-{i}"))
    return marks


def _under(plan: TreePlan, i: int) -> Point:
    """The middle of the first line under a box and its stubs."""
    x, y = plan.at[i]
    hanging = i in plan.places.lines or i in plan.places.bars or any(c in plan.rows for c in shadow_rays(plan.tree, i))
    bare = 0.5 * plan.box[1] + BARE_NOTE * plan.size
    return (x, y + (plan.hang + NOTE * plan.size if hanging and not plan.style.compact else bare))


def fold_box(plan: TreePlan, fold: Fold, count: int, theme: Theme) -> list[Mark]:
    """A folded branch of so many rays: their number and weight, in its own box or under the hit."""
    name, size = f"fold-{fold.row}", plan.size
    lines = fold.words(count, plan.style.eye == OUTLINE)
    title = f"{' not drawn, '.join(fold.words(count))} of the weight"
    if fold.under is not None:
        x, y = _under(plan, fold.under)
        return [
            Text(name, (x, y + k * LINE * size), words, size, theme.muted, title=title) for k, words in enumerate(lines)
        ]
    x, y = plan.at[fold.row]
    stroke = Stroke(theme.muted, 1.4, (3.0, 3.0))
    box = Box(name, (x, y), (plan.box[0], plan.fold_height), ROUND * size, None, stroke, title=title)
    words = [
        Text(name, (x, y + (1.2 * k - 0.6 * (len(lines) - 1)) * size), words, size, theme.muted, inside=name)
        for k, words in enumerate(lines)
    ]
    return [box, *words]


def swatch(tree: RayTree, i: int, theme: Theme) -> Color:
    """The radiance of ray i as a colour; in black and white, a grey of the same luminance."""
    light = tree.nodes["radiance"][i]
    if theme.mono:
        light = np.full(3, light @ LUMINANCE)
    return display_color(light)

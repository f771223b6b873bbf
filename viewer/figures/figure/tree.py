"""The ray tree, as in Whitted's figure (CACM 23(6), 1980).

The eye is at the top, reflected rays go left and refracted ones right, and dashed stubs lead to the lights. An edge
has the ray's factor, a box the object that was hit. With the eye at the left, reflected rays go up and refracted
ones down.
"""

from collections.abc import Sequence

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.srgb import LUMINANCE, display_color
from viewer.base.theme import STYLES, Color, Theme
from viewer.figures import signs
from viewer.figures.font import text_width
from viewer.figures.labels import end_label, hit_label, ray_label, ray_title
from viewer.figures.layout.folds import Fold
from viewer.figures.layout.light_line import NO_LINE, SIGN, WORDS, LightLine
from viewer.figures.layout.sizes import (
    BARE_NOTE,
    LINE,
    MARGIN,
    NO_RAY,
    NOTE,
    PADDING,
    SWATCH,
    TreeStyle,
    edge_label,
    stub_label,
)
from viewer.figures.layout.sum_block import SumBlock, with_sum
from viewer.figures.layout.tree_legend import tree_entries
from viewer.figures.layout.tree_plan import TreePlan, plan_tree
from viewer.figures.legend import legend
from viewer.figures.lights import (
    MOST_LIGHTS,
    fate_of,
    light_title,
    ray_dash,
    shadow_rays,
)
from viewer.figures.marks import HEIGHT, WIDTH, Box, Disc, Line, Mark, Point, Rectangle, Stroke, Text
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Pages, Subject

WHERE = (0.0, WIDTH)  # left and right of the tree on the canvas


def pages(
    subject: Subject, style: FigureStyle, where: tuple[float, float] = WHERE, beside: Pages | None = None
) -> Pages:
    """The ray tree. No box moves from step to step. `beside` are the marks of each page on the rest of the canvas."""
    plan = plan_tree([step.tree for step in subject.steps], tree_style(style, where))
    return plan_pages(plan, subject.steps, style.theme, beside)


def tree_style(style: FigureStyle, where: tuple[float, float] = WHERE) -> TreeStyle:
    """The part of a figure's style that decides on the tree's layout."""
    lights, line = (MOST_LIGHTS, WORDS) if style.lights else (0, NO_LINE)
    return TreeStyle(style.text_size, style.swatches, style.fold, where, style.eye, lights, line)


def plan_pages(plan: TreePlan, steps: Sequence[Step], theme: Theme, beside: Pages | None = None) -> Pages:
    """One page for each step, with those rows of the plan that the step has. The legend stands where there are no
    marks. `beside` are the marks of each page on the rest of the canvas.
    """
    drawings = [_Drawing(plan, step, theme) for step in steps]
    drawn = [drawing.marks for drawing in drawings]
    left, right = plan.style.where
    margin = MARGIN * plan.size
    where: Rectangle = (left + margin, margin, right - margin, HEIGHT - margin)
    signs_meant = legend(tree_entries(plan), [mark for marks in drawn for mark in marks], where, plan.size, theme)
    return [drawing.page(signs_meant, where, beside[k] if beside else None) for k, drawing in enumerate(drawings)]


class _Drawing:
    def __init__(self, plan: TreePlan, step: Step, theme: Theme) -> None:
        self.plan, self.step, self.theme = plan, step, theme
        self.tree: RayTree = step.tree
        self.size = plan.size
        self.sideways = plan.style.eye == "left"
        self.marks: list[Mark] = []
        rows = sorted(plan.rows & step.rows)
        hits = [i for i in rows if self.tree.nodes["kind"][i] != SHADOW]
        folds = [fold for row, fold in sorted(plan.folds.items()) if row in step.rows]
        self.marks += signs.eye(plan.places.eye, self.size, theme)
        for i in rows:
            self._stub(i) if self.tree.nodes["kind"][i] == SHADOW else self._edge(i)
        for fold in folds:
            if fold.under is None:
                self._fold_edge(fold.row)
        for i in hits:
            self._bar(i)
            self._light_line(i)
            self._box(i)
        for fold in folds:
            self._fold(fold)

    def page(self, signs_meant: list[Mark], where: Rectangle, beside: Sequence[Mark] | None) -> list[Mark]:
        """The marks with the legend, and with the sum of the hit that the step sums up."""
        hit = self.step.sum
        if hit is None or hit not in self.plan.rows:
            return [*signs_meant, *self.marks]
        (x, y), (w, h) = self.plan.at[hit], self.plan.box
        box = (x - 0.5 * w, y - 0.5 * h, x + 0.5 * w, y + 0.5 * h)
        return with_sum(SumBlock(self.tree, hit, box, self.size, self.theme), self.marks, signs_meant, where, beside)

    # --- rays ---------------------------------------------------------------------------------------------------------

    def _leave(self, i: int) -> tuple[Point, str]:
        """The start of the edge to hit i, and the mark that it leaves."""
        parent = int(self.tree.nodes["parent"][i])
        if parent < 0:
            x, y = self.plan.places.eye
            return ((x + self.size, y) if self.sideways else (x, y + 0.55 * self.size)), "eye"
        x, y = self.plan.at[parent]
        side = 0.5 * self.plan.box[0]
        to_left = self.plan.at[i][0] < x
        return (x - side if to_left else x + side, y), f"hit-{parent}"

    def _reach(self, i: int, height: float) -> Point:
        """The end of the edge to the box of height `height` at i."""
        x, y = self.plan.at[i]
        return (x - 0.5 * self.plan.box[0], y) if self.sideways else (x, y - 0.5 * height)

    def _edge(self, i: int) -> None:
        kind = self.tree.kind(i)
        style, color = STYLES[kind], self.theme.ray(kind)
        start, leaves = self._leave(i)
        end = self._reach(i, self.plan.box[1])
        strong = 1.8 if i in self.step.current else 1.0
        label = self._edge_label(i, start, end, color)
        line = Line(
            f"ray-{i}",
            start,
            end,
            Stroke(color, strong * style.width, ray_dash(self.tree, i)),
            style.arrow,
            0.5,
            leaves,
            f"hit-{i}",
            label.box() if label.on_line else None,
            title=ray_title(self.tree, i),
        )
        self.marks += [line, label]

    def _edge_label(self, i: int, start: Point, end: Point, color: Color) -> Text:
        """The factor, above the box where it interrupts the edge. The first ray is straight, and has its label beside
        it.
        """
        name, content = f"ray-{i}", edge_label(self.tree, i)
        x, y = self.plan.at[i]
        if i and self.sideways:
            return Text(name, (x, y - self.plan.top), content, self.size, color)
        if i:
            return Text(name, (x, y - self.plan.top), content, self.size, color, on_line=True)
        if self.sideways:
            return Text(name, (0.5 * (start[0] + end[0]), y - self.size), content, self.size, color)
        return Text(name, (x + 0.5 * self.size, y - self.plan.top), content, self.size, color, "start")

    def _stub(self, i: int) -> None:
        """A stub to a light. The sign at its end says what becomes of the ray."""
        name, tree = f"ray-{i}", self.tree
        parent = int(tree.nodes["parent"][i])
        x, y = self.plan.at[parent]
        at = self.plan.at[i]
        fate = fate_of(tree, i)
        color = self.theme.ray("shadow")
        label = stub_label(tree, i, self.plan.style)
        sign, text = self._side_by_side(at, label)
        start = (x + 0.6 * (sign[0] - x), y + 0.5 * self.plan.box[1])
        stop = (sign[0], at[1] - 0.5 * self.size)
        strong = 1.8 if i in self.step.current else 1.0
        self.marks.append(
            Line(
                name,
                start,
                stop,
                Stroke(color, strong * STYLES["shadow"].width, fate.dash),
                leaves=f"hit-{parent}",
                title=ray_title(tree, i),
            )
        )
        self.marks += signs.light_end(fate.name, name, sign, self.size, self.theme)
        self.marks.append(Text(name, text, label, self.size, color, "start"))

    def _side_by_side(self, at: Point, label: str) -> tuple[Point, Point]:
        """(centre of the sign, left end of its label): side by side, centred on the stub's place."""
        left = at[0] - 0.5 * (SIGN * self.size + text_width(label, self.size))
        return (left + 0.45 * self.size, at[1]), (left + SIGN * self.size, at[1])

    def _light_line(self, i: int) -> None:
        """A stub with the line that stands for the shadow rays of a hit, as far as the step has them."""
        middle = self.plan.places.lines.get(i)
        shadows = [c for c in shadow_rays(self.tree, i) if c in self.step.rows]
        if middle is None or not shadows:
            return
        name, (x, y), size = f"lights-{i}", middle, self.size
        top = self.plan.at[i][1] + 0.5 * self.plan.box[1]
        strong = 1.8 if self.step.current & set(shadows) else 1.0
        stroke = Stroke(self.theme.ray("shadow"), strong * STYLES["shadow"].width, STYLES["shadow"].dash)
        title = light_title(self.tree, shadows)
        self.marks.append(Line(name, (x, top), (x, y - 0.5 * size), stroke, leaves=f"hit-{i}", title=title))
        line = LightLine.of(self.tree, shadows, self.plan.style.line, size)
        left = x - 0.5 * line.width
        for part in line.parts:
            at = left + part.left
            if part.sign:
                self.marks += signs.light_end(part.sign, name, (at + 0.45 * size, y), size, self.theme)
                at += SIGN * size
            self.marks.append(Text(name, (at, y), part.text, size, stroke.color, "start"))

    def _bar(self, i: int) -> None:
        """The refracted ray that does not exist because of total internal reflection."""
        at = self.plan.places.bars.get(i)
        if at is None or not any(c in self.step.rows for c in self.tree.children[i] if self.tree.kind(c) == "tir"):
            return
        x, y = self.plan.at[i]
        name, color = f"bar-{i}", self.theme.ray("refraction")
        sign, text = self._side_by_side(at, NO_RAY)
        start = (x + 0.6 * (sign[0] - x), y + 0.5 * self.plan.box[1])
        title = "total internal reflection: no ray is refracted"
        stop = (sign[0], at[1] - 0.15 * self.size)
        self.marks.append(Line(name, start, stop, Stroke(color, STYLES["refraction"].width), title=title))
        self.marks += signs.bar(name, stop, self.size, color)
        self.marks.append(Text(name, text, NO_RAY, self.size, color, "start"))

    # --- hits ---------------------------------------------------------------------------------------------------------

    def _box(self, i: int) -> None:
        name, at = f"hit-{i}", self.plan.at[i]
        background = self.tree.end(i) == "background"
        stroke = Stroke(self.theme.text, 2.6 if i in self.step.current else 1.4)
        if background:
            stroke = Stroke(self.theme.muted, 1.4, (3.0, 3.0))
        color = self.theme.text
        words = hit_label(self.tree, i)
        title = f"{words}, met by {ray_label(self.tree, i)}"
        self.marks.append(Box(name, at, self.plan.box, 0.28 * self.size, self.theme.panel, stroke, title=title))
        middle = at
        if self.plan.style.swatches:
            left = at[0] - 0.5 * self.plan.box[0] + (PADDING + 0.5 * SWATCH) * self.size
            if i in self.step.summed:
                fill = swatch(self.tree, i, self.theme)
                radius = 0.5 * self.size
                self.marks.append(Disc(name, (left, at[1]), radius, fill, Stroke(self.theme.text, 1.0)))
            middle = (at[0] + 0.5 * SWATCH * self.size, at[1])
        self.marks.append(Text(name, middle, self.plan.name(i), self.size, color, inside=name))
        self._note(i)

    def _note(self, i: int) -> None:
        """Write under a leaf the reason why no ray follows."""
        words = end_label(self.tree, i)
        if words and all(self.tree.nodes["kind"][c] == SHADOW for c in self.tree.children[i]):
            self.marks.append(Text(f"hit-{i}", self._under(i), words, self.size, self.theme.muted))

    def _under(self, i: int) -> Point:
        """The middle of the first line under a box and its stubs."""
        x, y = self.plan.at[i]
        hanging = (*shadow_rays(self.tree, i), i)
        stubs = (
            i in self.plan.places.lines or i in self.plan.places.bars or any(c in self.plan.rows for c in hanging[:-1])
        )
        bare = 0.5 * self.plan.box[1] + BARE_NOTE * self.size
        return (x, y + (self.plan.hang + NOTE * self.size if stubs else bare))

    # --- folded branches ----------------------------------------------------------------------------------------------

    def _fold_edge(self, row: int) -> None:
        start, leaves = self._leave(row)
        reach = self._reach(row, self.plan.fold_height)
        stroke = Stroke(self.theme.muted, 1.6, (2.0, 4.0))
        self.marks.append(Line(f"fold-{row}", start, reach, stroke, leaves=leaves, reaches=f"fold-{row}"))

    def _fold(self, fold: Fold) -> None:
        """Draw a folded branch: its number of rays and its weight, in its own box or under the hit."""
        name = f"fold-{fold.row}"
        many, share = fold.words(self.step.rows, self.plan.inside)
        if fold.under is not None:
            x, y = self._under(fold.under)
            for k, words in enumerate((many, share)):
                self.marks.append(Text(name, (x, y + k * LINE * self.size), words, self.size, self.theme.muted))
            return
        x, y = self.plan.at[fold.row]
        size = (self.plan.box[0], self.plan.fold_height)
        stroke = Stroke(self.theme.muted, 1.4, (3.0, 3.0))
        title = f"{many} not drawn, {share} of the weight"
        self.marks.append(Box(name, (x, y), size, 0.28 * self.size, None, stroke, title=title))
        for words, dy in ((many, -0.6), (share, 0.6)):
            self.marks.append(Text(name, (x, y + dy * self.size), words, self.size, self.theme.muted, inside=name))


def swatch(tree: RayTree, i: int, theme: Theme) -> Color:
    """The radiance of ray i as a colour; in black and white, a grey of the same luminance."""
    light = tree.nodes["radiance"][i]
    if theme.mono:
        light = np.full(3, light @ LUMINANCE)
    return display_color(light)

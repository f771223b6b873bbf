"""The ray tree, as in Whitted's figure (CACM 23(6), 1980).

The eye is at the top, reflected rays go left and refracted ones right, and dashed stubs lead to the lights. An edge
has the ray's factor, a box the object that was hit. With the eye at the left, reflected rays go up and refracted
ones down.
"""

from collections.abc import Sequence

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.theme import DIMMED, STYLES, Color, faded
from viewer.figures import signs
from viewer.figures.figure.tree_box import fold_box, hit_box
from viewer.figures.figure.tree_outline import outline_edge, outline_ray
from viewer.figures.font import text_width
from viewer.figures.labels import ray_title
from viewer.figures.layout.light_line import NO_LINE, SIGN, WORDS, LightLine
from viewer.figures.layout.planned_rays import PlannedRays
from viewer.figures.layout.sizes import MARGIN, NO_RAY, OUTLINE, TreeStyle, edge_label, stub_label
from viewer.figures.layout.sum_block import SumBlock, with_sum
from viewer.figures.layout.tree_legend import tree_entries
from viewer.figures.layout.tree_plan import TreePlan, plan_tree
from viewer.figures.legend import legend
from viewer.figures.lights import MOST_LIGHTS, fate_of, light_title, ray_dash, shadow_rays
from viewer.figures.marks import Line, Mark, Point, Rectangle, Stroke, Text, blended
from viewer.figures.ray_lines import ancestors, branch
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Pages, Subject

LEVEL = "depth {}"  # the name of a level
LEVEL_OPACITY = 0.35  # of its line
STRONG = 1.8  # factor of the width of the ray that is selected, or that a step adds
COMPACT_ARROW = 0.3  # of an edge's length, so that it is clear of the label
OF_A_ROW = ("ray", "hit", "lights", "bar", "fold")  # in names of marks, before the number of a row


def pages(subject: Subject, style: FigureStyle, where: Rectangle | None = None, beside: Pages | None = None) -> Pages:
    """The ray tree. No box moves from step to step. `beside` are the marks of each page on the rest of the canvas."""
    return plan_pages(plan_steps(subject.steps, style, where or style.canvas), subject.steps, style, beside)


def plan_steps(steps: Sequence[Step], style: FigureStyle, where: Rectangle) -> TreePlan:
    """The layout for these steps, the fullest last."""
    asked = tree_style(steps, style, where)
    plan = plan_tree(planned(steps), asked)
    if style.selected in (None, *plan.rows):
        return plan
    return plan_tree(planned(steps, style.selected), asked)


def planned(steps: Sequence[Step], first: int | None = None) -> PlannedRays:
    """The rays of these steps. That of row `first` is not folded, if it can be avoided."""
    tree = steps[-1].tree
    return PlannedRays(
        [step.tree for step in steps],
        steps[-1].rows,
        frozenset() if first is None else frozenset(ancestors(tree, first)) & steps[-1].rows,
    )


def tree_style(steps: Sequence[Step], style: FigureStyle, where: Rectangle) -> TreeStyle:
    """The part of a figure's style that decides on the tree's layout."""
    tree, rows = steps[-1].tree, steps[-1].rows
    lit = any(tree.nodes["kind"][i] == SHADOW for i in rows)
    lights, line = (MOST_LIGHTS, WORDS) if lit else (0, NO_LINE)
    aside = _levels_wide(style.text_size) if style.levels else 0.0
    return TreeStyle(style.text_size, style.swatches, style.fold, where, aside, style.eye, lights, line)


def _levels_wide(size: float) -> float:
    """The width of the names of levels, at the left."""
    return text_width(LEVEL.format(0), size) + MARGIN * size


def plan_pages(plan: TreePlan, steps: Sequence[Step], style: FigureStyle, beside: Pages | None = None) -> Pages:
    """One page for each step, with those rows of the plan that the step has. The legend stands where there are no
    marks. `beside` are the marks of each page on the rest of the canvas.
    """
    drawings = [_Drawing(plan, step, style) for step in steps]
    drawn = [mark for drawing in drawings for mark in drawing.marks]
    left, top, right, bottom = plan.style.where
    margin = MARGIN * plan.size
    where: Rectangle = (left + margin, top + margin, right - margin, bottom - margin)
    signs_meant = legend(tree_entries(plan), drawn, where, plan.size, style.theme) if style.legend else []
    return [drawing.page(signs_meant, where, beside[k] if beside else None) for k, drawing in enumerate(drawings)]


class _Drawing:
    def __init__(self, plan: TreePlan, step: Step, style: FigureStyle) -> None:
        self.plan, self.step, self.style, self.theme = plan, step, style, style.theme
        self.tree: RayTree = step.tree
        self.size = plan.size
        self.sideways = plan.style.eye == "left"
        self.strong = {*step.current, style.selected}
        self.marks: list[Mark] = []
        rows = sorted(plan.rows & step.rows)
        hits = [i for i in rows if self.tree.nodes["kind"][i] != SHADOW]
        folds = [fold for row, fold in sorted(plan.folds.items()) if row in step.rows]
        if style.levels and plan.style.eye == "top":
            self._levels(hits)
        self.marks += signs.eye(plan.places.eye, self.size, self.theme)
        for i in rows:
            if self.tree.nodes["kind"][i] != SHADOW:
                self._ray(i)
            elif not plan.style.compact:
                self._stub(i)
        for fold in folds:
            if fold.under is None:
                self._fold_edge(fold.row)
        for i in hits:
            self._bar(i)
            self._light_line(i)
            self.marks += hit_box(plan, step, i, style)
        counts = plan.folded(step.rows)
        for fold in folds:
            self.marks += fold_box(plan, fold, counts[fold.row], self.theme)
        if style.selected in step.rows:
            self._dim(rows)

    def page(self, signs_meant: list[Mark], where: Rectangle, beside: Sequence[Mark] | None) -> list[Mark]:
        """The marks with the legend, and with the sum of the hit that the step sums up."""
        hit = self.step.sum
        if hit is None or hit not in self.plan.rows:
            return [*signs_meant, *self.marks]
        (x, y), (w, h) = self.plan.at[hit], self.plan.box
        box = (x - 0.5 * w, y - 0.5 * h, x + 0.5 * w, y + 0.5 * h)
        forms = [self.marks]
        if self.plan.style.eye == OUTLINE:  # its labels stand where there is room; the sum names rays and factors
            forms.append([m for m in self.marks if not (isinstance(m, Text) and m.name.startswith("ray-"))])
        return with_sum(SumBlock(self.tree, hit, box, self.size, self.theme), forms, signs_meant, where, beside)

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

    def _ray(self, i: int) -> None:
        if self.plan.style.eye == OUTLINE:
            self.marks += outline_ray(self.plan, self.tree, i, self._stroke(i))
        else:
            self._edge(i)

    def _stroke(self, i: int) -> Stroke:
        """The line of ray i."""
        kind = self.tree.kind(i)
        width = STYLES[kind].width * (STRONG if i in self.strong else 1.0)
        return Stroke(self.theme.ray(kind), width, ray_dash(self.tree, i))

    def _edge(self, i: int) -> None:
        stroke, style = self._stroke(i), STYLES[self.tree.kind(i)]
        start, leaves = self._leave(i)
        end = self._reach(i, self.plan.box[1])
        label = self._edge_label(i, start, end, stroke.color)
        line = Line(
            f"ray-{i}",
            start,
            end,
            stroke,
            style.arrow,
            COMPACT_ARROW if self.plan.style.compact and i else 0.5,
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
        strong = STRONG if i in self.strong else 1.0
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
        strong = STRONG if self.step.current & set(shadows) else 1.0
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

    def _fold_edge(self, row: int) -> None:
        stroke = Stroke(self.theme.muted, 1.6, (2.0, 4.0))
        if self.plan.style.eye == OUTLINE:
            self.marks += outline_edge(self.plan, self.tree, row, f"fold-{row}", stroke)
            return
        start, leaves = self._leave(row)
        reach = self._reach(row, self.plan.fold_height)
        self.marks.append(Line(f"fold-{row}", start, reach, stroke, leaves=leaves, reaches=f"fold-{row}"))

    # --- all of it ----------------------------------------------------------------------------------------------------

    def _levels(self, hits: Sequence[int]) -> None:
        """The depths of the rays on show, as faint lines with their numbers, behind everything."""
        left, _, right, _ = self.plan.style.where
        left += _levels_wide(self.size)
        deepest = max(int(self.tree.nodes["depth"][i]) for i in hits)
        rows = {int(self.tree.nodes["depth"][i]): self.plan.at[i][1] for i in hits}
        ink = faded(self.theme.muted, LEVEL_OPACITY)
        for depth in range(deepest + 1):
            name, y = f"level-{depth}", rows[depth]
            at = (left - _levels_wide(self.size) + MARGIN * self.size, y)
            self.marks.append(Line(name, (left + MARGIN * self.size, y), (right, y), Stroke(ink, 0.8)))
            self.marks.append(Text(name, at, LEVEL.format(depth), self.size, self.theme.muted, "start"))

    def _dim(self, rows: Sequence[int]) -> None:
        """Dim the rays that are neither above nor below the selected one, nor shown by this step, and their hits."""
        assert self.style.selected is not None
        selected, parents = self.style.selected, self.tree.nodes["parent"]
        below = branch(self.tree, selected, rows)
        folded = {row for row in self.plan.folds.keys() & self.step.rows if int(parents[row]) in below}
        kept = ancestors(self.tree, selected) | below | self.step.current | folded
        bright = {f"{what}-{i}" for what in OF_A_ROW for i in kept}
        dims = tuple(f"{what}-" for what in OF_A_ROW)
        self.marks = [
            blended(mark, DIMMED, self.theme.panel) if mark.name.startswith(dims) and mark.name not in bright else mark
            for mark in self.marks
        ]

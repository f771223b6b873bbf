"""The rays of a tree figure that is an outline: edges with corners, and labels behind the boxes."""

from dataclasses import replace

from tracer.tree.raytree import RayTree
from viewer.base.theme import STYLES, Arrow
from viewer.figures.font import text_width
from viewer.figures.labels import ray_title
from viewer.figures.layout.outline import GAP, edge_of
from viewer.figures.layout.sizes import edge_label
from viewer.figures.layout.tree_plan import TreePlan
from viewer.figures.marks import Line, Mark, Stroke, Text

FROM_EYE = 1.1  # from the middle of the eye to the first ray, in text sizes
BELOW_EYE = 0.5  # the same, if the ray goes down
RAISED = 0.72  # of the first ray's label above it, in text sizes
FIRST_ARROW = 0.3  # of the first ray's length


def outline_ray(plan: TreePlan, tree: RayTree, i: int, stroke: Stroke) -> list[Mark]:
    """The edge to hit i, with its label behind the box. The first ray runs from the eye to its box, with its label
    beside it.
    """
    name, size, arrow = f"ray-{i}", plan.size, STYLES[tree.kind(i)].arrow
    (x, y), label, title, half = plan.at[i], edge_label(tree, i), ray_title(tree, i), 0.5 * plan.box[0]
    if i:
        edge = outline_edge(plan, tree, i, name, stroke, arrow, title)
        return [*edge, Text(name, (x + half + GAP * size, y), label, size, stroke.color, "start")]
    (left, top), is_beside = plan.places.eye, plan.places.eye[1] == y
    if is_beside:
        start, end = (left + FROM_EYE * size, y), (x - half, y)
        at = (end[0] - GAP * size - text_width(label, size), y - RAISED * size)
    else:
        start, end = (left, top + BELOW_EYE * size), (left, y - 0.5 * plan.box[1])
        at = (left + FROM_EYE * size, top)
    return [
        Line(
            name, start, end, stroke, arrow, FIRST_ARROW if is_beside else 1.0,
            leaves="eye", reaches="hit-0", title=title,
        ),
        Text(name, at, label, size, stroke.color, "start"),
    ]  # fmt: skip


def outline_edge(
    plan: TreePlan, tree: RayTree, i: int, name: str, stroke: Stroke, arrow: Arrow = Arrow.NONE, title: str = ""
) -> list[Mark]:
    """The edge to the box in row i, down and then to the right."""
    parent = int(tree.nodes["parent"][i])
    side = 1 if tree.kind(i) == "refraction" else -1
    a, b, c = edge_of(plan.at[parent], plan.at[i], plan.box, plan.size, side)
    down = Line(name, a, b, stroke, Arrow.NONE, title=title, leaves=f"hit-{parent}")
    return [down, Line(name, b, c, replace(stroke, dash=(0.0, 0.0)), arrow, 1.0, reaches=f"hit-{i}")]

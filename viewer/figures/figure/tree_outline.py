"""The rays of a tree figure that is an outline: edges with corners, and labels before the boxes."""

from dataclasses import replace

from tracer.tree.raytree import RayTree
from viewer.base.theme import STYLES, Arrow
from viewer.figures.font import text_width
from viewer.figures.labels import ray_title
from viewer.figures.layout.outline import GAP, HEAD, edge_of
from viewer.figures.layout.sizes import edge_label
from viewer.figures.layout.tree_plan import TreePlan
from viewer.figures.marks import Line, Mark, Stroke, Text

FROM_EYE = 1.1  # from the middle of the eye to the first ray, in text sizes
RAISED = 0.72  # of the first ray's label above it, in text sizes
FIRST_ARROW = 0.3  # of the first ray's length


def outline_ray(plan: TreePlan, tree: RayTree, i: int, stroke: Stroke) -> list[Mark]:
    """The edge to hit i, with its label before the box. The first ray runs from the eye to its box."""
    name, size, arrow = f"ray-{i}", plan.size, STYLES[tree.kind(i)].arrow
    (x, y), label, title = plan.at[i], edge_label(tree, i), ray_title(tree, i)
    if i:
        edge = outline_edge(plan, tree, i, name, stroke, arrow, title)
        return [*edge, Text(name, (x - plan.before, y), label, size, stroke.color, "start")]
    end = x - 0.5 * plan.box[0]
    start = plan.places.eye[0] + FROM_EYE * size
    at = (end - GAP * size - text_width(label, size), y - RAISED * size)
    return [
        Line(name, (start, y), (end, y), stroke, arrow, FIRST_ARROW, leaves="eye", reaches="hit-0", title=title),
        Text(name, at, label, size, stroke.color, "start"),
    ]


def outline_edge(
    plan: TreePlan, tree: RayTree, i: int, name: str, stroke: Stroke, arrow: Arrow = Arrow.NONE, title: str = ""
) -> list[Mark]:
    """The edge to the label before row i, down and then to the right."""
    parent = int(tree.nodes["parent"][i])
    side = 1 if tree.kind(i) == "refraction" else -1
    eye = plan.places.eye if parent == 0 else None
    a, b, c = edge_of(plan.at[parent], plan.at[i], plan.size, plan.before, side, eye)
    head = max(0.5, 1.0 - HEAD * plan.size / (b[1] - a[1]))
    return [Line(name, a, b, stroke, arrow, head, title=title), Line(name, b, c, replace(stroke, dash=(0.0, 0.0)))]

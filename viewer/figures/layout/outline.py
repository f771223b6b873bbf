"""A tree as an outline, for a place that is narrow and high.

There is a line for each hit, indented by its depth, in the order in which the recursive procedure meets them.

The label of a ray stands before the box of its hit. From below the label of its parent, an edge runs down and then to
the right.
"""

from viewer.figures.layout.places import LayoutTask, Places
from viewer.figures.layout.sizes import BOX, MARGIN
from viewer.figures.marks import Point

# All in text sizes.
INDENT = 1.35  # of a level
PITCH, TALLEST = 2.0, 2.7  # least and largest distance of lines
GAP = 0.5  # between a ray's label and the box of its hit
EYE = 1.0  # from the left to the middle of the eye
TRUNK = 0.6  # from the left end of a label to the edges that begin below it
DROP = 0.7  # from the middle of a label down to the beginning of these edges
ASIDE = 0.3  # of the edges below the eye, from its middle to the left: the labels of their rays are near
APART = 0.2  # of two edges that begin together, from their middle


def outline_rows(task: LayoutTask) -> list[int]:
    """The rows of hits and folds from top to bottom."""
    kept = task.boxes
    found: list[int] = []
    below = [0]
    while below:
        i = below.pop()
        found.append(i)
        below += [c for c in reversed(task.rays.rays.get(i, [])) if c in kept]
    return found


def place_as_outline(task: LayoutTask, anyhow: bool) -> Places | None:
    """The positions; None if they do not fit."""
    style, sizes, depth = task.style, task.sizes, task.rays.depths
    size, (left, top, right, bottom) = style.size, style.where
    margin = MARGIN * size
    rows = outline_rows(task)
    deepest = max(depth[i] for i in rows)
    wide = sizes.label + GAP * size + sizes.column
    free = bottom - top - 2.0 * margin - BOX * size
    fits = deepest * INDENT * size + wide <= right - left - 2.0 * margin
    fits = fits and (len(rows) - 1) * PITCH * size <= free
    if not fits and not anyhow:
        return None
    pitch = min(TALLEST * size, free / (len(rows) - 1)) if len(rows) > 1 else 0.0
    first = top + margin + 0.5 * BOX * size
    start = left + margin + sizes.label + GAP * size + 0.5 * sizes.column
    at = {i: (start + INDENT * size * depth[i], first + pitch * k) for k, i in enumerate(rows)}
    return Places(at, {}, {}, (left + margin + EYE * size, first))


HEAD = 0.75  # from the corner of an edge up to the tip of its arrow


def edge_of(parent: Point, child: Point, size: float, label: float, side: int, eye: Point | None) -> list[Point]:
    """The corners of the edge to a child.

    `label` is the distance from a box's middle to the left end of the label before it, `side` -1 for a reflected and 1
    for a refracted ray. The edges of the first hit begin below the `eye`.
    """
    trunk = eye[0] - ASIDE * size if eye else parent[0] - label + TRUNK * size
    x = trunk + side * APART * size
    return [(x, parent[1] + DROP * size), (x, child[1]), (child[0] - label - 0.2 * size, child[1])]

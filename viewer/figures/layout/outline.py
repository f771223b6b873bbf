"""A tree as an outline, for a place that is narrow and high.

There is a line for each hit, indented by its depth, in the order in which the recursive procedure meets them.

From below the box of a hit, an edge runs down and then to the right to the box of each hit that its rays meet. The
label of a ray stands behind the box that it leads to.
"""

from viewer.figures.layout.places import LayoutTask, Places
from viewer.figures.layout.sizes import BOX, MARGIN
from viewer.figures.marks import Point

# All in text sizes.
INDENT = 1.7  # of a level
PITCH, TALLEST = 2.0, 2.7  # least and largest distance of lines
GAP = 0.5  # between a box and the label behind it
EYE = 1.0  # from the left to the middle of the eye
FIRST_EDGE = 4.5  # from the left to the first box, if it stands beside the eye: the first ray with its label above it
TRUNK = 0.6  # from the left end of a box to the edges that begin below it
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
    """The positions; None if they do not fit. The eye stands before the first box, or on a line above it if there is
    more room for that.
    """
    beside = _placed(task, FIRST_EDGE, 0, False)
    return beside or _placed(task, 0.0, 1, False) or (_placed(task, FIRST_EDGE, 0, True) if anyhow else None)


def _placed(task: LayoutTask, before: float, above: int, anyhow: bool) -> Places | None:
    """The positions with so much room, in text sizes, before the first box, and so many lines above it."""
    style, sizes, depth = task.style, task.sizes, task.rays.depths
    size, (left, top, right, bottom) = style.size, style.where
    margin = MARGIN * size
    rows = outline_rows(task)
    last = len(rows) - 1 + above
    wide = (before + max(depth[i] for i in rows) * INDENT + GAP) * size + sizes.column + sizes.label
    free = bottom - top - 2.0 * margin - BOX * size
    if not anyhow and (wide > right - left - 2.0 * margin or last * PITCH * size > free):
        return None
    pitch = min(TALLEST * size, free / last) if last else 0.0
    first = top + margin + 0.5 * BOX * size
    start = left + margin + before * size + 0.5 * sizes.column
    at = {i: (start + INDENT * size * depth[i], first + pitch * (k + above)) for k, i in enumerate(rows)}
    return Places(at, {}, {}, (left + margin + EYE * size, first))


def edge_of(parent: Point, child: Point, box: tuple[float, float], size: float, side: int) -> list[Point]:
    """The corners of the edge from below the box of the hit at `parent` to the left end of that at `child`.

    `box` is the width and the height of both, `side` -1 for a reflected and 1 for a refracted ray. The reflected ray's
    edge, which ends first, is the one on the right: the other passes it on the left.
    """
    x = parent[0] - 0.5 * box[0] + (TRUNK - side * APART) * size
    return [(x, parent[1] + 0.5 * box[1]), (x, child[1]), (child[0] - 0.5 * box[0], child[1])]

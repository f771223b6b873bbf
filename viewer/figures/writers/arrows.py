"""Arrow heads as outlines, since programs that read SVG and PDF often drop markers."""

import math

from viewer.base.theme import Arrow
from viewer.figures.marks import Line, Point

HEAD = 11.0  # points from tip to tail, on a line 2.4 wide
WIDEST = 4.2  # of the lines whose heads grow with them
SPREAD = 0.42  # of its length, to either side


def heads(line: Line) -> list[tuple[tuple[Point, Point, Point], bool]]:
    """(corners (side, tip, side), whether it is filled) of each head."""
    if line.arrow is Arrow.NONE:
        return []
    (x0, y0), (x1, y1) = line.start, line.end
    length = math.hypot(x1 - x0, y1 - y0)
    if length == 0.0:
        return []
    size = HEAD * min(line.stroke.width, WIDEST) / 2.4
    dx, dy = (x1 - x0) / length, (y1 - y0) / length
    tip = line.at(min(1.0, line.arrow_at + 0.5 * size / length))

    def head(shift: float) -> tuple[Point, Point, Point]:
        x, y = tip[0] - shift * dx, tip[1] - shift * dy
        back, side = (x - size * dx, y - size * dy), SPREAD * size
        return (back[0] - side * dy, back[1] + side * dx), (x, y), (back[0] + side * dy, back[1] - side * dx)

    if line.arrow is Arrow.DOUBLE:
        return [(head(0.0), False), (head(0.55 * size), False)]
    return [(head(0.0), line.arrow is Arrow.FILLED)]

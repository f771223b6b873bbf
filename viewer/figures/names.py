"""Where names go in a figure of the scene: beside what they name, not over one another, over as few rays as can be."""

import math
import sys
from collections.abc import Sequence

from viewer.figures.font import text_box
from viewer.figures.marks import Mark, Piece, Point, Rectangle, Shape, Text, shares_within
from viewer.theme import Color, Theme, faded

BACKING = 0.7  # opacity of the paper behind a label
RINGS = (0.75, 1.3, 2.0)  # how far from its spot a name may stand, in sizes of the text
TURNS = 12  # directions in which


class Names:
    """What is taken already, and what had better stay free."""

    def __init__(self, where: Rectangle, size: float, theme: Theme) -> None:
        self.where, self.size, self.theme = where, size, theme
        self.taken: list[Rectangle] = []  # by names and signs
        self.ways: list[Piece] = []  # of rays

    def take(self, at: Point, wide: float) -> None:
        x, y = at
        self.taken.append((x - 0.5 * wide, y - 0.5 * wide, x + 0.5 * wide, y + 0.5 * wide))

    def label(
        self,
        name: str,
        content: str,
        spots: Sequence[Point],
        color: Color,
        upon: bool = False,
        most: int = sys.maxsize,
    ) -> list[Mark]:
        """Beside one of these spots, or upon it; nothing where there is no room at any but over `most` rays."""
        best = None
        for order, spot in enumerate(spots):
            for cost, at, anchor in self._around(spot, upon):
                box = text_box(at, content, self.size, anchor)
                if not _within(box, self.where) or any(_overlap(box, other) for other in self.taken):
                    continue
                crossed = sum(shares_within(way, box) is not None for way in self.ways)
                if best is None or (crossed, *cost, order) < best[0]:
                    best = ((crossed, *cost, order), at, anchor, box)
        if best is None or best[0][0] > most:
            return []
        _, at, anchor, box = best
        self.taken.append(box)
        left, top, right, bottom = box
        corners = ((left - 2.0, top), (right + 2.0, top), (right + 2.0, bottom), (left - 2.0, bottom))
        paper = Shape(f"{name}-label", corners, faded(self.theme.ground, BACKING), None)
        return [paper, Text(f"{name}-label", at, content, self.size, color, anchor)]

    def _around(self, spot: Point, upon: bool) -> list[tuple[tuple[float, int], Point, str]]:
        """(how good, where, which end of the text stands there), the nearest first."""
        if upon:
            return [((0.0, 0), spot, "middle")]
        found = []
        for ring in RINGS:
            for turn in range(TURNS):
                angle = 2.0 * math.pi * turn / TURNS
                right, down = math.cos(angle), math.sin(angle)
                anchor = "middle" if abs(right) < 0.3 else "start" if right > 0.0 else "end"
                at = (spot[0] + ring * self.size * right, spot[1] + ring * self.size * down)
                found.append(((ring, turn), at, anchor))
        return found


def _overlap(a: Rectangle, b: Rectangle) -> bool:
    return min(a[2], b[2]) > max(a[0], b[0]) and min(a[3], b[3]) > max(a[1], b[1])


def _within(a: Rectangle, b: Rectangle) -> bool:
    return a[0] >= b[0] and a[1] >= b[1] and a[2] <= b[2] and a[3] <= b[3]

"""The places in the figure of a hit: the picture of the rays, its centre and their length, and the room for formulas.

In a wide rectangle the formulas stand on the right of the picture, in another one below it. If there is room for one
of them only, it is the picture.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from viewer.figures.marks import Point, Rectangle, clip_shares, overlap, widened

# In text sizes.
MARGIN = 2.0 / 3.0  # around the picture and the formulas
COLUMN = 17.0  # width of a column of formulas
GAP = 4.0 / 3.0  # between the picture and the formulas
LEAST = (17.0, 12.5)  # width and height of a picture beside or above formulas
FIRST = 5.0  # least height of formulas below the picture
APART = 0.3  # least distance between a ray and a text

BESIDE = 0.75  # from a ray or an arc to its symbol
STEEP = 0.75  # least distance of an angle's symbol from the lines at its sides

ARCS = (0.3, 0.42)  # radius of the angles' arcs, in lengths of rays
WIDE = 1.25  # the least ratio of width to height with formulas on the right
PICTURE = (0.53, 0.56)  # the picture's share of the width and of the height
BELOW = 0.04  # the hit is lower than the middle of the picture, by this share of its height: the normal's name is above
SHORTER = 0.96  # factor from one length of the rays to the next that is tried


@dataclass(frozen=True)
class HitFrame:
    """Lengths in points, on the figure's canvas."""

    picture: Rectangle
    center: Point  # the hit
    formulas: tuple[Rectangle, ...]  # columns, filled one after the other

    def at(self, turn: float, length: float) -> Point:
        """The point at a distance from the hit, in the direction `turn` clockwise from the normal."""
        return (self.center[0] + length * math.sin(turn), self.center[1] - length * math.cos(turn))

    def reach(self, turns: Sequence[float], taken: Sequence[Rectangle], size: float) -> float:
        """The largest length of rays in these directions that keeps them off the texts `taken` and in the picture."""
        left, top, right, bottom = widened(self.picture, -MARGIN * size)
        (x, y), least = self.center, 2.0 * size
        reach = max(least, min(x - left, right - x, y - top, bottom - y))
        near = [widened(box, APART * size) for box in taken]
        while reach > least and any(
            clip_shares((self.center, self.at(turn, reach)), box) for turn in turns for box in near
        ):
            reach *= SHORTER
        return reach


def hit_frame(where: Rectangle, size: float) -> HitFrame:
    """The places in a rectangle, for a text size."""
    left, top, right, bottom = widened(where, -MARGIN * size)
    wide, high = right - left, bottom - top
    aside, gap = wide - (COLUMN + GAP) * size, GAP * size
    if wide >= WIDE * high and aside >= LEAST[0] * size:
        end = left + max(min(PICTURE[0] * wide, aside), LEAST[0] * size)
        return _frame((left, top, end, bottom), ((end + gap, top, right, bottom),))
    end = top + max(PICTURE[1] * high, LEAST[1] * size)
    if bottom - end - gap >= FIRST * size:
        count = max(1, int((wide + gap) / (COLUMN * size + gap)))
        column = (wide - (count - 1) * gap) / count
        starts = [left + k * (column + gap) for k in range(count)]
        return _frame((left, top, right, end), tuple((x, end + gap, x + column, bottom) for x in starts))
    return _frame((left, top, right, bottom), ())


def _frame(picture: Rectangle, formulas: tuple[Rectangle, ...]) -> HitFrame:
    left, top, right, bottom = picture
    center = (0.5 * (left + right), 0.5 * (top + bottom) + BELOW * (bottom - top))
    return HitFrame(picture, center, formulas)


def has_room(angle: float, radius: float, size: float) -> bool:
    """Whether the symbol of an angle, outside its arc, has room between the lines at its sides."""
    return (radius + BESIDE * size) * math.sin(0.5 * angle) >= STEEP * size


def arc_radius(angle: float, reach: float, size: float) -> float:
    """The radius of the arcs at the hit: the first with room for the symbol of the smallest angle."""
    radii = [share * reach for share in ARCS]
    return next((radius for radius in radii if has_room(angle, radius, size)), radii[0])


def is_free(box: Rectangle, taken: Sequence[Rectangle], lines: Sequence[tuple[Point, Point]]) -> bool:
    """Whether a box overlaps none of these and is crossed by no line."""
    return not any(overlap(box, other) for other in taken) and not any(clip_shares(line, box) for line in lines)

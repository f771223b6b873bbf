"""Placement of names in the figure of the scene: beside their object, over no other name, and over few rays."""

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from viewer.base.theme import Color, Theme, faded
from viewer.figures.font import text_box, wrapped
from viewer.figures.marks import (
    Disc,
    Line,
    Mark,
    Piece,
    Point,
    Rectangle,
    Shape,
    Stroke,
    Text,
    clip_shares,
    overlap,
    within,
)

BACKING, SOLID = 0.7, 0.9  # opacity of the background behind a label: normally, and over a line
RINGS = (0.75, 1.3, 2.0, 2.9, 3.8)  # distances of a name from its spot, in text sizes
LED = 2.0  # from this distance on, a thin line leads to the spot
APART = 0.2  # between two names side by side
DOT = 0.11  # radius of the disc at the end of that line
TURNS = 12  # number of directions


@dataclass(frozen=True)
class Spot:
    """A place for a name: beside a point, or centred `upon` it. `spare` is a line that it may cover."""

    at: Point
    upon: bool = False
    spare: str = ""


class LabelPlacer:
    """The areas that are taken, and lines that should stay free."""

    def __init__(self, where: Rectangle, size: float, theme: Theme) -> None:
        self.where, self.size, self.theme = where, size, theme
        self.taken: list[Rectangle] = []  # by names and signs
        self.ways: list[tuple[str, Piece]] = []  # of rays, with the names of their marks

    def take(self, at: Point, wide: float) -> None:
        x, y = at
        self.taken.append((x - 0.5 * wide, y - 0.5 * wide, x + 0.5 * wide, y + 0.5 * wide))

    def label(
        self, name: str, content: str, spots: Sequence[Spot], color: Color, most: int = sys.maxsize, lead: bool = False
    ) -> list[Mark]:
        """Place a label at the best of these spots, the earlier the better; not at all if each covers more than `most`
        rays.

        If it is so far away that it could belong to another object, a thin line leads to its spot; with `lead`,
        always.
        """
        best, ring = None, 0.0
        for order, spot in enumerate(spots):
            for cost, at, anchor in self._around(spot):
                if best is not None and (0, *cost, order) >= best[0]:
                    break  # no farther place can be better
                box = text_box(at, content, self.size, anchor)
                if not self.free(box):
                    continue
                crossed = sum(way != spot.spare and clip_shares(p, box) is not None for way, p in self.ways)
                if best is None or (crossed, *cost, order) < best[0]:
                    best, ring = ((crossed, *cost, order), at, anchor, box, spot), cost[0]
        if best is None or best[0][0] > most:
            return []
        _, at, anchor, box, spot = best
        left, top, right, bottom = box
        self.taken.append((left - APART * self.size, top, right + APART * self.size, bottom))
        left, right = max(left - 2.0, self.where[0]), min(right + 2.0, self.where[2])
        corners = ((left, top), (right, top), (right, bottom), (left, bottom))
        backing = SOLID if spot.spare else BACKING
        paper = Shape(f"{name}-label", corners, faded(self.theme.ground, backing), None)
        text = Text(f"{name}-label", at, content, self.size, color, anchor)
        return [*(self._leader(name, box, spot.at) if (lead or ring >= LED) and not spot.upon else []), paper, text]

    def paragraph(
        self,
        text: Text,
        parts: Sequence[str],
        widths: Sequence[float],
        line: float,
        places: Callable[[float], Sequence[tuple[Point, str]]],
    ) -> list[Mark]:
        """Place a list, in lines of the first of these widths with which one of the places is free, and crossed by no
        ray; empty if there is none.

        `line` is the distance of lines. `places` are (first line's position, anchor) for the distance of the first line
        and the last. `text` is the mark for each line.
        """
        for wide in widths:
            lines = wrapped(parts, wide, self.size)
            for (x, y), anchor in places((len(lines) - 1) * line):
                found = [
                    replace(text, at=(x, y + k * line), content=words, anchor=anchor) for k, words in enumerate(lines)
                ]
                boxes = [each.box() for each in found]
                crossed = any(clip_shares(piece, box) for _, piece in self.ways for box in boxes)
                if not crossed and all(map(self.free, boxes)):
                    self.taken += boxes
                    return [*found]
        return []

    def fits(self, content: str, spots: Sequence[Spot]) -> bool:
        """Whether there is room at one of these spots."""
        boxes = (text_box(at, content, self.size, anchor) for spot in spots for _, at, anchor in self._around(spot))
        return any(self.free(box) for box in boxes)

    def free(self, box: Rectangle) -> bool:
        return within(box, self.where) and not any(overlap(box, other) for other in self.taken)

    def _leader(self, name: str, box: Rectangle, to: Point) -> list[Mark]:
        """A line from the nearest point of a name's box to a disc, which lies inside the picture."""
        left, top, right, bottom = box
        rim = DOT * self.size + 1.0
        to = (
            min(max(to[0], self.where[0] + rim), self.where[2] - rim),
            min(max(to[1], self.where[1] + rim), self.where[3] - rim),
        )
        start = (min(max(to[0], left), right), min(max(to[1], top), bottom))
        ink = self.theme.text
        line = Line(f"{name}-label", start, to, Stroke(ink, 1.0))
        return [line, Disc(f"{name}-label", to, DOT * self.size, ink, None)]

    def _around(self, spot: Spot) -> list[tuple[tuple[float, int], Point, str]]:
        """(rank, position, anchor of the text), the nearest first."""
        if spot.upon:
            return [((0.0, 0), spot.at, "middle")]
        found = []
        for ring in RINGS:
            for turn in range(TURNS):
                angle = 2.0 * math.pi * turn / TURNS
                right, down = math.cos(angle), math.sin(angle)
                anchor = "middle" if abs(right) < 0.3 else "start" if right > 0.0 else "end"
                at = (spot.at[0] + ring * self.size * right, spot.at[1] + ring * self.size * down)
                found.append(((ring, turn), at, anchor))
        return found

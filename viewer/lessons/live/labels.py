"""Labels of live pieces: each has the longest form with a place in the picture, over no other label and no line.

The most important labels are placed first; those that have no place are left out.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise

from viewer.base.theme import Color, Theme
from viewer.figures.layout.label_placement import LabelPlacer, Spot
from viewer.figures.marks import Disc, Formula, Line, Mark, Point, Rectangle, Shape, Text, clip_shares, inside

SYMBOL = 1.15  # size of a formula, in text sizes
CHORDS = 20  # of a curve that labels keep off: each is tested for each place of a label


class Labels:
    """`marks` grow with each label. `drawn` are the marks of the picture, which labels keep off."""

    def __init__(self, where: Rectangle, size: float, theme: Theme, drawn: Iterable[Mark] = ()) -> None:
        self.placer, self.size = LabelPlacer(where, size, theme), size
        self.marks: list[Mark] = []
        self.avoid(drawn)

    def avoid(self, drawn: Iterable[Mark]) -> None:
        """Keep off these lines, curves, discs and texts. Areas may be covered."""
        for mark in drawn:
            match mark:
                case Line():
                    self.placer.ways += [(mark.name, piece) for piece in mark.pieces()]
                case Shape(closed=False, corners=corners):
                    chords = [*corners[:: max(1, len(corners) // CHORDS)], corners[-1]]
                    self.placer.ways += [(mark.name, piece) for piece in pairwise(chords)]
                case Shape(fill=None, corners=corners):
                    self.placer.ways += [(mark.name, piece) for piece in pairwise((*corners, corners[0]))]
                case Disc(center=center, radius=radius) if mark.fill:
                    self.placer.take(center, 2.0 * radius + 2.0)
                case Text():
                    self.placer.taken.append(mark.box())

    def symbol(self, name: str, source: str, places: Sequence[Point], color: Color) -> None:
        """Write a formula around the first of these points where it is over no line."""
        for x, y in places:
            mark = Formula(name, source, (x, y), SYMBOL * self.size, color)
            _, top, _, bottom = mark.box()
            mark = replace(mark, at=(x, y + y - 0.5 * (top + bottom)))
            if self._take(mark.box()):
                self.marks.append(mark)
                return

    def _take(self, box: Rectangle) -> bool:
        """Take a place, if it is free and no line crosses it."""
        crossed = any(clip_shares(piece, box) or inside(piece[0], box) for _, piece in self.placer.ways)
        if crossed or not self.placer.free(box):
            return False
        self.placer.taken.append(box)
        return True

    def beside(
        self, name: str, words: Sequence[str], at: Point, color: Color, most: int = 0, near: bool = False
    ) -> None:
        """Write one of these beside a point, over at most so many lines. With `near`, none that needs a leader."""
        for content in words:
            found = self.placer.label(name, content, [Spot(at)], color, most)
            if found and near and any(isinstance(mark, Line) for mark in found):
                self.placer.taken.pop()
            elif found:
                self.marks += [mark for mark in found if not isinstance(mark, Shape)]  # a backing is for lines below
                return

    def place(self, name: str, words: Sequence[str], places: Sequence[tuple[Point, str]], color: Color) -> None:
        """Write one of these at one of these places, with their anchors, over no line."""
        for content in words:
            for at, anchor in places:
                mark = Text(name, at, content, self.size, color, anchor)
                if self._take(mark.box()):
                    self.marks.append(mark)
                    return

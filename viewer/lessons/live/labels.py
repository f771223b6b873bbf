"""Labels of live pieces: each has the longest form with a place in the picture, over no other label and no line.

The most important labels are placed first; those that have no place are left out.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise

from viewer.base.theme import Color, Theme
from viewer.figures.layout.label_placement import LabelPlacer, Spot
from viewer.figures.marks import Disc, Line, Mark, Point, Rectangle, Shape, Text, clip_shares, inside

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
                box = mark.box()
                crossed = any(clip_shares(piece, box) or inside(piece[0], box) for _, piece in self.placer.ways)
                if not crossed and self.placer.free(box):
                    self.placer.taken.append(box)
                    self.marks.append(mark)
                    return

"""The sum at a hit, in a block of lines near its box: names on the left, colours under each other on the right."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

from tracer.tree.raytree import RayTree
from viewer.base.theme import Theme
from viewer.explain.sums import sum_terms
from viewer.figures.font import text_width
from viewer.figures.layout.free_space import FreeSpace
from viewer.figures.layout.sizes import MARGIN, SMALLEST
from viewer.figures.marks import HEIGHT, WIDTH, Line, Mark, Point, Rectangle, Text

LINE = 1.28  # from line to line, in text sizes
GAP = 0.7  # between the columns
CLEAR = 0.4  # free space around the block
SMALLER = (1.0, 0.8, 0.65, 0.5)  # text sizes to try, as shares of the figure's

SumLine = tuple[str, str, int | None]  # name, value, the ray whose colour the name has


@dataclass(frozen=True)
class SumBlock:
    """The sum of one hit."""

    tree: RayTree
    hit: int
    box: Rectangle  # of the hit in the figure
    size: float  # of the text
    theme: Theme

    def place(self, vacant: FreeSpace) -> list[Mark]:
        """The marks where there is room, as near to the hit's box as possible. If there is no room for colours, they
        are luminances, and say so; empty if there is none for these.
        """
        for luminance in (False, True):
            lines: list[SumLine] = [(t.name, t.value, t.row) for t in sum_terms(self.tree, self.hit, luminance)]
            lines = [("", "luminance", None), *lines] if luminance else lines
            widths = [(text_width(name, self.size), text_width(value, self.size)) for name, value, _ in lines]
            names, values = max(name for name, _ in widths), max(value for name, value in widths if name)
            wide = max(names + GAP * self.size + values, *(value for _, value in widths))
            high, clear = LINE * self.size * len(lines), CLEAR * self.size
            at = vacant.nearest((wide + 2.0 * clear, high + 2.0 * clear), self.box)
            if at is not None:
                return self._marks(lines, (at[0] + clear, at[1] + clear), wide)
        return []

    def _marks(self, lines: Sequence[SumLine], at: Point, wide: float) -> list[Mark]:
        name, (left, top), size, theme = f"sum-{self.hit}", at, self.size, self.theme
        title = f"the radiance of {self.tree.label(self.hit)} as a sum"
        marks: list[Mark] = []
        for k, (words, value, row) in enumerate(lines):
            y = top + (k + 0.5) * LINE * size
            if words:
                color = theme.text if row is None else theme.ray(self.tree.kind(row))
                marks.append(Text(name, (left, y), words, size, color, "start", title=title))
            marks.append(Text(name, (left + wide, y), value, size, theme.text if words else theme.muted, "end"))
        return marks


def with_sum(
    block: SumBlock,
    forms: Sequence[list[Mark]],
    legend: list[Mark],
    where: Rectangle,
    beside: Sequence[Mark] | None,
) -> list[Mark]:
    """A page with the sum of a hit, in the tree's part of the canvas (`where`). If there is no room for it, it stands
    on the rest of the canvas, if the marks `beside` the tree are known; then it takes the room of the legend, which the
    page does not have then; then the tree has a later one of its `forms`, with fewer marks; then the text is smaller.
    """
    margin = MARGIN * block.size
    canvas = where if beside is None else (margin, margin, WIDTH - margin, HEIGHT - margin)
    sizes = [share * block.size for share in SMALLER if share == 1.0 or share * block.size >= SMALLEST]
    for size, marks in itertools.product(sizes, forms):
        for signs, room in ((legend, where), (legend, canvas), ([], canvas)):
            drawn = [*signs, *marks]
            solid = [m for m in (*drawn, *(beside or ())) if not (isinstance(m, Line) and m.name.startswith("level-"))]
            found = replace(block, size=size).place(FreeSpace(room, solid))
            if found:
                return [*drawn, *found]
    return [*legend, *forms[0]]

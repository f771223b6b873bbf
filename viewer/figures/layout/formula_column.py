"""The column of formulas beside the figure of a hit: sections of an explanation, as many as fit."""

from collections.abc import Sequence

from viewer.base.theme import Color, Theme
from viewer.explain.sections import Section
from viewer.figures.font import fitted, text_width
from viewer.figures.marks import Mark, Rectangle, Text

LINE = 1.28  # from line to line, in text sizes
BETWEEN = 0.5  # between two sections, in lines, if there is room
VECTORS = ("v", "n", "r", "t")

FormulaLine = tuple[str, str, Color]  # name, value, colour of the name


def formula_column(sections: Sequence[Section], last: int, where: Rectangle, size: float, theme: Theme) -> list[Mark]:
    """The marks of these sections. If they do not all fit, the vectors are left out, then all of the last section but
    its `last` lines, then whole sections from the end.
    """
    left, top, right, bottom = where
    room = (bottom - top) / (LINE * size)
    wide = right - left
    blocks = [_lines(section, True, wide, size, theme) for section in sections]
    if _height(blocks) > room:
        blocks = [_lines(section, False, wide, size, theme) for section in sections]
    if _height(blocks) > room and last:
        blocks[-1] = [blocks[-1][0], *blocks[-1][-last:]]
    while _height(blocks) > room:
        blocks.pop()
    gap = min(BETWEEN, (room - _height(blocks)) / max(1, len(blocks) - 1))
    y = top + 0.9 * size
    marks: list[Mark] = []
    for block in blocks:
        for content, value, color in block:
            if content:
                marks.append(Text("formulas", (left, y), content, size, color, "start"))
            if value:
                marks.append(Text("formulas", (right, y), value, size, theme.text, "end"))
            y += LINE * size
        y += gap * LINE * size
    return marks


def _lines(section: Section, vectors: bool, wide: float, size: float, theme: Theme) -> list[FormulaLine]:
    """The lines of a section: name and value in one line, or in two."""
    found = [(section.formula, "", theme.accent)]
    for line in section.lines:
        if line.name in VECTORS and not vectors:
            continue
        if text_width(line.name, size) + text_width(line.value, size) + size <= wide:
            found.append((line.name, line.value, theme.muted))
        elif text_width(line.value, size) <= wide:
            found += [(fitted(line.name, wide, size), "", theme.muted), ("", line.value, theme.muted)]
    return found


def _height(blocks: list[list[FormulaLine]]) -> int:
    return sum(map(len, blocks))

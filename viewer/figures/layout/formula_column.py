"""Columns of formulas beside the figure of a hit: sections of an explanation, as many as fit.

Formulas are typeset, larger than their numbers, which stand below them in a table: names on the left, decimal points
below each other.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from viewer.base.theme import Theme
from viewer.explain.formulas import Lecture
from viewer.explain.plain_formula import broken, joined, left_side
from viewer.explain.sections import Line, Section
from viewer.figures.font import ASCENT, BASELINE, DESCENT, fitted, text_width
from viewer.figures.marks import Formula, Mark, Rectangle, Text

LINE = 1.28  # from line to line, in text sizes
BETWEEN = 0.64  # between two sections, if there is room, in text sizes
LEADING, TALL_LEADING = 0.22, 0.42  # least distance between two rows, and to one with a fraction, in text sizes
TALL = 1.7  # height of a row from which it has a fraction, in text sizes
LARGE = 1.2  # of a section's formula, over the text size
SYMBOL = 1.05  # of a symbol beside its number, whose letters are smaller than those of a text of its size
INDENT = 1.2  # of a value below its name, and of the second line of a formula, in text sizes
GAP = 1.2  # from a name to its value, in text sizes
VECTORS = (Lecture.INCOMING, Lecture.NORMAL, Lecture.REFLECTED, Lecture.REFRACTED)
NUMBER = re.compile(r"(−?\d+)(\.\d+)?°?")


class _Row(NamedTuple):
    """Marks with their baseline at 0, and their extent above and below it."""

    marks: tuple[Text | Formula, ...]
    above: float
    below: float


@dataclass(frozen=True)
class _Style:
    """The parts of the sections that are shown."""

    vectors: bool = True
    definitions: bool = True  # of symbols that are fractions or roots
    last: int | None = None  # lines of the last section; None: all
    numbers: bool = True


def formula_columns(
    sections: Sequence[Section], last: int, columns: Sequence[Rectangle], size: float, theme: Theme
) -> list[Mark]:
    """The marks of these sections. If they do not all fit, vectors are left out, then the definitions of symbols, then
    all of the last section but its `last` lines, then sections from the end, as far as need be; of the first, its
    numbers. A line says how many formulas are left out.
    """
    if not columns or not sections:
        return []
    made = _Columns(columns, size, theme)
    styles = (
        _Style(),
        _Style(vectors=False),
        _Style(vectors=False, definitions=False),
        *((_Style(vectors=False, definitions=False, last=last),) if last else ()),
    )
    for style in styles:
        if (marks := made.place([made.rows(s, style, s is sections[-1]) for s in sections])) is not None:
            return marks
    for count in range(len(sections) - 1, 0, -1):
        note = made.note(len(sections) - count)
        for style in styles[1:3]:
            blocks = [made.rows(s, style, False) for s in sections[:count]]
            if (marks := made.place([*blocks, note])) is not None:
                rest = made.note(len(sections) - count - 1)
                return made.with_part(blocks, made.rows(sections[count], style, False), rest) or marks
    first = made.rows(sections[0], _Style(numbers=False), False)
    return made.place([first, made.note(len(sections) - 1)]) or made.place([first]) or []


class _Columns:
    def __init__(self, columns: Sequence[Rectangle], size: float, theme: Theme) -> None:
        self.columns, self.size, self.theme = columns, size, theme
        self.wide = columns[0][2] - columns[0][0]

    def rows(self, section: Section, style: _Style, is_last: bool) -> list[_Row]:
        lines = [line for line in section.lines if style.vectors or line.symbol not in VECTORS]
        if is_last and style.last is not None:
            lines = lines[-style.last :]
        heading = [self._row(part) for part in self._heading(section.formula)]
        return [*heading, *(row for line in lines for row in self._lines(line, style))] if style.numbers else heading

    def note(self, left_out: int) -> list[_Row]:
        """A line about so many formulas that are left out, or, for 0, about numbers."""
        words = "… and more numbers" if not left_out else f"… and {left_out} more formula{'s' if left_out > 1 else ''}"
        return [self._row(self._text(words, 0.0, muted=True))]

    def _heading(self, source: str) -> Iterator[Formula]:
        """The formula, in two lines or smaller where it is wider than the column."""
        large = LARGE * self.size
        whole = Formula("formulas", joined(source), (0.0, 0.0), large, self.theme.text, "start")
        if self._width(whole) <= self.wide:
            yield whole
            return
        for k, part in enumerate(broken(source)):
            indent = INDENT * self.size if k else 0.0
            mark = replace(whole, source=part, at=(indent, 0.0))
            yield replace(mark, size=large * min(1.0, (self.wide - indent) / self._width(mark)))

    @property
    def values_at(self) -> float:
        """The place of decimal points in a column, after the longest name that most tables have."""
        return min(0.62 * self.wide, 11.6 * self.size)

    def _lines(self, line: Line, style: _Style) -> Iterator[_Row]:
        """Name and value, in one row or in two."""
        value = self._value(line.value)
        names = [self._name(line, brief) for brief in (not style.definitions, True)]
        beside = [name for name in names if self._width(name) + GAP * self.size <= value.box()[0]]
        name = names[0]
        if not line.value:
            yield self._row(name)
        elif beside and value.box()[2] <= self.wide:
            yield self._row(beside[0], value)
        elif self._width(name) + text_width(line.value, self.size) + GAP * self.size <= self.wide:
            yield self._row(name, replace(value, at=(self.wide, value.at[1]), anchor="end"))
        else:
            yield self._row(name)
            parts = [line.value] if self._fits_below(line.value) else line.value.split(": ")
            for part in filter(self._fits_below, parts):
                yield self._row(replace(value, content=part, at=(INDENT * self.size, value.at[1]), anchor="start"))

    def _fits_below(self, value: str) -> bool:
        return INDENT * self.size + text_width(value, self.size) <= self.wide

    def _name(self, line: Line, brief: bool) -> Text | Formula:
        """The name of a value; if it is brief, without the definition of a symbol."""
        muted = self.theme.muted
        if line.symbol:
            long = any(command in line.symbol for command in (r"\frac", r"\sqrt"))
            source = left_side(line.symbol) if brief and long else line.symbol
            return Formula("formulas", source, (0.0, 0.0), SYMBOL * self.size, muted, "start")
        return self._text(fitted(line.name, self.wide, self.size), 0.0, muted=True)

    def _value(self, content: str) -> Text:
        """A number with its decimal point in line with the others; anything else starts where they do."""
        whole = found[1] if (found := NUMBER.fullmatch(content)) else "−0"
        return self._text(content, self.values_at - text_width(whole, self.size))

    def _text(self, content: str, x: float, muted: bool = False) -> Text:
        color = self.theme.muted if muted else self.theme.text
        return Text("formulas", (x, -BASELINE * self.size), content, self.size, color, "start")

    def _width(self, mark: Text | Formula) -> float:
        left, _, right, _ = mark.box()
        return right - left

    def _row(self, *marks: Text | Formula) -> _Row:
        above = max(ASCENT * self.size, *(-mark.box()[1] for mark in marks))
        below = max(DESCENT * self.size, *(mark.box()[3] for mark in marks))
        return _Row(marks, above, below)

    def place(self, blocks: Sequence[list[_Row]]) -> list[Mark] | None:
        """The marks in the columns; None if they do not fit. A section is not split."""
        for gap in (BETWEEN, 0.5 * BETWEEN):
            marks: list[Mark] = []
            rest = list(blocks)
            for column in self.columns:
                y, first = column[1], True
                while rest and (first or y < column[3]):
                    placed, end = self._placed(rest[0], column[0], y if first else y + gap * self.size)
                    if end > column[3]:
                        break
                    marks += placed
                    y, first = end, False
                    rest.pop(0)
            if not rest:
                return marks
        return None

    def with_part(self, blocks: Sequence[list[_Row]], more: list[_Row], note: list[_Row]) -> list[Mark] | None:
        """The marks of these sections, as much of another as fits, at least formula and one number, and a note."""
        for count in range(len(more) - 1, 1, -1):
            is_value = more[count].marks[0].at[0] > 0.0  # of the name in the row before
            if not is_value and (marks := self.place([*blocks, more[:count], note])) is not None:
                return marks
        return None

    def _placed(self, rows: Sequence[_Row], x: float, y: float) -> tuple[list[Mark], float]:
        """A section's marks with its top at y, and its bottom."""
        marks: list[Mark] = []
        for row in rows:
            extent = row.above + row.below
            leading = TALL_LEADING if extent > TALL * self.size else LEADING
            pitch = max(LINE * self.size, extent + leading * self.size)
            baseline = y + row.above + 0.5 * (pitch - extent)
            marks += [replace(mark, at=(x + mark.at[0], baseline + mark.at[1])) for mark in row.marks]
            y += pitch
        return marks, y

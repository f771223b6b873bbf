"""A column of text, formulas and aligned numbers in a panel, drawn from top to bottom at places of its own."""

import re
from contextlib import nullcontext

from imgui_bundle import imgui

from viewer.base.theme import Color, Theme
from viewer.explain.plain_formula import broken, joined
from viewer.explain.sections import Line, Section
from viewer.figures.formula.typeset import typeset
from viewer.figures.marks import Formula
from viewer.figures.writers.imgui import EM
from viewer.figures.writers.imgui_formula import draw_formula
from viewer.panels import draw as d

# In font sizes of imgui.
LINE = 1.3  # from line to line
LEADING = 0.45  # least space between two rows, of which one has a fraction
LARGE = 1.35 * EM  # a formula above its numbers
SYMBOL = 1.1 * EM  # a symbol beside its number
SMALL = 0.88  # remarks
INDENT = 1.2
GAP = 0.9  # between a name and its value
NUMBER_ROOM = 3.9  # for a number with five digits
FARTHEST = 13.0  # from a symbol to the next beside it
VALUE = 2.2  # from a symbol to its value, if the symbol is short
VECTOR = 4.4  # from one number of a vector to the next
TALL = 3.0  # no row reaches farther from its baseline
BESIDE = 0.6  # the largest share of the width for names that have their value beside them

Cell = tuple[str, float, float]  # a text, its left and its right end from the left of the column

NUMBER = re.compile(r"(−?\d+)(\.\d*)?°?")


class Card:
    """A column with its top left corner at (x, y), in pixels on the screen. `y` is the top of what comes next."""

    def __init__(self, theme: Theme, x: float, y: float, width: float) -> None:
        self.theme, self.x, self.y, self.width = theme, x, y, width
        self.pad = imgui.get_window_draw_list()
        self.em = imgui.get_font_size()
        self.right = x  # of all that was drawn
        self.ascent = imgui.get_font_baked().ascent

    def skip(self, lines: float) -> None:
        self.y += lines * self.em

    def text(self, content: str, color: Color | None = None, size: float = 1.0, bold: bool = False) -> None:
        """A paragraph, wrapped to the width."""
        with d.bold() if bold else nullcontext():
            pixels = round(size * self.em)
            share = pixels / self.em
            high = imgui.calc_text_size(content, wrap_width=self.width / share).y * share
            at, ink = (round(self.x), round(self.y)), d.u32(color or self.theme.text)
            self.pad.add_text(imgui.get_font(), pixels, at, ink, content, wrap_width=self.width)
        self.y += high
        self.skip(LINE - 1.0)

    def formula(self, source: str) -> None:
        """A formula; if it is wider than the column, in two lines, or smaller."""
        whole = joined(source)
        for k, part in enumerate([whole] if self._wide(whole, LARGE) <= self.width else broken(source)):
            indent = INDENT * self.em if k else 0.0
            size = LARGE * min(1.0, (self.width - indent) / self._wide(part, LARGE))
            self._row(part, size, indent, self.theme.text, 1.5)

    def pairs(self, pairs: tuple[tuple[str, str], tuple[str, str]]) -> None:
        """Two symbols with their values, side by side if there is room."""
        room = min(0.5 * self.width, FARTHEST * self.em)
        aside = all(self._wide(symbol, SYMBOL) + (GAP + NUMBER_ROOM) * self.em <= room for symbol, _ in pairs)
        for k, (symbol, value) in enumerate(pairs):
            left, baseline = k * room if aside else 0.0, self._baseline()
            self._symbol(symbol, SYMBOL, left, baseline, self.theme.muted)
            self._put(value, left + max(VALUE * self.em, self._wide(symbol, SYMBOL) + GAP * self.em), baseline)
            if k or not aside:
                self.skip(LINE)

    def section(self, section: Section) -> None:
        """A formula with its numbers, whose decimal points stand below each other."""
        self.text(section.title, self.theme.muted, bold=True)
        if section.formula:
            self.formula(section.formula)
        names = [self._name_width(line) for line in section.lines if line.value]
        beside = max((wide for wide in names if wide <= BESIDE * self.width), default=0.0)
        for line in section.lines:
            self._line(line, beside + GAP * self.em + self._text_width("−0"))
        self.skip(0.6)

    def _line(self, line: Line, point: float) -> None:
        """A name with its value beside it, or below it if there is no room. `point` is the place of decimal points."""
        muted = self.theme.muted
        cells = self._kept_inside(self._cells(line.value, point))
        fits = self._name_width(line) + GAP * self.em <= cells[0][1]
        if line.symbol:
            baseline = self._row(line.symbol, SYMBOL, 0.0, muted, LINE)
        else:
            baseline = self._baseline()
            self._wrapped(line.name, muted, cells[0][1] - GAP * self.em if fits else self.width)
        if line.value and not fits:
            cells = self._kept_inside(self._cells(line.value, INDENT * self.em + self._text_width("−0")))
            baseline = self._baseline()
            self.skip(LINE)
        for content, left, _ in cells:
            self._put(content, left, baseline)
        if line.ray:
            beyond = cells[-1][2] + GAP * self.em
            fits = beyond + self._text_width(line.ray) <= self.width
            self._put(line.ray, beyond if fits else self._name_width(line) + GAP * self.em, baseline, muted)

    def _wrapped(self, content: str, color: Color, width: float) -> None:
        high = imgui.calc_text_size(content, wrap_width=max(width, self.em)).y
        at = (round(self.x), round(self._baseline() - self.ascent))
        self.pad.add_text(imgui.get_font(), self.em, at, d.u32(color), content, wrap_width=max(width, self.em))
        self.y += high
        self.skip(LINE - 1.0)

    def _cells(self, value: str, point: float) -> list[Cell]:
        """The parts of a value: numbers with their decimal points at `point` and at even
        distances from it, or one text.
        """
        parts = value.split("  ")
        if not all(NUMBER.fullmatch(part) for part in parts):
            left = point - self._text_width("−0")
            return [(value, left, left + self._text_width(value))]
        found = []
        for k, part in enumerate(parts):
            whole = NUMBER.fullmatch(part)[1]  # type: ignore[index]
            left = point + k * VECTOR * self.em - self._text_width(whole)
            found.append((part, left, left + self._text_width(part)))
        return found

    def _kept_inside(self, cells: list[Cell]) -> list[Cell]:
        """The parts of a value, moved to the left as far as they are beyond the width."""
        over = max(0.0, cells[-1][2] - self.width)
        return [(content, left - over, right - over) for content, left, right in cells]

    def _row(self, source: str, size: float, indent: float, color: Color, least: float) -> float:
        """A formula in a row of its own height. Returns its baseline."""
        _, top, _, bottom = (size * self.em * side for side in typeset(source).box)
        above = max(0.5 * (least * self.em) + 0.32 * EM * self.em, -top + 0.5 * LEADING * self.em)
        below = max(0.5 * (least * self.em) - 0.32 * EM * self.em, bottom + 0.5 * LEADING * self.em)
        baseline = round(self.y + above)
        self._symbol(source, size, indent, baseline, color)
        self.y += above + below
        return baseline

    def _baseline(self) -> float:
        """The baseline of a row of text at the current place."""
        return round(self.y + 0.5 * LINE * self.em + 0.32 * EM * self.em)

    def _symbol(self, source: str, size: float, indent: float, baseline: float, color: Color) -> None:
        mark = Formula("card", source, (self.x + indent, baseline), size * self.em, color, "start")
        if self._is_seen(baseline):
            draw_formula(self.pad, mark, (0.0, 0.0), 1.0)
        self.right = max(self.right, mark.box()[2])

    def _put(self, content: str, indent: float, baseline: float, color: Color | None = None) -> None:
        at = (round(self.x + indent), round(baseline - self.ascent))
        if self._is_seen(baseline):
            self.pad.add_text(at, d.u32(color or self.theme.text), content)
        self.right = max(self.right, at[0] + self._text_width(content))

    def _is_seen(self, baseline: float) -> bool:
        """Whether a row can be seen where the panel is scrolled to; formulas of others are not even made images of."""
        return (
            self.pad.get_clip_rect_min().y - TALL * self.em < baseline < self.pad.get_clip_rect_max().y + TALL * self.em
        )

    def _name_width(self, line: Line) -> float:
        return self._wide(line.symbol, SYMBOL) if line.symbol else self._text_width(line.name)

    def _wide(self, source: str, size: float) -> float:
        left, _, right, _ = typeset(source).box
        return size * self.em * (right - left)

    def _text_width(self, content: str) -> float:
        return imgui.calc_text_size(content).x

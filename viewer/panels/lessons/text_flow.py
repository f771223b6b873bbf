"""Draws the text of a lesson in a panel: blocks of wrapped lines in several styles, with formulas and links to rays.

imgui_bundle's own Markdown knows neither the colour of a single link nor whether the mouse is over it, and formulas
only by a library that needs a locale; so its text is laid out here.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from imgui_bundle import imgui

from viewer.base.theme import Color, Theme, faded
from viewer.explain.plain_formula import FormulaError, joined, plain
from viewer.figures.formula.typeset import typeset
from viewer.figures.marks import Formula
from viewer.figures.writers.imgui import EM
from viewer.figures.writers.imgui_formula import draw_formula
from viewer.lessons import text
from viewer.lessons.text import Block, Fence, Inline, InlineFormula, Items, Paragraph, Quote, Run, Table
from viewer.panels import draw as d
from viewer.panels.card import Card
from viewer.panels.lessons.code import draw_code

# In font sizes.
LINE = 1.28  # from line to line
BETWEEN = 0.62  # two blocks
INDENT = 1.35  # of lists and quotes
HEADING = 1.12  # size of a heading inside a step
INLINE = 1.08 * EM  # a formula in a line
COLUMN = 1.4  # between columns of a table
SPACE = 0.27  # between two words

BREAK = "\n"  # in the text of a run: a new line


@dataclass(frozen=True)
class Piece:
    """A part of a line: a word or a part of one, or a formula."""

    content: str
    width: float  # pixels
    style: Run
    is_formula: bool = False
    spaced: bool = False  # whether a space comes before it


@dataclass(frozen=True)
class Colors:
    """The colours of a text. `of_link` gives that of a link's target."""

    theme: Theme
    of_link: Callable[[str], Color]


class TextFlow:
    """A column with its top left corner at (x, y), in pixels on the screen. `y` is the top of what comes next."""

    def __init__(self, colors: Colors, x: float, y: float, width: float) -> None:
        self.colors, self.x, self.y, self.width = colors, x, y, width
        self.pad = imgui.get_window_draw_list()
        self.em = imgui.get_font_size()
        self.pointed: str | None = None  # the target of the link under the mouse
        self.fence: Callable[[Fence], bool] = lambda fence: False  # draws a fenced block; False: it is drawn as code

    def blocks(self, blocks: Sequence[Block]) -> None:
        """Draw the blocks, one below the other."""
        for block in blocks:
            self.block(block)
            self.y += BETWEEN * self.em

    def block(self, block: Block) -> None:
        match block:
            case Paragraph():
                self._paragraph(block)
            case Items():
                self._items(block)
            case Quote():
                top = self.y
                self._indented(block.blocks, INDENT)
                bar = self.x + 0.3 * self.em
                self.pad.add_line((bar, top), (bar, self.y), self._ink(faded(self.colors.theme.muted, 0.6)), 2.0)
            case Table():
                self._table(block)
            case text.Formula():
                self._display(block.source)
            case Fence():
                if not self.fence(block):
                    self.code(block.content.rstrip("\n").split("\n"))

    def heading(self, content: str, size: float, color: Color | None = None) -> None:
        """A bold line, wrapped."""
        self._lines([Run(content, bold=True)], size, color)

    # --- blocks -------------------------------------------------------------------------------------------------------

    def _paragraph(self, block: Paragraph) -> None:
        if block.level:
            content = [replace(item, bold=True) if isinstance(item, Run) else item for item in block.content]
            self._lines(content, HEADING)
        else:
            self._lines(block.content)

    def _items(self, block: Items) -> None:
        for k, item in enumerate(block.items):
            mark = "•" if block.first is None else f"{block.first + k}."
            self._put(Piece(mark, 0.0, Run(mark)), self.x + 0.25 * self.em, self.y, self.em)
            self._indented(item, INDENT)

    def _indented(self, blocks: Sequence[Block], by: float) -> None:
        self.x, self.width = self.x + by * self.em, self.width - by * self.em
        for k, block in enumerate(blocks):
            self.y += BETWEEN * self.em if k else 0.0
            self.block(block)
        self.x, self.width = self.x - by * self.em, self.width + by * self.em

    def _table(self, block: Table) -> None:
        cells = [[list(self._pieces(cell, self.em)) for cell in row] for row in block.rows]
        gap = COLUMN * self.em
        widths = [max(_length(row[k], self.em) for row in cells) for k in range(len(cells[0]))] if cells else []
        over = (self.width - gap * (len(widths) - 1)) / max(sum(widths), 1.0)
        lefts = [sum(min(1.0, over) * width + gap for width in widths[:k]) for k in range(len(widths))]
        for number, row in enumerate(cells):
            for left, pieces in zip(lefts, row, strict=True):
                self._line(pieces, self.x + left, self.em, self.colors.theme.muted if number == 0 else None)
            self.y += LINE * self.em
            if number == 0:
                end = self.x + min(self.width, lefts[-1] + widths[-1])
                self.pad.add_line((self.x, self.y), (end, self.y), self._ink(faded(self.colors.theme.muted, 0.5)), 1.0)
                self.y += 0.2 * self.em

    def _display(self, source: str) -> None:
        """A formula in lines of its own; as code if it cannot be typeset."""
        card = Card(self.colors.theme, self.x, self.y, self.width)
        try:
            card.formula(source)
        except FormulaError:
            self.code([source])
        else:
            self.y = card.y

    def code(self, lines: Sequence[str], caption: str = "") -> None:
        """Draw lines of source text."""
        self.y += draw_code(self.colors.theme, (self.x, self.y), self.width, lines, caption)

    # --- lines --------------------------------------------------------------------------------------------------------

    def _lines(self, content: Sequence[Inline], size: float = 1.0, color: Color | None = None) -> None:
        """A paragraph, wrapped to the width."""
        pixels = round(size * self.em)
        line: list[Piece] = []
        space, right = SPACE * pixels, 0.0
        for word in _words(self._pieces(content, pixels)):
            wide = sum(piece.width for piece in word)
            lead = space if line and word[0].spaced else 0.0
            is_break = word[0].content == BREAK
            if line and (right + lead + wide > self.width or is_break):
                self._line(line, self.x, pixels, color)
                self.y += LINE * pixels
                line, right, lead = [], 0.0, 0.0
            if not is_break:
                line += word
                right += lead + wide
        self._line(line, self.x, pixels, color)
        self.y += LINE * pixels

    def _line(self, pieces: Sequence[Piece], x: float, size: float, color: Color | None = None) -> None:
        for k, piece in enumerate(pieces):
            x += SPACE * size if k and piece.spaced else 0.0
            self._put(piece, x, self.y, size, color)
            x += piece.width

    def _pieces(self, content: Sequence[Inline], size: float) -> Iterator[Piece]:
        """Words and parts of words. A part follows the one before without a space, if it is not `spaced`."""
        spaced = False
        for item in content:
            if isinstance(item, InlineFormula):
                yield self._formula_piece(item, size, spaced)
                spaced = False
                continue
            words = item.text.replace(BREAK, f" {BREAK} ").split(" ")
            for k, word in enumerate(words):
                spaced = spaced or k > 0
                if word:
                    yield Piece(word, self._width(word, item, size), item, spaced=spaced)
                    spaced = False

    def _formula_piece(self, item: InlineFormula, size: float, spaced: bool) -> Piece:
        try:
            left, _, right, _ = typeset(item.source).box
        except FormulaError:
            content = Run(f"${item.source}$", code=True)
            return Piece(content.text, self._width(content.text, content, size), content, spaced=spaced)
        return Piece(joined(item.source), INLINE * size * (right - left), Run(plain(item.source)), True, spaced)

    def _put(self, piece: Piece, x: float, y: float, size: float, color: Color | None = None) -> None:
        style = piece.style
        ink = self.colors.of_link(style.link) if style.link else color or self.colors.theme.text
        if piece.is_formula:
            mark = Formula("text", piece.content, (x, y + 0.8 * size), INLINE * size, ink, "start")
            draw_formula(self.pad, mark, (0.0, 0.0), 1.0)
            return
        at = (round(x), round(y))
        if style.code:
            plate = self._ink(faded(self.colors.theme.muted, 0.2))
            self.pad.add_rect_filled((at[0] - 1, at[1]), (at[0] + piece.width + 1, at[1] + size), plate, 0.2 * size)
        self.pad.add_text(d.font(_font(style)), size, at, self._ink(ink), piece.content)
        if style.link:
            self._link(style.link, at, piece.width, size, ink)

    def _link(self, target: str, at: tuple[float, float], width: float, size: float, ink: Color) -> None:
        low = at[1] + 1.04 * size
        if imgui.is_mouse_hovering_rect(at, (at[0] + width, low)):
            self.pointed = target
        self.pad.add_line((at[0], low), (at[0] + width, low), self._ink(faded(ink, 0.7)), max(1.0, 0.06 * size))

    def _width(self, word: str, style: Run, size: float) -> float:
        return _text_width(_font(style), word, size)

    def _ink(self, color: Color) -> int:
        return d.u32(color)


def _text_width(font: int, content: str, size: float) -> float:
    """The width of a text in pixels."""
    scale = imgui.get_font_size() / imgui.get_style().font_size_base
    imgui.push_font(d.font(font), size / scale)
    found = imgui.calc_text_size(content).x
    imgui.pop_font()
    return found


def _font(style: Run) -> int:
    if style.code:
        return d.SOURCE
    return d.BOLD if style.bold else d.ITALIC if style.italic else 0


def _words(pieces: Iterator[Piece]) -> Iterator[list[Piece]]:
    """Pieces that belong to one word, which is not broken."""
    word: list[Piece] = []
    for piece in pieces:
        if word and piece.spaced:
            yield word
            word = []
        word.append(piece)
    if word:
        yield word


def _length(pieces: Sequence[Piece], size: float) -> float:
    """The width of a line in pixels."""
    return sum(piece.width + (SPACE * size if k and piece.spaced else 0.0) for k, piece in enumerate(pieces))

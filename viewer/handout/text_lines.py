"""The text of a lesson in lines of a width, for slides: words and formulas at their places."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from tracer.printable import printable
from viewer.explain.plain_formula import FormulaError, broken, plain
from viewer.figures.font import text_width
from viewer.figures.formula.typeset import typeset
from viewer.lessons.text import Block, Fence, Formula, Inline, InlineFormula, Items, Paragraph, Quote, Run, Table

# In text sizes.
LINE = 1.34  # from line to line
BETWEEN = 0.5  # two blocks
INDENT = 1.4  # of lists and quotes
COLUMN = 1.5  # between columns of a table
BOLD = 1.09  # width of bold letters, in widths of the others
DISPLAY = 1.25  # size of a formula in lines of its own
CODE = 0.8  # size of code
NO_BREAK = "\u00a0"  # a space that is kept at the beginning of a line
TALL = 0.35  # space above and below it


@dataclass(frozen=True)
class Word:
    """Text in one style, or a formula, on a line. `at` is the left end: of the line's middle, or of the baseline of a
    formula. Lengths in points, from the top left of the text.
    """

    content: str  # LaTeX of a formula
    at: tuple[float, float]
    size: float
    style: Run
    is_formula: bool = False


@dataclass(frozen=True)
class BlockLines:
    """A block: its words, and how it stands among the others."""

    kind: str  # p, li, h, quote, code, formula, tr
    words: tuple[Word, ...]
    top: float
    bottom: float
    left: float = 0.0
    mark: str = ""  # of an item of a list, left of its words
    columns: tuple[float, ...] = ()  # where the cells of a row of a table begin


class TextLines:
    """Lays out blocks below each other. `bottom` is where they end."""

    def __init__(self, width: float, size: float) -> None:
        self.left, self.width, self.size = 0.0, width, size
        self.bottom = 0.0
        self.blocks: list[BlockLines] = []

    def add(self, blocks: Sequence[Block], kind: str = "p") -> None:
        """Add blocks below the others. Live pieces are left out."""
        for block in blocks:
            if not (isinstance(block, Fence) and block.kind == "live"):
                self._block(block, kind)

    def _block(self, block: Block, kind: str) -> None:
        match block:
            case Paragraph():
                bold = bool(block.level)
                content = [replace(i, bold=True) if bold and isinstance(i, Run) else i for i in block.content]
                self._lines("h" if bold else kind, content)
            case Items():
                for k, item in enumerate(block.items):
                    mark = "•" if block.first is None else f"{block.first + k}."
                    self._indented(item, "li", mark)
            case Quote():
                self._indented(block.blocks, "quote", "")
            case Table():
                self._table(block)
            case Formula():
                self._display(block.source)
            case Fence():
                whole, self.size = self.size, CODE * self.size
                for line in block.content.rstrip("\n").split("\n"):
                    rest = line.lstrip(" ")
                    self._lines("code", [Run(f"{NO_BREAK * (len(line) - len(rest))}{rest}", code=True)], 0.0)
                self.size = whole
                self.bottom += BETWEEN * self.size

    def _indented(self, blocks: Sequence[Block], kind: str, mark: str) -> None:
        by = INDENT * self.size
        self.left, self.width = self.left + by, self.width - by
        first = len(self.blocks)
        self.add(blocks, kind)
        self.left, self.width = self.left - by, self.width + by
        if mark and len(self.blocks) > first:
            self.blocks[first] = replace(self.blocks[first], mark=mark)

    def _table(self, block: Table) -> None:
        cells = [[list(self._pieces(cell)) for cell in row] for row in block.rows]
        count = max(map(len, cells), default=0)
        widths = [max(sum(p.width for p in row[k]) for row in cells if k < len(row)) for k in range(count)]
        lefts = [self.left + sum(width + COLUMN * self.size for width in widths[:k]) for k in range(count)]
        for row in cells:
            y = self.bottom + 0.5 * LINE * self.size
            words = [word for x, cell in zip(lefts, row, strict=False) for word in self._placed(cell, x, y)]
            self._end("tr", words, LINE * self.size)
            self.blocks[-1] = replace(self.blocks[-1], columns=tuple(lefts[: len(row)]))
        self.bottom += BETWEEN * self.size

    def _display(self, source: str) -> None:
        size = DISPLAY * self.size
        try:
            for part in broken(source):
                left, top, _, bottom = typeset(part).box
                y = self.bottom + TALL * self.size - top * size
                word = Word(part, (self.left - left * size, y), size, Run(plain(part)), True)
                self._end("formula", [word], (bottom - top) * size + 2.0 * TALL * self.size)
        except FormulaError:
            self._lines("code", [Run(source, code=True)])

    def _lines(self, kind: str, content: Sequence[Inline], between: float = BETWEEN) -> None:
        line: list[_Piece] = []
        words: list[Word] = []
        top, right = self.bottom, 0.0
        for piece in self._pieces(content):
            if line and (right + piece.width > self.width or piece.breaks) and piece.may_begin:
                if not line[-1].is_formula:  # the text goes on, also when it is copied
                    line[-1] = replace(line[-1], content=f"{line[-1].content} ")
                words += self._placed(line, self.left, self.bottom + 0.5 * LINE * self.size)
                self.bottom += LINE * self.size
                line, right = [], 0.0
                piece = replace(piece, content=piece.content.lstrip(" "))
                piece = replace(piece, width=self._width(piece))
            line.append(piece)
            right += piece.width
        words += self._placed(line, self.left, self.bottom + 0.5 * LINE * self.size)
        self.bottom = self.bottom + LINE * self.size
        self.blocks.append(BlockLines(kind, tuple(words), top, self.bottom, self.left))
        self.bottom += between * self.size

    def _end(self, kind: str, words: Sequence[Word], height: float) -> None:
        self.blocks.append(BlockLines(kind, tuple(words), self.bottom, self.bottom + height, self.left))
        self.bottom += height

    def _pieces(self, content: Sequence[Inline]) -> Iterator["_Piece"]:
        """Words with the space before them. What begins without a space stays with what is before."""
        spaced = False
        for item in content:
            if isinstance(item, InlineFormula):
                yield self._formula(item.source, spaced)
                spaced = False
                continue
            for k, line in enumerate(map(printable, item.text.split("\n"))):
                breaks = k > 0
                for j, word in enumerate(line.split(" ")):
                    spaced = spaced or j > 0
                    if word or breaks:
                        piece = _Piece(f"{' ' * spaced}{word}", 0.0, item, spaced or breaks, breaks)
                        yield replace(piece, width=self._width(piece))
                        spaced = breaks = False

    def _formula(self, source: str, spaced: bool) -> "_Piece":
        try:
            left, _, right, _ = typeset(source).box
        except FormulaError:
            piece = _Piece(source, 0.0, Run(source, code=True), may_begin=spaced)
            return replace(piece, width=self._width(piece))
        return _Piece(source, (right - left + 0.3) * self.size, Run(plain(source)), spaced, is_formula=True)

    def _width(self, piece: "_Piece") -> float:
        return text_width(piece.content, self.size) * (BOLD if piece.style.bold else 1.0)

    def _placed(self, line: Sequence["_Piece"], x: float, y: float) -> list[Word]:
        words: list[Word] = []
        for piece in line:
            if piece.is_formula:
                at = (x + 0.25 * self.size, y + 0.36 * self.size)
                words.append(Word(piece.content, at, self.size, piece.style, True))
            elif words and words[-1].style is piece.style and not words[-1].is_formula:
                words[-1] = replace(words[-1], content=words[-1].content + piece.content)
            else:
                words.append(Word(piece.content, (x, y), self.size, piece.style))
            x += piece.width
        return [word for word in words if word.content]


@dataclass(frozen=True)
class _Piece:
    content: str
    width: float
    style: Run
    may_begin: bool = True  # a line may begin with it
    breaks: bool = False  # a line must begin with it
    is_formula: bool = False

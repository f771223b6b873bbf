"""The text of a lesson as blocks of runs, which the window, the slides and the pages lay out."""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

VALUE = re.compile(r"\{([^{}\s]+)\}")  # {theta1}, {TR.theta1}
WORD = re.compile(r"[^\W_]")  # what makes a word one: a letter or a digit


@dataclass(frozen=True)
class Run:
    """A piece of a line in one style. `link` is its target: `#TR` for a ray, or an address."""

    text: str
    bold: bool = False
    italic: bool = False
    code: bool = False
    link: str = ""

    @property
    def ray(self) -> str | None:
        """The path of the ray that it names."""
        return self.link[1:] if self.link.startswith("#") else None


@dataclass(frozen=True)
class InlineFormula:
    """A formula in a line, in LaTeX."""

    source: str


Inline = Run | InlineFormula


@dataclass(frozen=True)
class Block:
    line: int  # of the file, from 1


@dataclass(frozen=True)
class Paragraph(Block):
    content: tuple[Inline, ...]
    level: int = 0  # of a heading inside a step, 3 to 6; 0: none


@dataclass(frozen=True)
class Items(Block):
    """A list."""

    items: tuple[tuple[Block, ...], ...]
    first: int | None = None  # the first number of a numbered list


@dataclass(frozen=True)
class Quote(Block):
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Table(Block):
    """Rows of cells; the first row is the head."""

    rows: tuple[tuple[tuple[Inline, ...], ...], ...]


@dataclass(frozen=True)
class Fence(Block):
    """A fenced block. `info` are the words after the fence, like `source tracer.optics.transmission`."""

    info: str
    content: str

    @property
    def kind(self) -> str:
        return self.info.split(maxsplit=1)[0] if self.info else ""

    @property
    def argument(self) -> str:
        return self.info.partition(" ")[2].strip()


@dataclass(frozen=True)
class Formula(Block):
    """A formula in lines of its own."""

    source: str


def inlines(blocks: Sequence[Block]) -> Iterator[tuple[int, Inline]]:
    """(line of its block, run or formula) for all of these blocks."""
    for block in blocks:
        match block:
            case Paragraph():
                yield from ((block.line, item) for item in block.content)
            case Items():
                for item in block.items:
                    yield from inlines(item)
            case Quote():
                yield from inlines(block.blocks)
            case Table():
                yield from ((block.line, item) for row in block.rows for cell in row for item in cell)


def fences(blocks: Sequence[Block]) -> Iterator[Fence]:
    """All fenced blocks, also in lists and quotes."""
    for block in blocks:
        match block:
            case Fence():
                yield block
            case Items():
                for item in block.items:
                    yield from fences(item)
            case Quote():
                yield from fences(block.blocks)


def count_words(blocks: Sequence[Block]) -> int:
    """The words that a reader reads, where a value and a formula count as one each."""
    return sum(
        1 if isinstance(item, InlineFormula) else sum(map(bool, map(WORD.search, item.text.split())))
        for _, item in inlines(blocks)
    )


def filled(blocks: Sequence[Block], value: Callable[[str], str]) -> tuple[Block, ...]:
    """The blocks with each `{name}` outside code replaced by its value."""

    def run(item: Inline) -> Inline:
        if isinstance(item, InlineFormula) or item.code:
            return item
        return replace(item, text=VALUE.sub(lambda found: value(found[1]), item.text))

    def block(one: Block) -> Block:
        match one:
            case Paragraph():
                return replace(one, content=tuple(map(run, one.content)))
            case Items():
                return replace(one, items=tuple(filled(item, value) for item in one.items))
            case Quote():
                return replace(one, blocks=filled(one.blocks, value))
            case Table():
                return replace(one, rows=tuple(tuple(tuple(map(run, cell)) for cell in row) for row in one.rows))
            case _:
                return one

    return tuple(map(block, blocks))


def names_of_values(blocks: Sequence[Block]) -> Iterator[tuple[int, str]]:
    """(line, name) of each `{name}` outside code."""
    for line, item in inlines(blocks):
        if isinstance(item, Run) and not item.code:
            yield from ((line, found[1]) for found in VALUE.finditer(item.text))

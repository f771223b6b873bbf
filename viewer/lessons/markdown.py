"""Reads Markdown into blocks: CommonMark with tables, and formulas between dollar signs. markdown-it parses it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING

from viewer.lessons.text import Block, Fence, Formula, Inline, InlineFormula, Items, Paragraph, Quote, Run, Table

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.token import Token

FORMULA = "formula"  # after the word `code` of a fence: its lines are formulas


def blocks_of(markdown: str, first_line: int) -> tuple[Block, ...]:
    """The blocks of a text that begins on this line of its file."""
    return tuple(_Reader(_parser().parse(markdown), first_line).blocks())


@cache
def _parser() -> "MarkdownIt":
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    return MarkdownIt("commonmark", {"html": False}).enable("table").use(dollarmath_plugin, double_inline=False)


@dataclass
class _Reader:
    """Makes blocks of markdown-it's tokens."""

    tokens: list["Token"]
    first_line: int
    at: int = field(default=0, init=False)

    def blocks(self, end: str = "") -> Iterator[Block]:
        """The blocks up to the token of this type, which is read as well."""
        while self.at < len(self.tokens):
            token = self.tokens[self.at]
            self.at += 1
            if token.type == end:
                return
            line = self.first_line + (token.map[0] if token.map else 0)
            match token.type:
                case "paragraph_open" | "heading_open":
                    level = int(token.tag[1:]) if token.type == "heading_open" else 0
                    yield Paragraph(line, self._inline(), level)
                    self.at += 1
                case "bullet_list_open" | "ordered_list_open":
                    is_numbered = token.type == "ordered_list_open"
                    first = int(token.attrs.get("start", 1)) if is_numbered else None
                    yield Items(line, tuple(self._items(token.type.replace("open", "close"))), first)
                case "blockquote_open":
                    yield Quote(line, tuple(self.blocks("blockquote_close")))
                case "table_open":
                    yield Table(line, tuple(self._rows()))
                case "fence" if token.info.split() == ["code", FORMULA]:
                    sources = ((k, one.strip()) for k, one in enumerate(token.content.split("\n"), line + 1))
                    yield from (Formula(k, one) for k, one in sources if one)
                case "fence" | "code_block":
                    yield Fence(line, token.info.strip(), token.content)
                case "math_block":
                    yield Formula(line, token.content.strip())

    def _items(self, end: str) -> Iterator[tuple[Block, ...]]:
        while self.tokens[self.at].type != end:
            self.at += 1  # list_item_open
            yield tuple(self.blocks("list_item_close"))
        self.at += 1

    def _rows(self) -> Iterator[tuple[tuple[Inline, ...], ...]]:
        row: list[tuple[Inline, ...]] = []
        while (token := self.tokens[self.at]).type != "table_close":
            if token.type == "inline":
                row.append(self._inline())
                continue
            self.at += 1
            if token.type == "tr_close":
                yield tuple(row)
                row = []
        self.at += 1

    def _inline(self) -> tuple[Inline, ...]:
        """The runs of the next token."""
        token = self.tokens[self.at]
        self.at += 1
        return tuple(_joined(_runs(token.children or [])))


def _runs(tokens: Sequence["Token"]) -> Iterator[Inline]:
    style = Run("")
    for token in tokens:
        match token.type:
            case "text":
                yield replace(style, text=token.content)
            case "softbreak" | "hardbreak":
                yield replace(style, text=" " if token.type == "softbreak" else "\n")
            case "code_inline":
                yield replace(style, text=token.content, code=True)
            case "math_inline":
                yield InlineFormula(token.content.strip())
            case "strong_open" | "strong_close":
                style = replace(style, bold=token.type == "strong_open")
            case "em_open" | "em_close":
                style = replace(style, italic=token.type == "em_open")
            case "link_open":
                style = replace(style, link=str(token.attrs.get("href", "")))
            case "link_close":
                style = replace(style, link="")
            case "image":
                yield replace(style, text=token.content)


def _joined(runs: Iterator[Inline]) -> Iterator[Inline]:
    """Neighbours of one style as one run."""
    before: Run | None = None
    for run in runs:
        if before and isinstance(run, Run) and replace(run, text="") == replace(before, text=""):
            before = replace(before, text=before.text + run.text)
            continue
        if before and before.text:
            yield before
        before = run if isinstance(run, Run) else None
        if before is None:
            yield run
    if before and before.text:
        yield before

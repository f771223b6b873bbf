"""The text of a lesson as HTML."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from viewer.explain.plain_formula import FormulaError
from viewer.figures.writers.html.formulas import Formulas
from viewer.figures.writers.html.frame import text
from viewer.lessons.text import Block, Fence, Formula, Inline, InlineFormula, Items, Paragraph, Quote, Run, Table

SAFE = ("https://", "http://", "mailto:")  # addresses that links may lead to


@dataclass(frozen=True)
class RayLink:
    """A link to a ray: the name that its marks have (`data-ray`), its kind, and the id of the figures."""

    ray: str
    kind: str
    place: str


@dataclass(frozen=True)
class BlockWriter:
    """Writes blocks. `ray` finds the ray of a link's path, `fence` writes a live piece, or nothing."""

    formulas: Formulas
    ray: Callable[[str], RayLink | None]
    fence: Callable[[Fence], list[str]]

    def lines(self, blocks: Sequence[Block]) -> Iterator[str]:
        for block in blocks:
            yield from self._block(block)

    def _block(self, block: Block) -> Iterator[str]:
        match block:
            case Paragraph():
                tag = f"h{min(6, max(3, block.level))}" if block.level else "p"
                yield f"<{tag}>{self.inline(block.content)}</{tag}>"
            case Items():
                start = f' start="{block.first}"' if block.first not in (None, 1) else ""
                tag = "ul" if block.first is None else "ol"
                yield f"<{tag}{start}>"
                for item in block.items:
                    yield "<li>"
                    yield from self.lines(item)
                    yield "</li>"
                yield f"</{tag}>"
            case Quote():
                yield "<blockquote>"
                yield from self.lines(block.blocks)
                yield "</blockquote>"
            case Table():
                yield from self._table(block)
            case Formula():
                yield f'<p class="display">{self._formula(block.source)}</p>'
            case Fence():
                yield from self.fence(block) or [f"<pre><code>{text_lines(block.content)}</code></pre>"]

    def _table(self, block: Table) -> Iterator[str]:
        yield '<div class="scroll"><table>'
        for k, row in enumerate(block.rows):
            tag = "td" if k else 'th scope="col"'
            cells = "".join(f"<{tag}>{self.inline(cell)}</{tag[:2]}>" for cell in row)
            yield f"<tr>{cells}</tr>"
        yield "</table></div>"

    def inline(self, content: Sequence[Inline]) -> str:
        """A line of text."""
        return "".join(self._formula(i.source) if isinstance(i, InlineFormula) else self._run(i) for i in content)

    def _formula(self, source: str) -> str:
        try:
            return self.formulas.lines(source)
        except FormulaError:
            return f"<code>{text(source)}</code>"

    def _run(self, run: Run) -> str:
        found = "<br>".join(map(text, run.text.split("\n")))
        for tag, is_on in (("code", run.code), ("em", run.italic), ("strong", run.bold)):
            found = f"<{tag}>{found}</{tag}>" if is_on else found
        if run.ray is not None:
            link = self.ray(run.ray)
            if link:
                return f'<a class="ray {link.kind}" href="#{link.place}" data-to="{link.ray}">{found}</a>'
            return found
        if run.link.lower().startswith(SAFE):
            return f'<a href="{text(run.link)}" rel="noreferrer">{found}</a>'
        return found


def text_lines(content: str) -> str:
    """Code: its lines stay lines."""
    return "\n".join(map(text, content.rstrip("\n").split("\n")))

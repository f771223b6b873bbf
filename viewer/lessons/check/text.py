"""Faults of a step's text that need no rays: too many words, formulas and source texts that there are not."""

from collections.abc import Iterator

from tracer.formats.source import Fault
from viewer.explain.listing import listing
from viewer.explain.plain_formula import FormulaError
from viewer.figures.formula.typeset import typeset
from viewer.lessons.step import Step
from viewer.lessons.text import Block, Formula, InlineFormula, Items, Quote, count_words, fences, inlines

MOST_AT_ONCE, MOST_WORDS = 40, 90  # words between two presses, and in a step


def text_faults(step: Step) -> Iterator[Fault]:
    """All of them."""
    yield from _words(step)
    yield from _formulas(step)
    yield from _sources(step)


def _words(step: Step) -> Iterator[Fault]:
    counts = [count_words(part.blocks) for part in step.parts]
    for part, count in zip(step.parts, counts, strict=True):
        if count > MOST_AT_ONCE:
            line = part.blocks[0].line
            yield Fault(f"{count} words appear at once; at most {MOST_AT_ONCE} are allowed: hide some by ???", line)
    if sum(counts) > MOST_WORDS:
        yield Fault(f"{sum(counts)} words in a step; at most {MOST_WORDS} are allowed", step.line)


def _formulas(step: Step) -> Iterator[Fault]:
    for line, source in _formulas_of(block for part in step.parts for block in part.blocks):
        try:
            typeset(source)
        except FormulaError as error:
            yield Fault(str(error), line)


def _sources(step: Step) -> Iterator[Fault]:
    """Source text of functions that are not there."""
    for fence in (fence for part in step.parts for fence in fences(part.blocks) if fence.kind == "source"):
        try:
            listing(fence.argument)
        except ValueError as error:
            yield Fault(f"source: {error}", fence.line)
        if fence.content.strip():
            yield Fault("source: the block must be empty, its text is that of the function", fence.line + 1)


def _formulas_of(blocks: Iterator[Block]) -> Iterator[tuple[int, str]]:
    """(line, source) of all formulas."""
    for block in blocks:
        match block:
            case Formula():
                yield block.line, block.source
            case Items():
                yield from _formulas_of(inner for item in block.items for inner in item)
            case Quote():
                yield from _formulas_of(iter(block.blocks))
            case _:
                yield from ((line, item.source) for line, item in inlines([block]) if isinstance(item, InlineFormula))

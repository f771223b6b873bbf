"""Formulas in HTML: outlines as in the figures, each once a page, with their plain text for screen readers."""

from collections.abc import Iterator
from functools import lru_cache

from viewer.explain.plain_formula import broken, plain
from viewer.figures.formula.typeset import typeset
from viewer.figures.writers.html.frame import text
from viewer.figures.writers.svg import outline_path

SHARP = 1000  # units of the outlines per em: two decimals of a point would be coarse at this size
LINE = (-0.92, 0.34)  # top and bottom of a line of text, in ems from its baseline; fractions are higher


class Formulas:
    """The formulas of one page."""

    def __init__(self) -> None:
        self._names: dict[str, str] = {}  # of the symbols, by their source

    def element(self, source: str) -> str:
        """A formula in a line of text."""
        name = self._names.setdefault(source, f"formula-{len(self._names)}")
        left, top, right, bottom = typeset(source).box
        top, bottom = min(top, LINE[0]), max(bottom, LINE[1])
        place = " ".join(f"{SHARP * side:.0f}" for side in (left, top, right - left, bottom - top))
        size = f'width="{right - left:.2f}em" height="{bottom - top:.2f}em"'
        said = f'class="formula" role="img" aria-label="{text(plain(source))}"'
        return f'<svg {said} viewBox="{place}" {size}><use href="#{name}"/></svg>'

    def lines(self, source: str) -> str:
        """A formula in lines of its own, broken where its source says so."""
        return " ".join(map(self.element, broken(source)))

    def definitions(self) -> Iterator[str]:
        """The outlines of all formulas so far, for one place of the page."""
        if self._names:
            yield '<svg class="definitions" aria-hidden="true"><defs>'
            for source, name in self._names.items():
                yield f'<path id="{name}" d="{_path(source)}"/>'
            yield "</defs></svg>"


@lru_cache(maxsize=256)
def _path(source: str) -> str:
    scaled = (
        tuple(tuple(tuple(SHARP * place for place in segment) for segment in contour) for contour in outline)
        for outline in typeset(source).outlines
    )
    return outline_path(scaled)

"""Formulas in HTML: outlines as in the figures, each once a page, with their plain text for screen readers."""

from collections.abc import Iterator

from viewer.explain.plain_formula import broken, plain
from viewer.figures.formula.typeset import Outline, Segment, typeset
from viewer.figures.writers.html.frame import text
from viewer.figures.writers.svg import outline_path

SHARP = 1000  # units of the outlines per em, in whole numbers: a fiftieth of a pixel
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
        """The outlines of all formulas so far, for one place of the page. Each letter is there once."""
        if not self._names:
            return
        glyphs: dict[str, str] = {}  # the ids of letters and bars, by their outlines
        placed = []
        for source, name in self._names.items():
            uses = [
                f'<use href="#{glyphs.setdefault(path, f"glyph-{len(glyphs)}")}" x="{x}" y="{y}"/>'
                for path, x, y in map(_moved, typeset(source).outlines)
            ]
            placed.append(f'<g id="{name}">{"".join(uses)}</g>')
        yield '<svg class="definitions" aria-hidden="true"><defs>'
        yield from (f'<path id="{name}" d="{path}"/>' for path, name in glyphs.items())
        yield from placed
        yield "</defs></svg>"


def _moved(outline: Outline) -> tuple[str, int, int]:
    """The outline, moved to start at (0, 0), as path data; and its place."""
    x, y = (round(SHARP * place) for place in outline[0][0])

    def moved(segment: Segment) -> Segment:
        return tuple(round(SHARP * place - (y if k % 2 else x)) for k, place in enumerate(segment))

    return outline_path([[tuple(map(moved, contour)) for contour in outline]]), x, y

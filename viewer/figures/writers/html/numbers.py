"""What is said of rays, as HTML: an article for each, of which the script shows one at a time beside the figures."""

from collections.abc import Iterator

from viewer.explain.sections import Line, Part, RayDetails, Section
from viewer.figures.writers.html.formulas import Formulas
from viewer.figures.writers.html.frame import text


class Numbers:
    """The articles of one page. Figures of one tree say the same of a ray, and share its article."""

    def __init__(self, formulas: Formulas) -> None:
        self._formulas = formulas
        self._names: dict[str, str] = {}  # of the articles, by their content

    def name(self, details: RayDetails) -> str:
        """The id of the article of these details."""
        return self._names.setdefault(self._content(details), f"numbers-{len(self._names)}")

    def articles(self) -> Iterator[str]:
        for content, name in self._names.items():
            yield f'<article id="{name}" aria-labelledby="{name}-name">'
            yield f'<h3 id="{name}-name">{content}'
            yield "</article>"

    def _content(self, details: RayDetails) -> str:
        numbers, *parts = details.parts
        lines = [f"{text(details.name)}</h3>", *(f"<p>{text(words)}</p>" for words in details.words if words)]
        lines += [self._list(section) for section in numbers.sections]
        lines += [line for part in parts for line in self._part(part)]
        return "\n".join(lines)

    def _part(self, part: Part) -> Iterator[str]:
        yield f"<details><summary>{text(part.title)}</summary>"
        for section in part.sections:
            yield f"<h4>{text(section.title)}</h4>"
            if section.formula:
                yield f"<p>{self._formulas.lines(section.formula)}</p>"
            yield self._list(section)
        yield "</details>"

    def _list(self, section: Section) -> str:
        """The lines of a section: names with values, and formulas or remarks without one."""
        rows = "\n".join(map(self._row, section.lines))
        return f"<dl>\n{rows}\n</dl>" if rows else ""

    def _row(self, line: Line) -> str:
        name = self._formulas.element(line.symbol) if line.symbol else text(line.name)
        return f"<div><dt>{name}</dt><dd>{text(line.value)}</dd></div>"

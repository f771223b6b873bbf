"""Sections of lines: the form in which an explanation is passed to panels, figures and tests."""

from dataclasses import dataclass, field

from viewer.explain.formulas import Lecture
from viewer.explain.plain_formula import plain


@dataclass(frozen=True)
class Line:
    """A name with its value, or a formula with its numbers below it."""

    name: str
    value: str = ""
    ray: str = ""  # the label of the ray that the value belongs to
    symbol: str = ""  # the name as a formula, if it is one


@dataclass
class Section:
    title: str
    formula: str = ""  # as on the slide
    lines: list[Line] = field(default_factory=list)

    def add(self, name: str, value: str = "", ray: str = "") -> None:
        """Add a line. A `name` of the lecture's formulas is typeset."""
        symbol = name if isinstance(name, Lecture) else ""
        self.lines.append(Line(plain(symbol) if symbol else name, value, ray, symbol))


@dataclass(frozen=True)
class Part:
    """Sections about one end of a ray, or about all of it."""

    title: str
    sections: list[Section]


@dataclass(frozen=True)
class RayDetails:
    """All that is said of one ray beside a figure that shows it."""

    row: int  # of the tree: the number in the names of its marks
    name: str  # its kind and label
    words: tuple[str, ...]  # paragraphs: what becomes of it, how certain that is
    parts: tuple[Part, ...]  # its numbers first, then the formulas that they come from

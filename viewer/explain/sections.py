"""Sections of lines: the form in which an explanation is passed to panels, figures and tests."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Line:
    """A name with its value, or a formula with its numbers below it."""

    name: str
    value: str = ""


@dataclass
class Section:
    title: str
    formula: str = ""  # as on the slide
    lines: list[Line] = field(default_factory=list)

    def add(self, name: str, value: str = "") -> None:
        self.lines.append(Line(name, value))

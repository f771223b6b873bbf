"""Sections of lines: the form in which an explanation is passed to panels, figures and tests."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Line:
    """A name with its value, or a formula with its numbers below it."""

    name: str
    value: str = ""
    ray: str = ""  # the label of the ray that the value belongs to


@dataclass
class Section:
    title: str
    formula: str = ""  # as on the slide
    lines: list[Line] = field(default_factory=list)

    def add(self, name: str, value: str = "", ray: str = "") -> None:
        self.lines.append(Line(name, value, ray))


@dataclass(frozen=True)
class Part:
    """Sections about one end of a ray, or about all of it."""

    title: str
    sections: list[Section]

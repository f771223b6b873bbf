"""Colours that follow the reader's system: each is a custom property with a value for light and one for dark."""

import re
from collections.abc import Sequence

from viewer.base.theme import STYLES, Theme, rgb_bytes
from viewer.figures.writers.html.frame import root_colors

COLOR = re.compile(r'"#[0-9A-F]{6}"')


class Partners:
    """The colours of one figure in two themes: which belong together, as far as it is certain."""

    def __init__(self) -> None:
        self._found: dict[str, set[str]] = {}

    def learn(self, drawing: Sequence[str], other: Sequence[str]) -> None:
        """Take the pairs of a drawing in both themes, whose elements differ in colours only."""
        for first, second in zip(drawing, other, strict=False):
            if COLOR.sub("", first) == COLOR.sub("", second):
                for light, dark in zip(COLOR.findall(first), COLOR.findall(second), strict=True):
                    self._found.setdefault(light, set()).add(dark)

    def know(self, drawing: Sequence[str]) -> bool:
        """Whether each colour of a drawing has one partner."""
        return all(len(self._found.get(color, ())) == 1 for element in drawing for color in COLOR.findall(element))

    def of(self, element: str) -> str:
        """An element in the other theme."""
        return COLOR.sub(lambda color: next(iter(self._found.get(color[0], {color[0]}))), element)


class ColorPairs:
    """The pairs of colours of one page, from the same drawings in both themes. One theme: nothing is paired."""

    def __init__(self, themes: Sequence[Theme]) -> None:
        self.themes = tuple(themes)
        self._names: dict[tuple[str, str], str] = {}

    def paired(self, drawings: Sequence[str]) -> str:
        """A drawing from its forms in each theme. Where they differ in more than colours, that of the first."""
        first, other = drawings[0], drawings[-1]
        if first == other or COLOR.sub("", first) != COLOR.sub("", other):
            return first
        pairs = zip(COLOR.findall(first), COLOR.findall(other), strict=True)
        return COLOR.sub(lambda _: self._color(*next(pairs)), first)

    def _color(self, light: str, dark: str) -> str:
        if light == dark:
            return light
        return f'"var(--{self._names.setdefault((light, dark), f"c{len(self._names)}")})"'

    def style(self) -> str:
        """The rules with the colours of both themes. Paper has those of the first."""
        first = f"\n:root {{ {self._values(0)} }}\n"
        if len(self.themes) == 1:
            return first
        other = f"{root_colors(self.themes[1])}\n:root {{ {self._values(1)} }}"
        return f"{first}@media screen and (prefers-color-scheme: dark) {{\n{other}\n}}\n"

    def _values(self, k: int) -> str:
        """The properties of one theme: its colours of rays, and its half of the pairs."""
        rays = {kind: "#{:02X}{:02X}{:02X}".format(*rgb_bytes(self.themes[k].ray(kind))) for kind in STYLES}
        pairs = {name: pair[k].strip('"') for pair, name in self._names.items()}
        return " ".join(f"--{name}: {code};" for name, code in {**rays, **pairs}.items())

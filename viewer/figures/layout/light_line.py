"""The line that stands for the shadow rays of a hit if they are many: words, or, where these are too wide, signs with
numbers.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from tracer.tree.raytree import RayTree
from viewer.figures.font import text_width
from viewer.figures.lights import Fate, counted, light_line

WORDS, SIGNS, NO_LINE = range(3)  # its forms, the widest first
SIGN = 0.95  # width of a sign, before its label, in text sizes
BETWEEN = 0.5  # two parts with signs, in text sizes
LETTER = "L:"


@dataclass(frozen=True)
class LinePart:
    """A text, with the sign of a fate before it, if it has one. `left` is from the line's left end, in points."""

    left: float
    text: str
    sign: str = ""


@dataclass(frozen=True)
class LightLine:
    width: float
    parts: tuple[LinePart, ...]

    @staticmethod
    def of(tree: RayTree, shadows: Sequence[int], form: int, size: float) -> "LightLine":
        """The line for some of a hit's shadow rays."""
        counts = counted(tree, shadows)
        if form == WORDS:
            words = light_line(tree, shadows)
            return LightLine(text_width(words, size), (LinePart(0.0, words),))
        parts, left = [LinePart(0.0, LETTER)], text_width(LETTER, size)
        for fate, count in counts:
            left += BETWEEN * size
            parts.append(LinePart(left, str(count), fate.name))
            left += SIGN * size + text_width(str(count), size)
        return LightLine(left, tuple(parts))


def widest_line(tree: RayTree, shadows: Sequence[int], form: int, size: float) -> float:
    """The largest width of the line while its rays are added one by one: "1 reaches" is wider than "2 reach"."""
    if form != WORDS:
        return LightLine.of(tree, shadows, form, size).width

    def longest(fate: Fate, count: int) -> str:
        return max((f"1 {fate.one}", f"{count} {fate.many}"), key=lambda words: text_width(words, size))

    words = ", ".join(longest(fate, count) for fate, count in counted(tree, shadows))
    return text_width(f"{LETTER} {words}", size)

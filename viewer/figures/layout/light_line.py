"""The line that stands for the shadow rays of a hit if they are many: words, or, where these are too wide, signs with
numbers.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from tracer.tree.raytree import RayTree
from viewer.figures.font import text_width
from viewer.figures.lights import MOST_LIGHTS, Fate, counted, fate_of, light_line, shadow_rays

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


def box_signs(tree: RayTree, i: int, size: float) -> tuple[tuple[LinePart, int | None], ...]:
    """The signs of the shadow rays of hit i in its own box, with their rows: one each, or, if they are many, one a fate
    with its number. `left` counts from the first sign's left end.
    """
    shadows = shadow_rays(tree, i)
    if len(shadows) <= MOST_LIGHTS:
        return tuple((LinePart(k * SIGN * size, "", fate_of(tree, row).name), row) for k, row in enumerate(shadows))
    parts, left = [], 0.0
    for fate, count in counted(tree, shadows):
        parts.append((LinePart(left, str(count), fate.name), None))
        left += (SIGN + BETWEEN) * size + text_width(str(count), size)
    return tuple(parts)


def signs_width(tree: RayTree, i: int, lights: bool, size: float) -> float:
    """The width of the signs in the box of hit i."""
    signs = box_signs(tree, i, size) if lights else ()
    if not signs:
        return 0.0
    last, _ = signs[-1]
    return last.left + SIGN * size + text_width(last.text, size)


def widest_line(tree: RayTree, shadows: Sequence[int], form: int, size: float) -> float:
    """The largest width of the line while its rays are added one by one: "1 reaches" is wider than "2 reach"."""
    if form != WORDS:
        return LightLine.of(tree, shadows, form, size).width

    def longest(fate: Fate, count: int) -> str:
        return max((f"1 {fate.one}", f"{count} {fate.many}"), key=lambda words: text_width(words, size))

    words = ", ".join(longest(fate, count) for fate, count in counted(tree, shadows))
    return text_width(f"{LETTER} {words}", size)

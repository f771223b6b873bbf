"""What lines and signs mean, in the corners that a figure leaves free."""

from collections.abc import Sequence
from dataclasses import dataclass

from viewer.figures import signs
from viewer.figures.font import text_width
from viewer.figures.marks import Line, Mark, Rectangle, Stroke, Text
from viewer.theme import STYLES, Theme

LINE = 1.3  # from line to line, in sizes of the text
SAMPLE = 2.4  # the width of what is explained, with the gap to its words


@dataclass(frozen=True)
class Entry:
    what: str  # a kind of ray, or what becomes of a ray to a light
    words: str

    def width(self, size: float) -> float:
        return SAMPLE * size + text_width(self.words, size)


def legend(entries: Sequence[Entry], corners: Sequence[Rectangle], size: float, theme: Theme) -> list[Mark]:
    """Rays first in one corner, lights in the other; what no corner has room for is left out."""
    rays = [entry for entry in entries if entry.what in STYLES]
    lights = [entry for entry in entries if entry.what not in STYLES]
    marks: list[Mark] = []
    used = [0] * len(corners)
    for column, block in enumerate((rays, lights)):
        for entry in block:
            for k in (column, 1 - column):
                left, top, right, bottom = corners[k]
                y = top + (used[k] + 0.5) * LINE * size
                if entry.width(size) <= right - left and y + 0.5 * LINE * size <= bottom:
                    begin = left if k == 0 else right - _widest(block if k == column else entries, size)
                    marks += _entry(entry, (begin, y), size, theme)
                    used[k] += 1
                    break
    return marks


def _widest(entries: Sequence[Entry], size: float) -> float:
    return max(entry.width(size) for entry in entries)


def _entry(entry: Entry, at: tuple[float, float], size: float, theme: Theme) -> list[Mark]:
    name = f"legend-{entry.what}"
    x, y = at
    words = Text(name, (x + SAMPLE * size, y), entry.words, size, theme.text, "start")
    if entry.what in STYLES:
        style = STYLES[entry.what]
        stroke = Stroke(theme.ray(entry.what), style.width, style.dash)
        return [Line(name, (x, y), (x + 2.0 * size, y), stroke, style.arrow, 0.65), words]
    dash = STYLES["shadow"].dash
    stub = Line(name, (x, y), (x + 1.1 * size, y), Stroke(theme.ray("shadow"), STYLES["shadow"].width, dash))
    return [stub, *signs.light_end(entry.what, name, (x + 1.6 * size, y), size, theme), words]

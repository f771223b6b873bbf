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
    """Rays first in the first corner, lights in the second; what has no room there goes where there is some.

    What has room in no corner is left out.
    """
    placed: dict[int, list[Entry]] = {k: [] for k in range(len(corners))}
    for entry in entries:
        first = 0 if entry.what in STYLES else 1
        for k in (first, 1 - first, *range(2, len(corners))):
            left, top, right, bottom = corners[k]
            if entry.width(size) <= right - left and top + (len(placed[k]) + 1) * LINE * size <= bottom:
                placed[k].append(entry)
                break
    marks: list[Mark] = []
    for k, block in placed.items():
        left, top, right, _ = corners[k]
        begin = right - max((entry.width(size) for entry in block), default=0.0) if k == 1 else left
        for row, entry in enumerate(block):
            marks += _entry(entry, (begin, top + (row + 0.5) * LINE * size), size, theme)
    return marks


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

"""The legend of lines and signs. It stands near a corner where the figure leaves room, in a block for rays and one for
lights.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from viewer.base.theme import STYLES, Color, Theme
from viewer.figures import signs
from viewer.figures.font import text_width
from viewer.figures.layout.free_space import FreeSpace
from viewer.figures.lights import FATE
from viewer.figures.marks import Line, Mark, Point, Rectangle, Stroke, Text

LINE = 1.3  # from line to line, in text sizes
SAMPLE, BARE_SAMPLE = 2.4, 1.4  # width of a sample with its gap, and of one without a stub, in text sizes
CLEAR = 0.5  # free space around a block, in text sizes
APART = 1.0  # between two entries in a row

CUT = "cut"  # what an entry about rays that were cut explains

RAYS = ("top left", "bottom left", "top right", "bottom right")
LIGHTS = ("top right", "bottom right", "top left", "bottom left")


@dataclass(frozen=True)
class Entry:
    what: str  # a kind of ray, the end of a shadow ray, CUT, or "lights": words only
    words: str
    stub: bool = True  # the sign of a shadow ray stands at the end of a stub

    def width(self, size: float) -> float:
        return self.indent * size + text_width(self.words, size)

    @property
    def indent(self) -> float:
        """The width of the sample before the words, in text sizes."""
        return 0.0 if self.what == "lights" else SAMPLE if self.what in STYLES or self.stub else BARE_SAMPLE


def legend(entries: Sequence[Entry], marks: Sequence[Mark], where: Rectangle, size: float, theme: Theme) -> list[Mark]:
    """Place the legend where there are no marks: block by block, or line by line if there is no room for a block.

    A line without room is left out.
    """
    vacant = FreeSpace(where, marks)
    found: list[Mark] = []
    rays = [entry for entry in entries if entry.what in STYLES]
    lights = [entry for entry in entries if entry.what not in STYLES]
    for block, corners in ((rays, RAYS), (lights, LIGHTS)):
        at = _take(vacant, block, corners, size)
        if at is not None:
            found += _block(block, at, size, theme)
            continue
        for entry in block:
            at = _take(vacant, [entry], corners, size)
            if at is not None:
                found += _block([entry], at, size, theme)
    return found


def legend_row(entries: Sequence[Entry], left: float, middle: float, size: float, theme: Theme) -> list[Mark]:
    """The legend in one line, whose text has its middle at this height."""
    found: list[Mark] = []
    for entry in entries:
        found += _entry(entry, (left, middle), size, theme)
        left += entry.width(size) + APART * size
    return found


def row_width(entries: Sequence[Entry], size: float) -> float:
    return sum(entry.width(size) + APART * size for entry in entries)


def ray_sample(kind: str, at: Point, length: float, color: Color) -> Line:
    """A piece of a ray of this kind, from its left end."""
    style = STYLES[kind]
    end = (at[0] + length, at[1])
    return Line(f"legend-{kind}", at, end, Stroke(color, style.width, style.dash), style.arrow, 0.65)


def _take(vacant: FreeSpace, block: Sequence[Entry], corners: Sequence[str], size: float) -> Point | None:
    """The place of a block's first line."""
    wide = max((entry.width(size) for entry in block), default=0.0)
    high = LINE * size * len(block)
    clear = CLEAR * size
    at = vacant.place((wide + 2.0 * clear, high + 2.0 * clear), corners) if block else None
    if at is None:
        return None
    left, top = at[0] + clear, at[1] + clear
    vacant.take((left, top, left + wide, top + high))
    return (left, top + 0.5 * LINE * size)


def _block(block: Sequence[Entry], at: Point, size: float, theme: Theme) -> list[Mark]:
    x, y = at
    return [mark for k, entry in enumerate(block) for mark in _entry(entry, (x, y + LINE * size * k), size, theme)]


def _entry(entry: Entry, at: Point, size: float, theme: Theme) -> list[Mark]:
    name = f"legend-{entry.what}"
    x, y = at
    words = Text(name, (x + entry.indent * size, y), entry.words, size, theme.text, "start")
    if entry.what == "lights":
        return [words]
    if entry.what in STYLES:
        return [ray_sample(entry.what, (x, y), 2.0 * size, theme.ray(entry.what)), words]
    if entry.what == CUT:
        return [*signs.cut(name, (x + 0.5 * size, y), size, theme.muted), words]
    if not entry.stub:
        return [*signs.light_end(entry.what, name, (x + 0.5 * size, y), size, theme), words]
    stroke = Stroke(theme.ray("shadow"), STYLES["shadow"].width, FATE[entry.what].dash)
    stub = Line(name, (x, y), (x + 1.1 * size, y), stroke)
    return [stub, *signs.light_end(entry.what, name, (x + 1.6 * size, y), size, theme), words]

"""The index of refraction as a ratio of speeds, n = c/v: a table of media, with a bar for each speed."""

import math
from dataclasses import dataclass

from tracer.formulas.media import INDICES
from viewer.base.theme import faded
from viewer.base.wording import format_number
from viewer.figures.font import text_width
from viewer.figures.layout.hit_frame import MARGIN
from viewer.figures.marks import Box, Disc, Handle, Line, Mark, Stroke, Text, widened
from viewer.lessons.live.piece import LiveContext, Parameters

SPEED = 299_792.458  # km/s, of light in vacuum (exact, by the definition of the metre)
FIRST = ("air", "water", "glass", "diamond", "vacuum")  # media that are shown where there is room for few
RANGE = (1.0, 2.5)  # of the handle
STEPS = 60  # of its path
REST = 5.4  # height of all but the rows, in text sizes
ROW, GAP = 1.55, 1.0  # height of a row, and between columns, in text sizes
LEAST = 6.0  # width of the bars, in text sizes
BAR, TINT = 0.62, 0.14  # height of a bar, in text sizes; opacity of an emphasised row


@dataclass(frozen=True)
class _Row:
    name: str
    n: float
    emphasised: bool


def media(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The table, with the media of the hit, or of the parameters `n1` and `n2`, emphasised. The handle is `n`."""
    size, theme = context.size, context.theme
    left, top, right, bottom = widened(context.where, -MARGIN * size)
    emphasised = _emphasised(context, parameters)
    n = parameters.get("n", emphasised[-1] if emphasised else INDICES["water"])
    if not RANGE[0] <= n <= RANGE[1]:
        if "n" in parameters:
            raise ValueError(f"media: n must be from {RANGE[0]:g} to {RANGE[1]:g}, got {n:g}")
        n = min(max(n, RANGE[0]), RANGE[1])
    rows = _rows(emphasised, int(((bottom - top) / size - REST) / ROW))
    names = max(text_width(row.name, size) for row in rows)
    numbers = max(text_width(f"{row.n:.4f}", size) for row in rows)
    speeds = text_width("km/s 000", size)
    columns = [left + names, left + names + GAP * size + numbers]
    columns.append(columns[1] + GAP * size + speeds)
    start = columns[2] + GAP * size
    with_speed = right - start >= LEAST * size
    start = start if with_speed else columns[1] + GAP * size
    wide = right - start - 0.5 * size  # of a bar for c
    y = top + 0.5 * ROW * size
    heads = [("medium", left, "start"), ("n = c/v", columns[1], "end")]
    heads += [("v (km/s)", columns[2], "end")] if with_speed else []
    titles = ("speed of light v", "speed v", "v")
    heads.append(
        (next(words for words in titles if text_width(words, size) <= right - start or words == "v"), start, "start")
    )
    marks: list[Mark] = [Text("head", (x, y), words, size, theme.muted, anchor) for words, x, anchor in heads]
    marks.append(Line("head", (left, y + 0.5 * ROW * size), (right, y + 0.5 * ROW * size), Stroke(theme.border, 1.2)))
    for k, row in enumerate(rows):
        y = top + (k + 1.5) * ROW * size
        name, title = f"medium-{row.name}", f"{row.name}: v = {SPEED / row.n:.0f} km/s"
        place, extent = (0.5 * (left + right), y), (right - left, ROW * size)
        tint = faded(theme.accent, TINT) if row.emphasised else None
        marks.append(Box(name, place, extent, 3.0, tint, None, title=title))  # all of the row can be clicked
        ink = theme.accent if row.emphasised else theme.text
        marks.append(Text(name, (left + 0.2 * size, y), row.name, size, ink, "start", title=title))
        marks.append(Text(name, (columns[1], y), format_number(row.n), size, ink, "end"))
        if with_speed:
            marks.append(Text(name, (columns[2], y), f"{SPEED / row.n:,.0f}".replace(",", " "), size, ink, "end"))
        length = wide / row.n
        color = theme.accent if row.emphasised else theme.glass
        marks.append(Box(name, (start + 0.5 * length, y), (length, BAR * size), 2.0, color, None, title=title))
    axis = top + (len(rows) + 1.7) * ROW * size
    marks += _axis(context, start, wide, axis)
    path = tuple((start + wide / value, axis) for value in _steps())
    marks.append(
        Line("n", (start + wide / n, top + ROW * size), (start + wide / n, axis), Stroke(theme.text, 1.4, (3.0, 3.0)))
    )
    marks.append(Disc("n", (start + wide / n, axis), 0.28 * size, theme.text, None))
    marks.append(Handle("n", n, RANGE, path, theme.text, title="drag to change n"))
    words = f"n = {format_number(n, 4)}: v = c/n = {SPEED / n:,.0f} km/s".replace(",", " ")
    short = f"n = {format_number(n, 4)}"
    content = words if text_width(words, size) <= right - left else short
    marks.append(Text("n", (left, axis + 2.25 * size), content, size, theme.text, "start"))
    return marks


def clicked(name: str) -> dict[str, float]:
    """A click on a medium puts the handle there, and makes it the medium behind the surface for other pieces."""
    kind, _, medium = name.partition("-")
    n = INDICES.get(medium) if kind == "medium" else None
    return {} if n is None else {"n": n, "n2": n}


def _steps() -> list[float]:
    return [RANGE[0] + (RANGE[1] - RANGE[0]) * k / STEPS for k in range(STEPS + 1)]


def _axis(context: LiveContext, start: float, wide: float, y: float) -> list[Mark]:
    """Speeds from 0 to c, below the bars."""
    size, theme = context.size, context.theme
    marks: list[Mark] = [Line("axis", (start, y), (start + wide, y), Stroke(theme.text, 1.4))]
    for share, words in ((0.0, "0"), (0.5, "c/2"), (1.0, "c")):
        x = start + share * wide
        marks.append(Line("axis", (x, y), (x, y + 0.25 * size), Stroke(theme.text, 1.4)))
        marks.append(Text("axis", (x, y + 0.9 * size), words, size, theme.muted))
    return marks


def _emphasised(context: LiveContext, parameters: Parameters) -> list[float]:
    """The indices of the parameters, or of the hit."""
    given = [parameters[name] for name in ("n1", "n2") if name in parameters]
    for n in given:
        if not 0.0 < n < math.inf:
            raise ValueError(f"media: an index must be a number above 0, got {n:g}")
    if given or context.tree is None:
        return given
    row = context.tree.nodes[context.row]
    return [float(row[name]) for name in ("n1", "n2") if not math.isnan(row[name])]


def _rows(emphasised: list[float], most: int) -> list[_Row]:
    """The media that have room, by their index: the emphasised ones first, then `FIRST`, then the others."""
    found = {f"n = {format_number(n)}": n for n in emphasised if n not in INDICES.values()}
    found |= {name: n for name, n in INDICES.items() if n in emphasised}
    found |= {name: INDICES[name] for name in FIRST}
    kept = list((found | INDICES).items())[: max(most, len(emphasised), 1)]
    return [_Row(name, n, n in emphasised) for name, n in sorted(kept, key=lambda item: item[1])]

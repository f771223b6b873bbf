"""A formula as outlines, which every writer can draw, and its size, which layouts need.

The lecture's formulas are shipped typeset, in `outlines.json`, which `shipping` writes. Others are typeset when they
are needed.
"""

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from viewer.explain.plain_formula import joined, plain
from viewer.figures.formula import UNITS

SHIPPED = Path(__file__).parent / "outlines.json"

Segment = tuple[float, ...]  # the end of a line (x, y), or control point and end of a parabola (x, y, x, y)
Contour = tuple[Segment, ...]  # closed; the first segment is its start
Outline = tuple[Contour, ...]  # of a glyph or a bar
Box = tuple[float, float, float, float]  # left, top, right, bottom


@dataclass(frozen=True)
class Typeset:
    """A formula of size 1. Lengths are ems, from the left end of its baseline, y downwards."""

    box: Box  # around the outlines; as wide as the formula, with the space before and after its signs
    outlines: tuple[Outline, ...]


@lru_cache(maxsize=1024)
def typeset(source: str) -> Typeset:
    """The formula of this source. FormulaError for what is not in the part of LaTeX that `plain_formula` reads."""
    plain(source)
    source = joined(source)
    shipped = _shipped()
    if (found := shipped["formulas"].get(source)) is not None:
        width, *placed = found
        return make_typeset(width, (outline(shipped["glyphs"][k], x, y) for k, x, y in placed))
    from viewer.figures.formula.ziamath_paths import paths

    width, found = paths(source)
    return make_typeset(width, map(outline, found))


@cache
def _shipped() -> dict[str, Any]:
    return json.loads(SHIPPED.read_text("utf-8"))


def make_typeset(width: float, outlines: Iterable[Outline]) -> Typeset:
    """The formula of these outlines. `width` in units."""
    made = tuple(outlines)
    places = [s[k : k + 2] for contours in made for contour in contours for s in contour for k in range(0, len(s), 2)]
    xs, ys = zip(*places, strict=True)
    # A parabola is inside the triangle of its control points.
    return Typeset((min(0.0, *xs), min(ys), max(width / UNITS, *xs), max(ys)), made)


_COMMAND = re.compile(r"([MLQZ])([^MLQZ]*)")


def outline(path: str, x: float = 0.0, y: float = 0.0) -> Outline:
    """The outline of an SVG path with the commands M, L, Q and Z, in units, moved by (x, y)."""
    contours: list[Contour] = []
    current: list[Segment] = []
    for command, numbers in _COMMAND.findall(path):
        places = [float(number) for number in numbers.split()]
        moved = tuple((place + (y if k % 2 else x)) / UNITS for k, place in enumerate(places))
        if command in "MZ" and len(current) > 1:
            contours.append(tuple(current))
        if command in "MZ":
            current = []
        if moved and (not current or moved[-2:] != current[-1][-2:]):
            current.append(moved)
    return tuple(contours)

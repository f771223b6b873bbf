"""The widths of texts. Figures are laid out for DejaVu Sans, whose font file is part of this package. If another
program replaces the font, its letters are narrower in nearly all cases, so that nothing overlaps.

The file has the Latin, Greek, Cyrillic, Armenian and Georgian letters of DejaVu Sans 2.37, and the signs of
formulas. Other characters need a font of the program that shows the figure.
"""

import unicodedata
from collections.abc import Sequence
from functools import cache
from pathlib import Path

FONT = Path(__file__).parent.parent / "fonts" / "DejaVuSans-figures.ttf"
FAMILY = "DejaVu Sans"
FALLBACK = ("Verdana", "Helvetica", "Arial", "sans-serif")

# Distances from the baseline, relative to the font's size: to the top of a capital, an ascender, a descender.
CAPITAL, ASCENT, DESCENT = 0.729, 0.78, 0.24
BASELINE = 0.5 * CAPITAL  # from the middle of a line of text down to its baseline
ANCHORS = {"start": 0.0, "middle": 0.5, "end": 1.0}  # the share of a text's width that is left of its place

_UNITS = 2048  # units per em of the font: widths are exact


@cache
def _font():
    from PIL import ImageFont

    return ImageFont.truetype(FONT, _UNITS, layout_engine=ImageFont.Layout.BASIC)


@cache
def letters() -> frozenset[int]:
    """The code points that the font has."""
    from fontTools.ttLib import TTFont

    with TTFont(FONT, lazy=True) as font:
        return frozenset(font.getBestCmap() or ())


def has(letter: str) -> bool:
    return ord(letter) in letters()


def boxed(content: str) -> str:
    """The text with a box for each letter that the font lacks."""
    return "".join(letter if has(letter) else "□" for letter in content)


@cache
def text_width(content: str, size: float) -> float:
    """The width of a text in points. East Asian letters, which the font lacks, are as wide as they are high."""
    return sum(map(_advance, content)) * size / _UNITS


@cache
def _advance(letter: str) -> float:
    """The width of a letter. The font has no kerning: a text is as wide as its letters together."""
    return float(_UNITS) if unicodedata.east_asian_width(letter) in "WF" else _font().getlength(letter)


def fitted(content: str, wide: float, size: float) -> str:
    """The text, cut to fit the width."""
    if text_width(content, size) <= wide:
        return content
    while content and text_width(f"{content}…", size) > wide:
        content = content[:-1].rstrip()
    return f"{content}…"


def wrapped(parts: Sequence[str], wide: float, size: float) -> list[str]:
    """The parts of a list in lines of at most this width, with commas; a part that is wider has a line of its own."""
    lines: list[str] = []
    for k, part in enumerate(parts):
        words = f"{part}," if k + 1 < len(parts) else part
        if lines and text_width(f"{lines[-1]} {words}", size) <= wide:
            lines[-1] = f"{lines[-1]} {words}"
        else:
            lines.append(words)
    return lines


def text_box(at: tuple[float, float], content: str, size: float, anchor: str) -> tuple[float, float, float, float]:
    """(left, top, right, bottom) of a line of text. `at` is its left end, middle or right end, as `anchor` says."""
    width = text_width(content, size)
    left = at[0] - ANCHORS[anchor] * width
    baseline = at[1] + BASELINE * size
    return (left, baseline - ASCENT * size, left + width, baseline + DESCENT * size)

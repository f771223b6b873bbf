"""How wide text is. Figures are laid out for DejaVu Sans, which they carry; where a program puts another font in its
place, that is narrower in all but a few cases, so nothing comes to overlap.

The file holds of DejaVu Sans 2.37 the letters of Latin, Greek, Cyrillic, Armenian and Georgian, and the signs of
formulas; other letters are for the program that shows a figure to find.
"""

import unicodedata
from functools import cache
from pathlib import Path

FONT = Path(__file__).parent.parent / "fonts" / "DejaVuSans-figures.ttf"
FAMILY = "DejaVu Sans"
FALLBACK = ("Verdana", "Helvetica", "Arial", "sans-serif")

# Of the font's size: from the baseline to a capital's top, to an ascender's, to a descender's.
CAPITAL, ASCENT, DESCENT = 0.729, 0.78, 0.24
BASELINE = 0.5 * CAPITAL  # below the middle of a line of text
ANCHORS = {"start": 0.0, "middle": 0.5, "end": 1.0}  # which share of a text's width stands left of its place

_UNITS = 2048  # the font's own: widths come out exact


@cache
def _font():
    from PIL import ImageFont

    return ImageFont.truetype(FONT, _UNITS, layout_engine=ImageFont.Layout.BASIC)


@cache
def letters() -> frozenset[int]:
    """What the font has, as code points."""
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
    """In points. Letters of East Asia, which the font lacks, are as wide as they are high."""
    wide = sum(unicodedata.east_asian_width(letter) in "WF" for letter in content)
    if wide:
        content = "".join(letter for letter in content if unicodedata.east_asian_width(letter) not in "WF")
    return wide * size + _font().getlength(content) * size / _UNITS


def fitted(content: str, wide: float, size: float) -> str:
    """The text, cut so that it is no wider than that."""
    if text_width(content, size) <= wide:
        return content
    while content and text_width(f"{content}…", size) > wide:
        content = content[:-1].rstrip()
    return f"{content}…"


def text_box(at: tuple[float, float], content: str, size: float, anchor: str) -> tuple[float, float, float, float]:
    """(left, top, right, bottom) of a line of text whose middle, left or right end stands at `at`."""
    width = text_width(content, size)
    left = at[0] - ANCHORS[anchor] * width
    baseline = at[1] + BASELINE * size
    return (left, baseline - ASCENT * size, left + width, baseline + DESCENT * size)

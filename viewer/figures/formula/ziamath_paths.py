"""Typesets a formula with ziamath, in STIX Two Math. The only file that uses it.

ziamath lays out by the font's MATH table, as TeX does by its fonts' parameters, needs no TeX, no locale and no network,
and takes some milliseconds per formula.
"""

import re
import threading
import xml.etree.ElementTree as ElementTree
from typing import Any

from viewer.explain.plain_formula import FUNCTIONS, FormulaError
from viewer.figures.formula import UNITS

_LOCK = threading.Lock()  # ziafont's setting is that of all threads


def paths(source: str) -> tuple[float, list[str]]:
    """(width, SVG paths with the commands M, L, Q, Z) of a formula, in units, from the left end of its baseline."""
    from ziafont.config import config
    from ziamath.zmath import Latex

    size: Any = UNITS
    with _LOCK:
        before, config.svg2 = config.svg2, False  # paths in the place of references to glyphs
        try:
            made = Latex(_spaced(source), size=size, margin=0.0)
            drawn = made.svgxml()
            width = float(made.node.bbox.xmax)
        except Exception as error:  # of no type of its own
            raise FormulaError(f"formula {source!r} cannot be typeset: {_reason(error)}") from None
        finally:
            config.svg2 = before
    found = [path for element in drawn.iter() if (path := _path(element))]
    if not found:
        raise FormulaError(f"formula {source!r} is empty")
    return width, found


def _reason(error: Exception) -> str:
    """An exception in one line."""
    return " ".join(str(error).split()) or type(error).__name__


def _spaced(source: str) -> str:
    """The source with TeX's thin spaces around the names of functions, which ziamath leaves out."""
    names = "|".join(FUNCTIONS)
    source = re.sub(rf"(?<=[\w}}])\s*(?=\\(?:{names})\b)", r"\\,", source)
    return re.sub(rf"(\\(?:{names}))\b\s*(?=[A-Za-z]|\\(?!left|frac))", r"\1\\,", source)


def _path(element: ElementTree.Element) -> str:
    """The path of a glyph, or of the bar of a fraction or a root, which winds as glyphs do."""
    match element.tag.rpartition("}")[2]:
        case "path":
            return element.get("d", "")
        case "rect":
            x, y, w, h = (float(element.get(key, 0.0)) for key in ("x", "y", "width", "height"))
            return f"M {x} {y} L {x + w} {y} L {x + w} {y + h} L {x} {y + h} Z"
        case _:
            return ""

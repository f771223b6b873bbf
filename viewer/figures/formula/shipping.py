"""Typesets the lecture's formulas and writes them to `outlines.json`: `python -m viewer.figures.formula.shipping`.

The glyphs that occur in several formulas are written once. Numbers are thousandths of an em.
"""

import json
import re

from viewer.base.files import write_atomically
from viewer.explain.formulas import Lecture
from viewer.explain.plain_formula import broken, joined, left_side
from viewer.figures.formula.typeset import SHIPPED
from viewer.figures.formula.ziamath_paths import paths

_PLACE = re.compile(r"(-?[\d.]+) (-?[\d.]+)")


def content() -> bytes:
    """The file's content."""
    glyphs: dict[str, int] = {}
    formulas: dict[str, list] = {}
    sources = {line for formula in Lecture for line in (joined(formula), *broken(formula), left_side(formula))}
    for source in sorted(sources):
        width, found = paths(source)
        placed = []
        for path in found:
            relative, x, y = _relative(path)
            placed.append([glyphs.setdefault(relative, len(glyphs)), x, y])
        formulas[source] = [round(width, 1), *placed]
    lines = [json.dumps({source: placed}, separators=(",", ":"))[1:-1] for source, placed in formulas.items()]
    text = '{"glyphs":[\n%s\n],"formulas":{\n%s\n}}\n'
    return (text % (",\n".join(map(json.dumps, glyphs)), ",\n".join(lines))).encode("utf-8")


def _relative(path: str) -> tuple[str, float, float]:
    """The path, moved so that it starts at (0, 0), and its start."""
    places = [(float(x), float(y)) for x, y in _PLACE.findall(path)]
    x, y = places[0]
    rest = iter(places)

    def moved(_: re.Match) -> str:
        px, py = next(rest)
        return f"{_number(px - x)} {_number(py - y)}"

    return re.sub(r"\s*([MLQZ])\s*", r"\1", _PLACE.sub(moved, path)), round(x, 1), round(y, 1)


def _number(x: float) -> str:
    return f"{round(x, 1) + 0.0:g}"


if __name__ == "__main__":
    write_atomically(SHIPPED, content())

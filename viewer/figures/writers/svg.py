"""Figures as SVG: text as text, marks of one name in a group with that name, attributes that every program reads.

`groups` and `outline_path` are also what figures and formulas in HTML are made of.
"""

from base64 import b64encode
from collections.abc import Callable, Iterable
from xml.sax.saxutils import escape, quoteattr

from viewer.base.theme import Color, rgb_bytes
from viewer.figures.font import BASELINE, FALLBACK, FAMILY
from viewer.figures.formula.typeset import Contour
from viewer.figures.marks import Box, Disc, Figure, Formula, Line, Mark, Point, Raster, Shape, Stroke, Text
from viewer.figures.writers.arrows import heads
from viewer.figures.writers.raster import raster_png
from viewer.reopen.places import as_xml

FONT = f"font-family={quoteattr(', '.join((repr(FAMILY), *FALLBACK)))}"  # the attribute of the root element


def write_svg(figure: Figure) -> bytes:
    w, h = _n(figure.width), _n(figure.height)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}pt" height="{h}pt" viewBox="0 0 {w} {h}" role="img"'
        f" {FONT}>",
        f"<title>{escape(figure.title)}</title>",
        f"<desc>{escape(figure.description)}</desc>",
        f"<metadata>{escape(figure.command)}{as_xml(figure.embedded) if figure.embedded else ''}</metadata>",
    ]
    known: set[str] = set()

    def group(name: str, title: str, content: list[str]) -> str:
        # An id occurs once in a file: later groups of the same name have it as their class.
        kind = "class" if name in known else "id"
        known.add(name)
        return "\n".join([f"<g {kind}={quoteattr(name)}>{title_element(title)}", *content, "</g>"])

    return "\n".join([*lines, *groups(figure, group), "</svg>", ""]).encode("utf-8")


def groups(figure: Figure, group: Callable[[str, str, list[str]], str]) -> Iterable[str]:
    """The elements of a figure: its background, if it has one, and a group for each run of marks of one name.

    `group` returns such a group from the name and the title of its marks and their elements.
    """
    if figure.ground:
        yield f'<rect width="{_n(figure.width)}" height="{_n(figure.height)}"{_fill(figure.paper)}/>'
    for name, title, marks in figure.groups():
        yield group(name, title, [element for mark in marks for element in elements(mark)])


def title_element(title: str) -> str:
    """The element that programs show as a tooltip; empty without a title."""
    return f"\n<title>{escape(title)}</title>" if title else ""


def outline_path(outlines: Iterable[Iterable[Contour]]) -> str:
    """The outlines of a formula as path data."""
    return "".join(_contour(contour) for outline in outlines for contour in outline)


def elements(mark: Mark) -> list[str]:
    """The elements of one mark."""
    match mark:
        case Box():
            (x, y), (w, h) = mark.center, mark.size
            place = f'x="{_n(x - 0.5 * w)}" y="{_n(y - 0.5 * h)}" width="{_n(w)}" height="{_n(h)}"'
            return [f'<rect {place} rx="{_n(mark.radius)}"{_fill(mark.fill)}{_stroke(mark.stroke)}/>']
        case Raster():
            (x, y), (w, h) = mark.center, mark.size
            place = f'x="{_n(x - 0.5 * w)}" y="{_n(y - 0.5 * h)}" width="{_n(w)}" height="{_n(h)}"'
            look = 'preserveAspectRatio="none" image-rendering="pixelated"'
            return [f'<image {place} {look} href="data:image/png;base64,{b64encode(raster_png(mark)).decode()}"/>']
        case Disc():
            place = f'cx="{_n(mark.center[0])}" cy="{_n(mark.center[1])}" r="{_n(mark.radius)}"'
            return [f"<circle {place}{_fill(mark.fill)}{_stroke(mark.stroke)}/>"]
        case Shape() if mark.holes:
            path = " ".join(f"M{' L'.join(map(_point, ring))} Z" for ring in (mark.corners, *mark.holes))
            return [f'<path d="{path}" fill-rule="evenodd"{_fill(mark.fill)}{_stroke(mark.stroke)}/>']
        case Shape():
            points = " ".join(_point(corner) for corner in mark.corners)
            element = "polygon" if mark.closed else "polyline"
            return [f'<{element} points="{points}"{_fill(mark.fill)}{_stroke(mark.stroke)}/>']
        case Line():
            return _line(mark)
        case Text():
            place = f'x="{_n(mark.at[0])}" y="{_n(mark.at[1] + BASELINE * mark.size)}" font-size="{_n(mark.size)}"'
            kept = ' xml:space="preserve"' if "  " in mark.content else ""
            text = f'<text {place} text-anchor="{mark.anchor}"{_fill(mark.color)}{kept}>{escape(mark.content)}</text>'
            return [text]
        case Formula():
            said = f'role="img" aria-label={quoteattr(mark.plain)} data-tex={quoteattr(mark.source)}'
            return [f'<path {said} d="{outline_path(mark.outlines())}"{_fill(mark.color)}/>']
        case _:
            raise TypeError(f"no SVG for {type(mark).__name__}")


def _contour(contour: Contour) -> str:
    start, *rest = contour
    path = f"M{_n(start[0])},{_n(start[1])}"
    for segment in rest:
        path += ("L" if len(segment) == 2 else "Q") + " ".join(map(_n, segment))
    return f"{path}Z"


def _line(line: Line) -> list[str]:
    pieces = " ".join(f"M{_point(a)} L{_point(b)}" for a, b in line.pieces())
    found = [f'<path d="{pieces}" fill="none"{_stroke(line.stroke)}/>']
    for corners, filled in heads(line):
        path = f"M{_point(corners[0])} L{_point(corners[1])} L{_point(corners[2])}"
        if filled:
            found.append(f'<path d="{path} Z"{_fill(line.stroke.color)}/>')
        else:
            solid = Stroke(line.stroke.color, line.stroke.width)
            found.append(f'<path d="{path}" fill="none"{_stroke(solid)}/>')
    return found


def _fill(color: Color | None) -> str:
    return ' fill="none"' if color is None else _paint("fill", color)


def _stroke(stroke: Stroke | None) -> str:
    if stroke is None:
        return ""
    dash = f' stroke-dasharray="{_n(stroke.dash[0])} {_n(stroke.dash[1])}"' if any(stroke.dash) else ""
    return f'{_paint("stroke", stroke.color)} stroke-width="{_n(stroke.width)}"{dash}'


def _paint(what: str, color: Color) -> str:
    r, g, b = rgb_bytes(color)
    opacity = f' {what}-opacity="{_n(color[3])}"' if color[3] < 1.0 else ""
    return f' {what}="#{r:02X}{g:02X}{b:02X}"{opacity}'


def _point(p: Point) -> str:
    return f"{_n(p[0])},{_n(p[1])}"


def _n(x: float) -> str:
    """Two decimals: a fiftieth of a pixel on a large screen."""
    text = f"{x:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text

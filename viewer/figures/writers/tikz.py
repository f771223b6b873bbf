r"""Figures as TikZ: a file that LaTeX compiles by itself, and that a Beamer slide includes with \input.

By itself, it loads the class `standalone`. If a document class is loaded already, only the picture is read.
"""

from viewer.base.theme import Color, rgb_bytes
from viewer.figures.marks import Box, Disc, Figure, Formula, Line, Mark, Point, Raster, Shape, Stroke, Text
from viewer.figures.writers.arrows import heads
from viewer.figures.writers.raster import raster_runs

# TeX's special characters, and letters that its usual fonts lack.
SIGNS = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "%": r"\%", "_": r"\_",
    "^": r"\textasciicircum{}", "~": r"\textasciitilde{}", "×": r"\(\times\)", "−": r"\(-\)", "·": r"\(\cdot\)",
    "→": r"\(\to\)", "θ": r"\(\theta\)", "η": r"\(\eta\)", "Σ": r"\(\Sigma\)", "√": r"\(\surd\)", "≥": r"\(\geq\)",
    "≤": r"\(\leq\)", "≈": r"\(\approx\)", "∞": r"\(\infty\)", "₁": r"\textsubscript{1}", "₂": r"\textsubscript{2}",
    "ₛ": r"\textsubscript{s}", "ₚ": r"\textsubscript{p}", "²": r"\textsuperscript{2}", "ᵖ": r"\textsuperscript{p}",
    "°": r"\textdegree{}", "…": r"\ldots{}", "–": "--",
}  # fmt: skip
LATIN = 0x180  # the usual fonts have all letters below
BOX = r"\fbox{\phantom{x}}"  # in the place of other letters


def write_tikz(figure: Figure) -> bytes:
    body = ["\\begin{tikzpicture}[x=1bp,y=-1bp,line cap=butt,line join=round,inner sep=0]"]
    w, h = _n(figure.width), _n(figure.height)
    ground = f"\\fill[{_ink('fill', figure.paper)}] " if figure.ground else "\\path[use as bounding box] "
    body.append(f"{ground}(0,0) rectangle ({w},{h});")
    for name, title, group in figure.groups():
        body.append(f"% {name}{': ' if title else ''}{' '.join(title.split())}")
        for mark in group:
            body += _draw(mark)
    body.append("\\end{tikzpicture}")
    lines = [
        *(f"% {' '.join(said.split())}" for said in (figure.title, figure.description, figure.command)),
        "% Alone: pdflatex of this file. In a Beamer slide: \\usepackage{tikz,standalone}, then",
        "% \\resizebox{\\textwidth}{!}{\\input{this file}}",
        "\\documentclass[tikz]{standalone}",
        "\\usepackage[utf8]{inputenc}",
        "\\usepackage[T1]{fontenc}",
        "\\usepackage{textcomp}",
        "\\usepackage[scaled]{helvet}",
        "\\begin{document}",
        "\\sffamily",
        *body,
        "\\end{document}",
        "",
    ]
    return "\n".join(lines).encode("utf-8")


def _draw(mark: Mark) -> list[str]:
    match mark:
        case Box():
            (x, y), (w, h) = mark.center, mark.size
            options = f"{_options(mark.fill, mark.stroke)},rounded corners={_n(mark.radius)}bp"
            return [f"\\path[{options}] {_point((x - w / 2, y - h / 2))} rectangle {_point((x + w / 2, y + h / 2))};"]
        case Raster():  # a picture would be a file of its own
            return [
                f"\\fill[{_ink('fill', color)}] {_point(first)} rectangle {_point(last)};"
                for color, first, last in raster_runs(mark)
            ]
        case Disc():
            return [
                f"\\path[{_options(mark.fill, mark.stroke)}] {_point(mark.center)} circle[radius={_n(mark.radius)}bp];"
            ]
        case Shape() if mark.holes:
            rings = " ".join(" -- ".join(map(_point, ring)) + " -- cycle" for ring in (mark.corners, *mark.holes))
            return [f"\\path[{_options(mark.fill, mark.stroke)},even odd rule] {rings};"]
        case Shape():
            corners = " -- ".join(_point(corner) for corner in mark.corners)
            return [f"\\path[{_options(mark.fill, mark.stroke)}] {corners}{' -- cycle' if mark.closed else ''};"]
        case Line():
            pieces = " ".join(f"{_point(a)} -- {_point(b)}" for a, b in mark.pieces())
            found = [f"\\path[{_options(None, mark.stroke)}] {pieces};"]
            for corners, filled in heads(mark):
                color = mark.stroke.color
                options = _options(color, None) if filled else _options(None, Stroke(color, mark.stroke.width))
                found.append(f"\\path[{options}] {' -- '.join(map(_point, corners))}{' -- cycle' if filled else ''};")
            return found
        case Text():
            place = _point((mark.at[0], mark.at[1] + 0.36 * mark.size))
            return [f"{_node(mark.anchor, mark.size, mark.color)} at {place} {{{escaped(mark.content)}}};"]
        case Formula():
            math = f"\\(\\displaystyle {mark.source}\\)"
            return [f"{_node(mark.anchor, mark.size, mark.color)} at {_point(mark.at)} {{{math}}};"]
        case _:
            raise TypeError(f"no TikZ for {type(mark).__name__}")


def _node(anchor: str, size: float, color: Color) -> str:
    """The start of a node whose baseline is at its place."""
    side = {"start": "base west", "middle": "base", "end": "base east"}[anchor]
    font = f"\\fontsize{{{_n(size)}bp}}{{{_n(1.2 * size)}bp}}\\selectfont"
    return f"\\node[anchor={side},font={font},{_ink('text', color)}]"


def escaped(text: str) -> str:
    found = "".join(SIGNS.get(letter, letter) if has(letter) else BOX for letter in text)
    return found.replace("  ", r"\ \ ")  # TeX takes several spaces for one


def has(letter: str) -> bool:
    return letter in SIGNS or ord(letter) < LATIN


def _options(fill: Color | None, stroke: Stroke | None) -> str:
    options = []
    if fill:
        options.append(_ink("fill", fill))
    if stroke:
        options += [_ink("draw", stroke.color), f"line width={_n(stroke.width)}bp"]
        if any(stroke.dash):
            options.append(f"dash pattern=on {_n(stroke.dash[0])}bp off {_n(stroke.dash[1])}bp")
    return ",".join(options)


def _ink(what: str, color: Color) -> str:
    r, g, b = rgb_bytes(color)
    opacity = f",{what} opacity={_n(color[3])}" if color[3] < 1.0 else ""
    return f"{what}={{rgb,255:red,{r};green,{g};blue,{b}}}{opacity}"


def _point(p: Point) -> str:
    return f"({_n(p[0])},{_n(p[1])})"


def _n(x: float) -> str:
    return f"{x:.2f}"

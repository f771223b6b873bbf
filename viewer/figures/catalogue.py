"""The lists of figures, steps and file formats. A new one needs a function in its own file and a line here.

Functions are named as "module:function" and imported when they are first used, so that this list is quick to read
for the command line and the window's menus.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pkgutil import resolve_name
from typing import TYPE_CHECKING

from viewer.reopen.view_state import GRANULARITIES, ORDERS

if TYPE_CHECKING:
    from tracer.tree.raytree import RayTree
    from viewer.figures.marks import Figure


@dataclass(frozen=True)
class FigureKind:
    """A figure. Its function takes (Subject, FigureStyle) and returns the marks of each page."""

    name: str
    title: str  # in menus
    function: str
    options: tuple[str, ...] = ()  # of `raytree export`, that apply to some figures only


FIGURES = (
    FigureKind(
        "both",
        "Scene and tree",
        "viewer.figures.figure.both:pages",
        ("view", "swatches", "levels", "select", "fold", "eye"),
    ),
    FigureKind("tree", "Ray tree", "viewer.figures.figure.tree:pages", ("swatches", "levels", "select", "fold", "eye")),
    FigureKind("scene", "Scene", "viewer.figures.figure.scene:pages", ("view", "select")),
    FigureKind("hit", "Selected hit", "viewer.figures.figure.hit:pages", ("node", "turn")),
)
FIGURE_NAMES = tuple(kind.name for kind in FIGURES)

# One page per depth, with whole trees; or one tree, in which rays appear by level or one by one, and then colours are
# summed up; or only the latter.
STEPS = ("depth", *GRANULARITIES, "colour")
BREADTH, RECURSION = ORDERS  # of rays and sums: the kernel's, or a recursive procedure's


@dataclass(frozen=True)
class FormatKind:
    """A file format of figures, or of a tree's data."""

    name: str
    title: str  # in menus
    suffix: str
    figures: str = ""  # function of (Figure), or of (Sequence[Figure]) with `many_pages`; returns bytes
    data: str = ""  # function of (RayTree); returns str
    many_pages: bool = False  # one file holds all pages
    has_width: bool = False  # `figures` takes the width in pixels as well
    on_screen: bool = False  # it shows `Figure.details` and `Figure.upright`
    letters: str = ""  # function of (character): whether the format can show it. Empty: it can show every character

    def write(self, pages: Sequence[Figure], width: int) -> bytes:
        """The file of these pages. A format without pages takes the first. `width` in pixels counts in PNG only."""
        function = resolve_name(self.figures)
        content = pages if self.many_pages else pages[0]
        return function(content, width) if self.has_width else function(content)

    def text(self, tree: RayTree) -> str:
        """The tree's data."""
        return resolve_name(self.data)(tree)

    def missing_letters(self, content: str) -> str:
        """The letters of a text that the format cannot show, each once."""
        if not self.letters:
            return ""
        can_show: Callable[[str], bool] = resolve_name(self.letters)
        return "".join(letter for letter in dict.fromkeys(content) if not can_show(letter))


FORMATS = {
    kind.name: kind
    for kind in (
        FormatKind("svg", "SVG", ".svg", "viewer.figures.writers.svg:write_svg"),
        FormatKind(
            "pdf", "PDF", ".pdf", "viewer.figures.writers.pdf:write_pdf", many_pages=True,
            letters="viewer.figures.font:has",
        ),
        FormatKind(
            "png", "PNG", ".png", "viewer.figures.writers.png:write_png", has_width=True,
            letters="viewer.figures.font:has",
        ),
        FormatKind(
            "tikz", "TikZ", ".tex", "viewer.figures.writers.tikz:write_tikz", letters="viewer.figures.writers.tikz:has"
        ),
        FormatKind("pptx", "PPTX", ".pptx", "viewer.figures.writers.pptx:write_pptx", many_pages=True),
        FormatKind(
            "html", "HTML", ".html", "viewer.figures.writers.html.figure_page:write_html", many_pages=True,
            on_screen=True,
        ),
        FormatKind("dot", "Graphviz", ".dot", data="viewer.figures.writers.dot:write_dot"),
        FormatKind("csv", "CSV", ".csv", data="viewer.figures.writers.csv:write_csv"),
        FormatKind("json", "JSON", ".json", data="tracer.tree.raytree:RayTree.to_json"),
        FormatKind("text", "text", ".txt", data="tracer.tree.raytree:RayTree.to_text"),
    )
}  # fmt: skip
PICTURES = tuple(name for name, kind in FORMATS.items() if kind.figures)
DATA = tuple(name for name, kind in FORMATS.items() if kind.data)


def format_of(suffix: str) -> str | None:
    """The name of the format with this suffix."""
    return next((name for name, kind in FORMATS.items() if kind.suffix == suffix.lower()), None)

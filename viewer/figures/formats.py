"""What figures and their data are written as. A new format: a writer in a file of its own, a line in FORMATS."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tracer.tree.raytree import RayTree
from viewer.figures.font import has
from viewer.figures.marks import Figure

Pages = Sequence[Figure]


@dataclass(frozen=True)
class Format:
    """A kind of file. `write` takes figures, and the pixels across that only a PNG asks for; `data` takes the tree."""

    suffix: str
    write: Callable[[Pages, int], bytes] | None = None
    many_pages: bool = False
    data: Callable[[RayTree], str] | None = None
    has: Callable[[str], bool] = lambda letter: True  # whether it can show a letter


def _svg(pages: Pages, across: int) -> bytes:
    from viewer.figures.writers.svg import write_svg

    return write_svg(pages[0])


def _pdf(pages: Pages, across: int) -> bytes:
    from viewer.figures.writers.pdf import write_pdf

    return write_pdf(pages)


def _png(pages: Pages, across: int) -> bytes:
    from viewer.figures.writers.png import write_png

    return write_png(pages[0], across)


def _tikz(pages: Pages, across: int) -> bytes:
    from viewer.figures.writers.tikz import write_tikz

    return write_tikz(pages[0])


def _pptx(pages: Pages, across: int) -> bytes:
    from viewer.figures.writers.pptx import write_pptx

    return write_pptx(pages)


def _dot(tree: RayTree) -> str:
    from viewer.figures.writers.dot import write_dot

    return write_dot(tree)


def _csv(tree: RayTree) -> str:
    from viewer.figures.writers.csv import write_csv

    return write_csv(tree)


def _tikz_has(letter: str) -> bool:
    from viewer.figures.writers.tikz import has

    return has(letter)


FORMATS = {
    "svg": Format(".svg", _svg),
    "pdf": Format(".pdf", _pdf, many_pages=True, has=has),
    "png": Format(".png", _png, has=has),
    "tikz": Format(".tex", _tikz, has=_tikz_has),
    "pptx": Format(".pptx", _pptx, many_pages=True),
    "dot": Format(".dot", data=_dot),
    "csv": Format(".csv", data=_csv),
    "json": Format(".json", data=RayTree.to_json),
    "text": Format(".txt", data=RayTree.to_text),
}


def format_of(suffix: str) -> str | None:
    """The name of the format with this suffix."""
    return next((name for name, kind in FORMATS.items() if kind.suffix == suffix.lower()), None)

"""Figures as PDF, one page each: lines as lines, and text that can be selected, in an embedded font."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from viewer.base.srgb import srgb
from viewer.base.theme import Color, rgb_bytes
from viewer.figures.font import BASELINE, FAMILY, FONT, boxed, text_width
from viewer.figures.formula.typeset import Contour
from viewer.figures.marks import Box, Disc, Figure, Formula, Line, Mark, Point, Raster, Rectangle, Shape, Stroke, Text
from viewer.figures.writers.arrows import heads
from viewer.figures.writers.raster import raster_png
from viewer.reopen.places import ATTACHMENT

if TYPE_CHECKING:
    import numpy as np
    from fpdf import FPDF

UNDATED = datetime.datetime(2000, 1, 1, tzinfo=datetime.UTC)  # so that the same figure is the same file on every day
ROUND = 0.5522847498  # distance of a quarter circle's control points from its ends, in radii


def write_pdf(figures: Sequence[Figure]) -> bytes:
    pdf = new_document(figures[0])
    for figure in figures:
        page = PageDrawing(pdf, figure)
        for mark in figure.marks:
            page.draw(mark)
    return bytes(pdf.output())


def new_document(first: Figure) -> FPDF:
    """A document without pages, with the title, the description, the command and the view of this figure."""
    from fpdf import FPDF, ViewerPreferences

    pdf = FPDF(unit="pt", format=(first.width, first.height))
    pdf.set_auto_page_break(False)
    pdf.set_margin(0)
    pdf.c_margin = 0
    pdf.set_creation_date(UNDATED)
    pdf.set_title(first.title)
    pdf.set_subject(first.description)
    pdf.set_keywords(first.command)
    pdf.set_creator("raytree")
    pdf.set_lang("en")
    pdf.viewer_preferences = ViewerPreferences(display_doc_title=True)
    pdf.add_font(FAMILY, "", FONT)
    if first.embedded:
        pdf.embed_file(
            bytes=first.embedded, basename=ATTACHMENT, mime_type="application/zip", modification_date=UNDATED
        )
    return pdf


class PageDrawing:
    """A new page of the size of a figure, with its background. Marks are drawn as PDF operators (ISO 32000-1, 8.5),
    which allow any dash and any outline.
    """

    def __init__(self, pdf: FPDF, figure: Figure) -> None:
        self.pdf, self.height = pdf, figure.height
        pdf.add_page(format=(figure.width, figure.height))
        if figure.ground:
            corners = ((0.0, 0.0), (figure.width, 0.0), (figure.width, figure.height), (0.0, figure.height))
            with self.artifact():
                self.path(corners, True, figure.paper, None)

    @contextmanager
    def tagged(self, kind: str, said: str = "") -> Iterator[None]:
        """Marks that are drawn inside are an element of the document's structure (ISO 32000-1, 14.8.4), like H1, P or
        Figure, with this alternative text.
        """
        number = self.pdf.struct_builder.next_mcid_for_page(self.pdf.page)
        self.pdf._add_marked_content(struct_type=f"/{kind}", mcid=number, alt_text=said or None)
        self.pdf._out(f"/{kind} <</MCID {number}>> BDC")
        yield
        self.pdf._out("EMC")

    @contextmanager
    def artifact(self) -> Iterator[None]:
        """What is drawn inside is not read out."""
        self.pdf._out("/Artifact BMC")
        yield
        self.pdf._out("EMC")

    def draw(self, mark: Mark) -> None:
        match mark:
            case Box():
                self._box(mark)
            case Raster(center=(x, y), size=(w, h)):
                self.pdf.image(raster_png(mark), x - 0.5 * w, y - 0.5 * h, w, h)
            case Disc():
                self._disc(mark)
            case Shape() if mark.holes:
                rings = [self._ring(ring, True) for ring in (mark.corners, *mark.holes)]
                self._paint([move for ring in rings for move in ring], mark.fill, mark.stroke, "*")
            case Shape():
                self.path(mark.corners, mark.closed, mark.fill, mark.stroke)
            case Line():
                for a, b in mark.pieces():
                    self.path((a, b), False, None, mark.stroke)
                for corners, filled in heads(mark):
                    color = mark.stroke.color
                    self.path(
                        corners, filled, color if filled else None, None if filled else Stroke(color, mark.stroke.width)
                    )
            case Text():
                self.text(mark)
            case Formula():
                self._formula(mark)
            case _:
                raise TypeError(f"no PDF for {type(mark).__name__}")

    def image(self, pixels: np.ndarray, where: Rectangle) -> None:
        """An image of linear colours (height, width, 3) in a rectangle."""
        from PIL import Image

        left, top, right, bottom = where
        self.pdf.image(Image.fromarray(srgb(pixels)), left, top, right - left, bottom - top)

    def path(self, corners: Sequence[Point], closed: bool, fill: Color | None, stroke: Stroke | None) -> None:
        self._paint(self._ring(corners, closed), fill, stroke)

    def _ring(self, corners: Sequence[Point], closed: bool) -> list[str]:
        moves = [f"{self._point(corner)} {'l' if k else 'm'}" for k, corner in enumerate(corners)]
        return [*moves, *(["h"] if closed else [])]

    def _paint(self, moves: list[str], fill: Color | None, stroke: Stroke | None, rule: str = "") -> None:
        if fill is None and stroke is None:
            return
        opacity = (fill[3] if fill else 1.0, stroke.color[3] if stroke else 1.0)
        with self.pdf.local_context(fill_opacity=opacity[0], stroke_opacity=opacity[1]):
            setup = ["0 J 1 j"]
            if fill:
                setup.append(f"{_rgb(fill)} rg")
            if stroke:
                dash = " ".join(_n(x) for x in stroke.dash) if any(stroke.dash) else ""
                setup.append(f"{_rgb(stroke.color)} RG {_n(stroke.width)} w [{dash}] 0 d")
            end = f"B{rule}" if fill and stroke else f"f{rule}" if fill else "S"
            self.pdf._out(" ".join([*setup, *moves, end]))

    def _box(self, box: Box) -> None:
        (x, y), (w, h), r = box.center, box.size, box.radius
        left, top, right, bottom, k = x - w / 2, y - h / 2, x + w / 2, y + h / 2, (1.0 - ROUND) * box.radius
        p = self._point
        moves = [
            f"{p((left + r, top))} m {p((right - r, top))} l",
            f"{p((right - k, top))} {p((right, top + k))} {p((right, top + r))} c {p((right, bottom - r))} l",
            f"{p((right, bottom - k))} {p((right - k, bottom))} {p((right - r, bottom))} c {p((left + r, bottom))} l",
            f"{p((left + k, bottom))} {p((left, bottom - k))} {p((left, bottom - r))} c {p((left, top + r))} l",
            f"{p((left, top + k))} {p((left + k, top))} {p((left + r, top))} c h",
        ]
        self._paint(moves, box.fill, box.stroke)

    def _disc(self, disc: Disc) -> None:
        self._box(Box(disc.name, disc.center, (2 * disc.radius, 2 * disc.radius), disc.radius, disc.fill, disc.stroke))

    def text(self, text: Text, bold: float = 0.0, apart: float = 0.0) -> None:
        """One line of text; its letters are `bold` points wider on every side, and stand `apart` points farther away
        from each other.
        """
        outlined = {"text_mode": "FILL_STROKE", "line_width": 2.0 * bold, "draw_color": rgb_bytes(text.color)}
        with self.pdf.local_context(fill_opacity=text.color[3], **(outlined if bold else {})):
            self.pdf.set_font(FAMILY, size=text.size)
            self.pdf.set_text_color(*rgb_bytes(text.color))
            if apart:
                self.pdf.set_char_spacing(apart)  # until the end of this context
            self.pdf.text(text.box()[0], text.at[1] + BASELINE * text.size, boxed(text.content))

    def _formula(self, formula: Formula) -> None:
        """The outlines, and over them, invisible, the plain text, which can be searched and copied."""
        moves = [move for outline in formula.outlines() for contour in outline for move in self._contour(contour)]
        self._paint(moves, formula.color, None)
        left, _, right, _ = formula.box()
        said = boxed(formula.plain)
        with self.pdf.local_context(text_mode="INVISIBLE"):
            self.pdf.set_font(FAMILY, size=(right - left) / text_width(said, 1.0))
            self.pdf.text(left, formula.at[1], said)

    def _contour(self, contour: Contour) -> list[str]:
        """A closed contour. PDF has cubic curves only, to which parabolas are raised."""
        start, *rest = contour
        at = start[:2]
        moves = [f"{self._point(at)} m"]
        for segment in rest:
            end = segment[-2:]
            if len(segment) == 2:
                moves.append(f"{self._point(end)} l")
            else:
                controls = [
                    tuple((p + 2.0 * c) / 3.0 for p, c in zip(side, segment, strict=False)) for side in (at, end)
                ]
                moves.append(f"{' '.join(map(self._point, (*controls, end)))} c")
            at = end
        return [*moves, "h"]

    def _point(self, p: Sequence[float]) -> str:
        return f"{_n(p[0])} {_n(self.height - p[1])}"


def _rgb(color: Color) -> str:
    return " ".join(f"{x:.4f}" for x in color[:3])


def _n(x: float) -> str:
    return f"{x:.2f}" if math.isfinite(x) else "0"

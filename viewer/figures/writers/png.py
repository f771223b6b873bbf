"""Figures as PNG: the page of the PDF as pixels, so that both look the same. The background is transparent."""

import io
from dataclasses import replace

from viewer.base.pdfium import render_page
from viewer.figures.marks import Figure
from viewer.figures.writers.pdf import write_pdf
from viewer.reopen.places import KEYWORD, as_text

PIXELS = 1920  # the default width: a slide that fills a projector


def write_png(figure: Figure, width: int = PIXELS) -> bytes:
    from PIL.PngImagePlugin import PngInfo

    picture = render_page(write_pdf([replace(figure, embedded=b"")]), width / figure.width)
    info = PngInfo()
    for key, value in (("Title", figure.title), ("Description", figure.description), ("Source", figure.command)):
        info.add_itxt(key, value)
    if figure.embedded:
        info.add_itxt(KEYWORD, as_text(figure.embedded))
    buffer = io.BytesIO()
    picture.save(buffer, "PNG", pnginfo=info)
    return buffer.getvalue()

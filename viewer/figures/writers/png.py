"""Figures as PNG: the page of the PDF as pixels, so that both look the same. The background is transparent."""

import io
from typing import Any

from viewer.figures.marks import Figure
from viewer.figures.writers.pdf import write_pdf

PIXELS = 1920  # the default width: a slide that fills a projector


def write_png(figure: Figure, width: int = PIXELS) -> bytes:
    import pypdfium2
    from PIL.PngImagePlugin import PngInfo

    scale: Any = width / figure.width  # its type says int, its documentation float
    with pypdfium2.PdfDocument(write_pdf([figure])) as document:
        bitmap = document[0].render(scale=scale, fill_color=(0, 0, 0, 0), rev_byteorder=True)
        picture = bitmap.to_pil().copy()
        bitmap.close()
    info = PngInfo()
    for key, value in (("Title", figure.title), ("Description", figure.description), ("Source", figure.command)):
        info.add_itxt(key, value)
    buffer = io.BytesIO()
    picture.save(buffer, "PNG", pnginfo=info)
    return buffer.getvalue()

"""Reading PDF with PDFium: a page as pixels, and attached files. PDFium must not run in two threads at once."""

import ctypes
import threading
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from PIL.Image import Image

ONE_AT_A_TIME = threading.Lock()
MOST_ATTACHMENTS = 100  # that are looked at


def render_page(pdf: bytes, scale: float) -> "Image":
    """The first page, with `scale` pixels a point, on a transparent background."""
    import pypdfium2

    across: Any = scale  # its type says int, its documentation float
    with ONE_AT_A_TIME, pypdfium2.PdfDocument(pdf) as document:
        bitmap = document[0].render(scale=across, fill_color=(0, 0, 0, 0), rev_byteorder=True)
        picture = bitmap.to_pil().copy()
        bitmap.close()
    return picture


def attachment(pdf: bytes, name: str, most: int) -> bytes | None:
    """The content of an attached file; None if there is none of this name. ValueError if this is no PDF, or the file
    has more than `most` bytes.
    """
    import pypdfium2

    try:
        with ONE_AT_A_TIME, pypdfium2.PdfDocument(pdf) as document:
            for k in range(min(document.count_attachments(), MOST_ATTACHMENTS)):
                found = document.get_attachment(k)
                if found.get_name() != name:
                    continue
                size = ctypes.c_ulong()
                pypdfium2.raw.FPDFAttachment_GetFile(found, None, 0, size)  # unpacks it, to a gigabyte at most
                if size.value > most:
                    raise ValueError(f"{name} must have at most {most} bytes, got {size.value}")
                return bytes(found.get_data())
    except (pypdfium2.PdfiumError, UnicodeDecodeError) as error:
        raise ValueError(str(error)) from None
    return None

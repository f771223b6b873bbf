"""The place of an embedded view in each format of figures, and reading it from there.

| format | place |
|---|---|
| SVG | an element of its own in `<metadata>` (SVG 1.1, 21), base64 |
| PNG | an iTXt chunk (PNG 3, 11.3.3.4), base64 |
| PDF | an attached file (ISO 32000-1, 7.11.4) |
| PPTX | a custom XML part (ECMA-376-1, 15.2.5), base64 |
| HTML | the content of a `<meta>` element, base64 |
"""

import base64
import binascii
import io
import re
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from xml.parsers import expat
from xml.sax.saxutils import escape

from tracer.formats.source import Fault, read_bytes
from tracer.printable import printable, shown_path
from viewer.base.files import Unusable
from viewer.base.pdfium import attachment
from viewer.reopen.embedded import MOST_PACKED, Damaged, Embedded, unpack

NAMESPACE = "urn:raytree:view"  # of the element in XML
ELEMENT = "view"
KEYWORD = "raytree view"  # of the chunk in PNG
ATTACHMENT = "raytree-view.zip"  # in PDF
PART = "/customXml/item1.xml"  # in PPTX
META = "raytree-view"  # the name of the element in HTML
MOST_FIGURE = 256 * 2**20  # bytes of a figure that is read
MOST_XML = 64 * 2**20  # bytes of an unpacked part of PPTX


def as_xml(data: bytes) -> str:
    """The element that carries a view in XML."""
    return f'<raytree:{ELEMENT} xmlns:raytree="{NAMESPACE}">\n{as_text(data)}</raytree:{ELEMENT}>'


def as_meta(data: bytes) -> str:
    """The element that carries a view in HTML."""
    return f'<meta name="{META}" content="\n{as_text(data)}">'


def as_part(command: str, data: bytes) -> bytes:
    """An XML document with the command line that makes a figure again, and the view that it carries."""
    view = as_xml(data) if data else ""
    return f'<figure xmlns="{NAMESPACE}"><command>{escape(command)}</command>{view}</figure>'.encode()


def as_text(data: bytes) -> str:
    """Base64, in lines."""
    return base64.encodebytes(data).decode("ascii")


def is_figure(path: Path) -> bool:
    """Whether a file has the suffix of a figure that carries a view."""
    return path.suffix.lower() in CARRYING


def read_figure(path: Path) -> Embedded:
    """The view that a figure carries. Raises Unusable with one line."""
    try:
        data = READERS[path.suffix.lower()](read_bytes(path, MOST_FIGURE))
        if data is None:
            raise Damaged("it carries no view: raytree did not write it, or another program has removed the view")
        return unpack(data)
    except FileNotFoundError:
        found = "file not found"
    except OSError as error:
        found = f"cannot be read: {error.strerror or error}"
    except (Damaged, Fault) as error:
        found = str(error)
    raise Unusable(f"{shown_path(path)}: {found}")


def _decoded(text: str) -> bytes:
    try:
        return base64.b64decode("".join(text.split()), validate=True)
    except (ValueError, binascii.Error):
        raise Damaged("its view is damaged") from None


def _from_xml(content: bytes) -> bytes | None:
    """The view in an XML document. Entities are refused: a few lines of them can stand for gigabytes."""
    found: list[str] = []
    inside = False
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.buffer_text = True

    def start(name: str, _: object) -> None:
        nonlocal inside
        inside = name == f"{NAMESPACE} {ELEMENT}" and not found

    def end(_: str) -> None:
        nonlocal inside
        inside = False

    def text(part: str) -> None:
        if inside:
            found.append(part)

    def entity(*_: object) -> None:
        raise Damaged("it defines entities, which are not read")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler, parser.EntityDeclHandler = text, entity
    try:
        parser.Parse(content, True)
    except (expat.ExpatError, ValueError, LookupError) as error:  # LookupError: an encoding that is not known
        raise Damaged(str(error) if isinstance(error, Damaged) else f"not XML: {error}") from None
    return _decoded("".join(found)) if found else None


def _from_png(content: bytes) -> bytes | None:
    from PIL import Image

    try:
        with Image.open(io.BytesIO(content), formats=["PNG"]) as picture:
            text = picture.info.get(KEYWORD)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        raise Damaged("not a PNG that can be read") from None
    return None if text is None else _decoded(str(text))


def _from_pdf(content: bytes) -> bytes | None:
    try:
        return attachment(content, ATTACHMENT, MOST_PACKED)
    except ValueError as error:
        raise Damaged(f"not a PDF that can be read: {printable(str(error))}") from None


def _from_pptx(content: bytes) -> bytes | None:
    """The view in one of the custom parts: a program that saves the file again may number them anew."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            for entry in archive.infolist():
                if not re.fullmatch(r"customXml/item\d+\.xml", entry.filename):
                    continue
                if entry.file_size > MOST_XML:
                    raise Damaged(f"{entry.filename} must have at most {MOST_XML} bytes, got {entry.file_size}")
                found = _from_xml(archive.read(entry))
                if found is not None:
                    return found
    except Damaged:
        raise
    except (OSError, ValueError, RuntimeError, NotImplementedError, EOFError, zipfile.BadZipFile, zlib.error):
        raise Damaged("not a PPTX that can be read") from None
    return None


_META_ELEMENT = re.compile(rb'<meta name="%s" content="([^"<>]*)">' % META.encode())


def _from_html(content: bytes) -> bytes | None:
    """The view in the first such element: in other places of a page, the sign "<" of a text is escaped."""
    found = _META_ELEMENT.search(content)
    return _decoded(found[1].decode("ascii", "replace")) if found else None


READERS: dict[str, Callable[[bytes], bytes | None]] = {
    ".svg": _from_xml,
    ".png": _from_png,
    ".pdf": _from_pdf,
    ".pptx": _from_pptx,
    ".html": _from_html,
}
CARRYING = tuple(READERS)  # the suffixes of figures that carry a view

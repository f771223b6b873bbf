"""The parts of a PPTX file beside its slides: its properties, the data with which it is reopened, no times."""

import datetime
import io
import zipfile
from typing import Any

from viewer.figures.marks import Figure
from viewer.reopen.places import PART, as_part

UNDATED = datetime.datetime(2000, 1, 1)  # so that the same figure is the same file on every day
OLDEST = (1980, 1, 1, 0, 0, 0)  # the earliest time that a ZIP archive can store
LONGEST_PROPERTY = 255  # characters


def describe(deck: Any, figure: Figure) -> None:
    """Set the properties of a presentation by its first figure, and add the data with which it is reopened."""
    about = deck.core_properties
    about.title, about.subject, about.comments = map(_property, (figure.title, figure.description, figure.command))
    about.author = about.last_modified_by = "raytree"
    about.created = about.modified = UNDATED
    _add_part(deck, PART, as_part(figure.command, figure.embedded))


def _property(text: str) -> str:
    """A text as a property of the document, which has limited room. The custom part has the whole command line."""
    return text if len(text) <= LONGEST_PROPERTY else text[: LONGEST_PROPERTY - 1] + "…"


def _add_part(deck: Any, name: str, content: bytes) -> None:
    """Add a custom XML part."""
    from pptx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
    from pptx.opc.package import Part
    from pptx.opc.packuri import PackURI

    part = Part(PackURI(name), CONTENT_TYPE.XML, deck.part.package, content)
    deck.part.relate_to(part, RELATIONSHIP_TYPE.CUSTOM_XML)


def undated(archive: bytes) -> bytes:
    """The same archive without the times of its files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(archive)) as old, zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            new.writestr(zipfile.ZipInfo(name, OLDEST), old.read(name), zipfile.ZIP_DEFLATED)
    return buffer.getvalue()

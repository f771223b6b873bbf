"""Figures as PPTX, one slide each: boxes are shapes with their text, rays are connectors that follow the boxes.

PowerPoint puts arrow heads at the end of a connector, so in this format they are at the hit and not in the middle of
the ray.
"""

import datetime
import io
import zipfile
from collections.abc import Sequence
from typing import Any

from tracer.extras import missing_extra
from viewer.base.files import Unusable
from viewer.figures.marks import Figure
from viewer.figures.writers.pptx_shapes import SlideDrawing, emu, paint
from viewer.reopen.places import PART, as_part

UNDATED = datetime.datetime(2000, 1, 1)  # so that the same figure is the same file on every day
OLDEST = (1980, 1, 1, 0, 0, 0)  # the earliest time that a ZIP archive can store
LONGEST_PROPERTY = 255  # characters
BLANK = 6  # of the default template's layouts


def write_pptx(figures: Sequence[Figure]) -> bytes:
    first = figures[0]
    deck = new_deck(first)
    for figure in figures:
        slide = deck.slides.add_slide(deck.slide_layouts[BLANK])
        paint(slide.background.fill, figure.paper)
        SlideDrawing(slide.shapes, figure).draw()
    return saved(deck)


def new_deck(about: Figure) -> Any:
    """A presentation without slides, of the size of this figure, with its title, description and command. Raises
    Unusable without the extra.
    """
    try:
        from pptx import Presentation
        from pptx.util import Emu
    except ImportError:
        raise Unusable(f"raytree export: {missing_extra('PPTX needs', 'pptx')}") from None
    deck = Presentation()
    deck.slide_width, deck.slide_height = (Emu(emu(size)) for size in (about.width, about.height))
    properties = deck.core_properties
    texts = (about.title, about.description, about.command)
    properties.title, properties.subject, properties.comments = map(_property, texts)
    properties.author = properties.last_modified_by = "raytree"
    properties.created = properties.modified = UNDATED
    _add_part(deck, PART, as_part(about.command, about.embedded))
    return deck


def saved(deck: Any) -> bytes:
    """The file of a presentation: the same slides are the same file on every day."""
    buffer = io.BytesIO()
    deck.save(buffer)
    return _undated(buffer.getvalue())


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


def _undated(archive: bytes) -> bytes:
    """The same archive without the times of its files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(archive)) as old, zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            new.writestr(zipfile.ZipInfo(name, OLDEST), old.read(name), zipfile.ZIP_DEFLATED)
    return buffer.getvalue()

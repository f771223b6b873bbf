"""Figures as PPTX, one slide each: boxes are shapes with their text, rays are connectors that follow the boxes.

PowerPoint puts arrow heads at the end of a connector, so in this format they are at the hit and not in the middle of
the ray.
"""

import io
from collections.abc import Sequence
from typing import Any

from tracer.extras import missing_extra
from viewer.base.files import Unusable
from viewer.figures.marks import Figure
from viewer.figures.writers.pptx_file import describe, undated
from viewer.figures.writers.pptx_shapes import SlideDrawing, emu, paint

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
    describe(deck, about)
    return deck


def saved(deck: Any) -> bytes:
    """The file of a presentation: the same slides are the same file on every day."""
    buffer = io.BytesIO()
    deck.save(buffer)
    return undated(buffer.getvalue())

"""The two parts of a live piece: its picture, and its formulas with their numbers beside or below it.

Where there is no room for formulas, a caption of one line stands below the picture.
"""

from collections.abc import Sequence
from dataclasses import replace

from viewer.explain.sections import Section
from viewer.figures.font import text_width
from viewer.figures.layout.formula_column import LINE, formula_columns
from viewer.figures.layout.hit_frame import GAP, MARGIN, WIDE
from viewer.figures.marks import Mark, Rectangle, Text, widened
from viewer.lessons.live.piece import LiveContext

# In text sizes.
PICTURE = 0.53  # the picture's share of a wide page
LEAST = 16.0  # width of a column of formulas
SMALLEST = 13.0  # width or height of a picture beside or above formulas
LINES = 9  # of formulas below the picture
CAPTION = 1.7  # height of the caption's line


def lay_out(context: LiveContext, sections: Sequence[Section], captions: Sequence[str]) -> tuple[Rectangle, list[Mark]]:
    """The room for the picture, and the marks of the text: these sections, or the first of the captions that fits."""
    size, theme = context.size, context.theme
    room = widened(context.where, -MARGIN * size)
    left, top, right, bottom = room
    picture = min(right - left - (LEAST + GAP) * size, PICTURE * (right - left))
    column = (left + picture + GAP * size, top, right, bottom)
    if right - left >= WIDE * (bottom - top) and picture >= SMALLEST * size:
        return (left, top, left + picture, bottom), formula_columns(sections, 0, (column,), size, theme)
    below = bottom - LINES * LINE * size
    if below - top >= SMALLEST * size:
        found = formula_columns(sections, 0, ((left, below, right, bottom),), size, theme)
        return (left, top, right, below - 0.5 * GAP * size), found
    return with_caption(context, room, captions)


def with_caption(context: LiveContext, room: Rectangle, captions: Sequence[str]) -> tuple[Rectangle, list[Mark]]:
    """The room above a caption, and its mark: the first caption that fits. If none fits, all of the room."""
    left, top, right, bottom = room
    size = context.size
    mark = Text("caption", (0.5 * (left + right), bottom - 0.5 * size), "", size, context.theme.text)
    for words in captions:
        if text_width(words, size) <= right - left:
            return (left, top, right, bottom - CAPTION * size), [replace(mark, content=words)]
    return room, []

"""Draws source text on a plate, with its comments in a quieter colour, wrapped to the width."""

from collections.abc import Sequence

from imgui_bundle import imgui

from viewer.base.theme import Theme, faded
from viewer.explain.listing import split_remark
from viewer.panels import draw as d

# In font sizes.
SIZE = 0.72  # of the letters
LINE = 1.2 * SIZE  # from line to line
MARGIN = 0.4
CAPTION = 0.68  # size of the caption
FEWEST = 16  # characters of a line


def draw_code(theme: Theme, at: d.Point, width: float, lines: Sequence[str], caption: str = "") -> float:
    """Draw lines, and below them a caption. Returns the height in pixels."""
    em, pad, (x, y) = imgui.get_font_size(), imgui.get_window_draw_list(), at
    size, margin = round(SIZE * em), MARGIN * em
    letter = _letter(size)
    shown = list(split_remark(lines, max(FEWEST, int((width - 2.0 * margin) / letter))))
    high = len(shown) * LINE * em + 1.4 * margin
    pad.add_rect_filled((x, y), (x + width, y + high), d.u32(faded(theme.muted, 0.16)), 0.25 * em)
    for k, (code, remark) in enumerate(shown):
        place = (round(x + margin), round(y + 0.7 * margin + k * LINE * em))
        pad.add_text(d.font(d.SOURCE), size, place, d.u32(theme.text), code)
        place = (round(x + margin + len(code) * letter), place[1])
        pad.add_text(d.font(d.SOURCE), size, place, d.u32(theme.muted), remark)
    if not caption:
        return high
    d.text(pad, (x, y + high + 0.15 * em), theme.muted, caption, CAPTION * em)
    return high + (0.15 + 1.1 * CAPTION) * em


def _letter(size: float) -> float:
    """The width of each letter in pixels."""
    imgui.push_font(d.font(d.SOURCE), size / (imgui.get_font_size() / imgui.get_style().font_size_base))
    found = imgui.calc_text_size("0" * 16).x / 16.0
    imgui.pop_font()
    return found

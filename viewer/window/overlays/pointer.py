"""A pointer that the last row sees: a large disc at the mouse, or a spotlight that dims all but what is around it."""

import math
from itertools import pairwise

from imgui_bundle import imgui

from viewer.base.theme import faded
from viewer.panels import draw as d
from viewer.session.session import Session
from viewer.session.view_state import Pointer

DISC = 11.0  # radius in logical pixels
SPOT = 95.0  # the same of the spotlight
SIDES = 96  # of the spotlight
ANTI_ALIASED_FILL = 1 << 2  # of ImDrawListFlags, which the bindings do not name
DIM = 0.72  # opacity of the shade around it


def draw(session: Session) -> None:
    kind, at = session.pointer, imgui.get_mouse_pos()
    if kind is Pointer.NONE or not imgui.is_mouse_pos_valid():
        return
    pad, unit, theme = imgui.get_foreground_draw_list(), d.unit(), session.appearance.theme
    if kind is Pointer.DISC:
        pad.add_circle_filled(at, DISC * unit, d.u32(faded(theme.fault, 0.85)))
        pad.add_circle(at, DISC * unit, d.u32(theme.ground), 0, 2.0 * unit)
        return
    _shade(pad, at, SPOT * unit, d.u32((0.0, 0.0, 0.0, DIM)))


def _shade(pad: imgui.ImDrawList, at: imgui.ImVec2, radius: float, ink: int) -> None:
    """Fill the window, except for a disc: quadrilaterals from its rim outwards, as far as any corner may be."""
    size = imgui.get_io().display_size
    far = size.x + size.y
    turns = [2.0 * math.pi * k / SIDES for k in range(SIDES + 1)]
    rim = [(math.cos(turn), math.sin(turn)) for turn in turns]
    flags = pad.flags
    pad.flags &= ~ANTI_ALIASED_FILL  # smooth edges would leave lines between neighbours
    for (x0, y0), (x1, y1) in pairwise(rim):
        inner = ((at.x + radius * x, at.y + radius * y) for x, y in ((x0, y0), (x1, y1)))
        outer = ((at.x + far * x, at.y + far * y) for x, y in ((x1, y1), (x0, y0)))
        a, b = inner
        c, e = outer
        pad.add_quad_filled(a, b, c, e, ink)
    pad.flags = flags

"""A pointer that the last row sees: a large disc at the mouse, or a spotlight that dims all but what is around it."""

import math

from imgui_bundle import imgui

from viewer.base.theme import faded
from viewer.panels import draw as d
from viewer.session.session import Session
from viewer.session.view_state import Pointer

DISC = 11.0  # radius in logical pixels
SPOT = 95.0  # the same of the spotlight
SIDES = 96  # of the spotlight
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
    """Fill the window, except for a disc: quadrilaterals from its rim outwards, as far as any corner may be. They are
    made of bare triangles, since the smooth edges of imgui's shapes would leave seams between neighbours.
    """
    size = imgui.get_io().display_size
    far, white = size.x + size.y, imgui.get_font_tex_uv_white_pixel()
    turns = [2.0 * math.pi * k / SIDES for k in range(SIDES)]
    rims = [[(at.x + r * math.cos(turn), at.y + r * math.sin(turn)) for turn in turns] for r in (radius, far)]
    pad.prim_reserve(6 * SIDES, 6 * SIDES)
    for k in range(SIDES):
        (a, b), (c, e) = ((rim[k - 1], rim[k]) for rim in rims)
        for corner in (a, b, e, a, e, c):
            pad.prim_vtx(corner, white, ink)

"""A pointer that the last row sees: a large disc at the mouse, or a spotlight that dims all but what is around it."""

from imgui_bundle import imgui

from viewer.base.theme import faded
from viewer.panels import draw as d
from viewer.session.session import Session
from viewer.session.view_state import Pointer

DISC = 11.0  # radius in logical pixels
SPOT = 95.0  # the same of the spotlight
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
    size = imgui.get_io().display_size
    around = size.x + size.y  # from any place, this reaches every corner
    radius = SPOT * unit + 0.5 * around
    pad.add_circle(at, radius, d.u32((0.0, 0.0, 0.0, DIM)), 128, around)

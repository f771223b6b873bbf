"""The handle of a step's sweep: a line with a knob, below the value that it has. It is grey while a pixel is picked
that is not on its way.
"""

from imgui_bundle import imgui

from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.session.session import Session

KNOB = 0.42  # radius, in font sizes
PULLED = 1.15  # how much larger it is under the mouse


def draw_handle(session: Session, canvas: Canvas, corner: tuple[float, float], width: float) -> float:
    """Draw the handle at a place on the screen, if the step has a sweep. Returns the height that it took, in pixels."""
    sweeping, theme = session.player.sweeping, session.appearance.theme
    if not sweeping.sweep:
        return 0.0
    size, pad = imgui.get_font_size(), imgui.get_window_draw_list()
    words = "another pixel is picked" if sweeping.is_left else sweeping.sweep.words(sweeping.share)
    d.text(pad, corner, theme.muted, d.shortened(words, size, width), size)
    radius = KNOB * size
    left, right, y = corner[0] + radius, corner[0] + width - radius, corner[1] + 1.3 * size + radius
    canvas.sweep_place = ((left, y), right - left)
    imgui.set_cursor_screen_pos((corner[0], y - radius))
    imgui.invisible_button("sweep", (width, 2.0 * radius))
    if imgui.is_item_active():
        sweeping.stop()
        sweeping.move_to((imgui.get_mouse_pos().x - left) / (right - left))
    over = imgui.is_item_hovered() or imgui.is_item_active()
    if over:
        imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    x = left + sweeping.share * (right - left)
    ink = d.u32(theme.muted if sweeping.is_left else theme.accent)
    pad.add_line((left, y), (right, y), d.u32(theme.muted), 2.0 * d.unit())
    pad.add_line((left, y), (x, y), ink, 4.0 * d.unit())
    pad.add_circle_filled((x, y), radius * (PULLED if over else 1.0), ink)
    return y + radius - corner[1]

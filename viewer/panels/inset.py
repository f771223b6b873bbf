"""The image as an inset of the scene, in lecture mode and beside a lesson. It can be clicked; F3 enlarges it."""

from imgui_bundle import imgui

from viewer.gl.canvas import Canvas
from viewer.panels import draw as d, image
from viewer.reopen.view_state import LEFT, NO_INSET
from viewer.session.session import Session

SHARE = 0.42  # of the scene's width, at most
HEIGHT = 0.36  # of its height, at most
MARGIN = 10.0  # logical pixels


def place(session: Session, room: imgui.ImVec2) -> tuple[float, float, float, float] | None:
    """(left, top, right, bottom) of the inset in a scene of this size; None if there is none, or if the image has a
    panel of its own on show.
    """
    layout, is_lecture = session.layout, session.appearance.is_lecture_size
    if session.inset == NO_INSET or not (is_lecture or layout.taught):
        return None
    if layout.place_in("image", is_lecture) in layout.on_show or not session.world:
        return None
    width, height = session.size
    scale = min(SHARE * room.x / width, HEIGHT * room.y / height)
    margin = MARGIN * d.unit()
    left = margin if session.inset == LEFT else room.x - margin - scale * width
    bottom = room.y - margin
    return (left, bottom - scale * height, left + scale * width, bottom)


def draw(session: Session, canvas: Canvas, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    """Draw the image into a lower corner of a scene of this size, if it is not on show elsewhere."""
    where = place(session, room)
    if where is None:
        return
    left, top, right, bottom = where
    size = (right - left, bottom - top)
    theme = session.appearance.theme
    imgui.set_cursor_screen_pos((corner.x + left, corner.y + top))
    imgui.push_style_color(imgui.Col_.child_bg, theme.panel)
    imgui.push_style_var(imgui.StyleVar_.window_padding, (0.0, 0.0))
    flags = imgui.WindowFlags_
    if imgui.begin_child("inset", size, imgui.ChildFlags_.none, flags.no_scrollbar | flags.no_scroll_with_mouse):
        image.draw_picture(session, canvas)
    imgui.end_child()
    imgui.pop_style_var()
    imgui.pop_style_color()
    pad, end = imgui.get_window_draw_list(), imgui.get_item_rect_max()
    pad.add_rect(imgui.get_item_rect_min(), end, d.u32(theme.border), 0.0, 1.5 * d.unit())

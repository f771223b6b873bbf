"""The scene in 3D with its rays: drag to turn, shift-drag or right-drag to move, wheel to zoom, click to select."""

import math

import numpy as np
from imgui_bundle import imgui

from viewer.base.orbit import project
from viewer.base.theme import SMALL
from viewer.figures.marks import Rectangle
from viewer.figures.ray_lines import nearest_row
from viewer.figures.writers.imgui import draw_marks
from viewer.gl.canvas import Canvas, texture_ref
from viewer.gl.scene_marks import SceneMarks
from viewer.panels import draw as d, inset
from viewer.panels.image import draw_waiting
from viewer.panels.panel import Panel
from viewer.session.session import Session

TITLE = 26.0  # logical pixels around the title
REACH = 9.0  # logical pixels: the largest distance of a click from a ray


def handle(session: Session, canvas: Canvas) -> None:
    """Select and pick before any panel is drawn, so that all of them show it at once; with the inset."""
    corner, room = _place()
    if room.x < 8 or room.y < 8:
        return
    flags = imgui.ButtonFlags_
    imgui.invisible_button(
        "stage", room, flags.mouse_button_left | flags.mouse_button_right | flags.mouse_button_middle
    )
    if session.world:
        _handle_mouse(session, canvas, corner, room)
        inset.draw(session, canvas, corner, room)


def _place() -> tuple[imgui.ImVec2, imgui.ImVec2]:
    """(top left, size) of the panel on the screen."""
    return imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()


def draw(session: Session, canvas: Canvas) -> None:
    corner, room = _place()
    if room.x < 8 or room.y < 8:
        return
    if not session.world:
        layout, is_lecture = session.layout, session.appearance.is_lecture_size
        if layout.place_in("image", is_lecture) not in layout.on_show:  # otherwise the image says it
            draw_waiting(session, imgui.get_window_draw_list(), corner, room)
        return
    session.layout.papers["scene"] = (int(room.x / d.unit()), int(room.y / d.unit()))
    canvas.stage_place = (corner.x, corner.y, room.x, room.y)
    pixels = imgui.get_io().display_framebuffer_scale
    size = (int(room.x * pixels.x), int(room.y * pixels.y))
    texture = canvas.view3d(size, d.unit() * pixels.x)
    stage = imgui.get_window_draw_list()
    end = (corner.x + room.x, corner.y + room.y)
    stage.add_image(texture_ref(texture), corner, end, (0, 1), (1, 0))
    stage.push_clip_rect(corner, end, True)
    unit = d.unit()
    view = (room.x / unit, room.y / unit)
    covers = _covers(session, room)
    marks = canvas.scene_marks.get(
        (canvas.stage.pictures, view, session.shown.labels, session.shown.lights, *covers),
        lambda: SceneMarks(session, canvas, view, canvas.stage.depths(), covers).marks(),
    )
    draw_marks(stage, marks, (corner.x, corner.y), unit)
    _fewer(session, canvas, stage, corner)
    stage.pop_clip_rect()


def _handle_mouse(session: Session, canvas: Canvas, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    io = imgui.get_io()
    orbit = session.orbit
    button = imgui.MouseButton_
    if imgui.is_item_hovered():
        canvas.hover("scene", _row_at(session, canvas, corner, room))
    else:
        canvas.leave("scene")
    if imgui.is_item_active():
        moved = io.mouse_delta
        sideways = io.key_shift or imgui.is_mouse_down(button.right) or imgui.is_mouse_down(button.middle)
        if sideways:
            share = orbit.framed(room.x / room.y).distance / orbit.distance / room.y
            orbit.slide(share * moved.x, share * moved.y)
        elif imgui.is_mouse_dragging(button.left):
            orbit.turn(math.pi * moved.x / room.y, math.pi * moved.y / room.y)
    if imgui.is_item_hovered() and io.mouse_wheel != 0.0:
        orbit.zoom(io.mouse_wheel)
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(button.left):
        session.reset_orbit()
    if d.is_clicked():
        session.select(_row_at(session, canvas, corner, room))


def _row_at(session: Session, canvas: Canvas, corner: imgui.ImVec2, room: imgui.ImVec2) -> int | None:
    lines = canvas.lines
    ends = np.stack([lines.starts, lines.ends], axis=1)
    matrix = session.orbit.framed(room.x / room.y).matrix(room.x / room.y)
    places, depths = project(ends.reshape(-1, 3), matrix, (room.x, room.y))
    mouse = imgui.get_mouse_pos()
    at = (mouse.x - corner.x, mouse.y - corner.y)
    return nearest_row(lines, places.reshape(-1, 2, 2), depths.reshape(-1, 2), at, REACH * d.unit())


def _covers(session: Session, room: imgui.ImVec2) -> list[Rectangle]:
    """The rectangles that are covered, in logical pixels: by the title, and by the image as an inset."""
    unit = d.unit()
    title = imgui.calc_text_size(_caption(session))
    found = [(0.0, 0.0, title.x / unit + TITLE, title.y / unit + TITLE)]
    if covered := inset.place(session, room):
        left, top, right, bottom = covered
        found.append((left / unit, top / unit, right / unit, bottom / unit))
    return found


def _fewer(session: Session, canvas: Canvas, stage: imgui.ImDrawList, corner: imgui.ImVec2) -> None:
    """A note in a corner if not all rays are drawn."""
    if session.tree and canvas.drawn < len(session.tree):
        content = f"the heaviest {canvas.drawn:,} of {len(session.tree):,} rays are drawn"
        place = (corner.x + 6.0 * d.unit(), corner.y + 4.0 * d.unit())
        d.text(stage, place, session.appearance.theme.muted, content, SMALL * imgui.get_font_size())


def _caption(session: Session) -> str:
    return session.world.scene.caption if session.world else "Scene"


PANEL = Panel("Scene", draw, fills=True, is_named=False, plate=_caption, figure="scene", first=handle)

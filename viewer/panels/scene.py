"""The scene in 3D with its rays: drag to turn, shift-drag or right-drag to move, wheel to zoom, click to select."""

import math

import numpy as np
from imgui_bundle import imgui

from viewer.base.orbit import project
from viewer.base.theme import DIMMED, SMALL, faded
from viewer.figures.labels import ray_label
from viewer.figures.ray_lines import nearest_row
from viewer.gl.canvas import Canvas, texture_ref
from viewer.panels import draw as d
from viewer.panels.panel import Corner, Panel
from viewer.session.session import Session

REACH = 9.0  # logical pixels: the largest distance of a click from a ray
MOST_LABELS = 40


def draw(session: Session, canvas: Canvas) -> None:
    corner = imgui.get_cursor_screen_pos()
    room = imgui.get_content_region_avail()
    if room.x < 8 or room.y < 8:
        return
    flags = imgui.ButtonFlags_
    imgui.invisible_button(
        "stage", room, flags.mouse_button_left | flags.mouse_button_right | flags.mouse_button_middle
    )
    if not session.world:
        return
    _handle_mouse(session, canvas, corner, room)
    canvas.stage_place = (corner.x, corner.y, room.x, room.y)
    pixels = imgui.get_io().display_framebuffer_scale
    size = (int(room.x * pixels.x), int(room.y * pixels.y))
    texture = canvas.view3d(size, d.unit() * pixels.x)
    stage = imgui.get_window_draw_list()
    end = (corner.x + room.x, corner.y + room.y)
    stage.add_image(texture_ref(texture), corner, end, (0, 1), (1, 0))
    stage.push_clip_rect(corner, end, True)
    _Overlay(session, canvas, stage, corner, room).draw()
    stage.pop_clip_rect()


def _handle_mouse(session: Session, canvas: Canvas, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    io = imgui.get_io()
    orbit = session.orbit
    button = imgui.MouseButton_
    if imgui.is_item_active():
        moved = io.mouse_delta
        sideways = io.key_shift or imgui.is_mouse_down(button.right) or imgui.is_mouse_down(button.middle)
        if sideways:
            orbit.slide(moved.x / room.y, moved.y / room.y)
        elif imgui.is_mouse_dragging(button.left):
            orbit.turn(math.pi * moved.x / room.y, math.pi * moved.y / room.y)
    if imgui.is_item_hovered() and io.mouse_wheel != 0.0:
        orbit.zoom(io.mouse_wheel)
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(button.left):
        session.reset_orbit()
    # A click is a press and release in one place, so turning the view selects nothing.
    if imgui.is_item_hovered() and imgui.is_mouse_released(button.left):
        moved = io.mouse_drag_max_distance_sqr[0]
        if moved < io.mouse_drag_threshold**2:
            session.select(_row_at(session, canvas, corner, room))


def _row_at(session: Session, canvas: Canvas, corner: imgui.ImVec2, room: imgui.ImVec2) -> int | None:
    lines = canvas.lines
    ends = np.stack([lines.starts, lines.ends], axis=1)
    matrix = session.orbit.matrix(room.x / room.y)
    places, depths = project(ends.reshape(-1, 3), matrix, (room.x, room.y))
    mouse = imgui.get_mouse_pos()
    at = (mouse.x - corner.x, mouse.y - corner.y)
    return nearest_row(lines, places.reshape(-1, 2, 2), depths.reshape(-1, 2), at, REACH * d.unit())


class _Overlay:
    """Texts and signs over the 3D view: lights, the camera, ends of shadow rays, names. No text covers another."""

    def __init__(
        self, session: Session, canvas: Canvas, stage: imgui.ImDrawList, corner: imgui.ImVec2, room: imgui.ImVec2
    ) -> None:
        self.session = session
        self.canvas = canvas
        self.stage = stage
        self.corner = np.array([corner.x, corner.y])
        self.size = (room.x, room.y)
        self.matrix = session.orbit.matrix(room.x / room.y)
        self.taken: list[tuple[float, float, float, float]] = []
        self.unit = d.unit()

    def draw(self) -> None:
        session = self.session
        if session.tree:
            self._selected_hit()
            self._crosses()
            self._fewer(len(session.tree))
        if session.shown.lights:
            self._lights()
        if session.shown.labels:
            if session.tree:
                self._ray_names()
            if session.shown.camera:
                self._camera_name()

    def at(self, point: np.ndarray) -> tuple[float, float] | None:
        """A point of the frame on the screen; None if it is behind the camera."""
        places, depths = project(np.atleast_2d(point), self.matrix, self.size)
        if depths[0] <= 0.0 or not np.isfinite(places).all():
            return None
        x, y = places[0] + self.corner
        return (float(x), float(y))

    def label(self, at: tuple[float, float], content: str, color: tuple, offset: tuple[float, float]) -> None:
        """A text beside a point, unless another text is there already."""
        size = SMALL * imgui.get_font_size()
        width, height = d.text_size(content, size)
        x, y = at[0] + offset[0] * self.unit, at[1] + offset[1] * self.unit
        box = (x - 2, y - 1, x + width + 2, y + height + 1)
        if any(box[0] < t[2] and t[0] < box[2] and box[1] < t[3] and t[1] < box[3] for t in self.taken):
            return
        self.taken.append(box)
        d.text(self.stage, (x, y), color, content, size, self.session.appearance.theme.ground)

    def _lights(self) -> None:
        theme = self.session.appearance.theme
        assert self.session.world
        scene = self.session.world.scene
        for j, light in enumerate(scene.lights):
            if light.position is None:
                continue
            at = self.at(self.session.frame.inside(light.position))
            if at:
                d.sun(self.stage, at, 10.0 * self.unit, theme.sun, theme.ground)
                if self.session.shown.labels:
                    self.label(at, scene.light_name(j), theme.text, (13, -9))

    def _camera_name(self) -> None:
        assert self.session.world
        at = self.at(self.session.frame.inside(self.session.world.view().eye))
        if at:
            self.stage.add_circle_filled(at, 4.0 * self.unit, d.u32(self.session.appearance.theme.text))
            self.label(at, "eye", self.session.appearance.theme.text, (7, -9))

    def _selected_hit(self) -> None:
        session = self.session
        assert session.tree
        if session.selected is None:
            return
        point = session.tree.nodes["point"][session.selected]
        if np.isfinite(point).all() and (at := self.at(session.frame.inside(point))):
            self.stage.add_circle_filled(at, 6.5 * self.unit, d.u32(session.appearance.theme.ground))
            self.stage.add_circle_filled(at, 4.5 * self.unit, d.u32(session.appearance.theme.accent))

    def _crosses(self) -> None:
        """Crosses at the ends of blocked shadow rays."""
        theme = self.session.appearance.theme
        for line in self.canvas.lines:
            if line.blocked and (at := self.at(line.end)):
                d.cross(self.stage, at, 5.0 * self.unit, theme.ground, 5.0 * self.unit)
                d.cross(self.stage, at, 5.0 * self.unit, theme.ray("shadow"), 2.4 * self.unit)

    def _fewer(self, total: int) -> None:
        """A note in a corner if not all rays are drawn."""
        if self.canvas.drawn < total:
            content = f"the heaviest {self.canvas.drawn:,} of {total:,} rays are drawn"
            place = (self.corner[0] + 6.0 * self.unit, self.corner[1] + 4.0 * self.unit)
            d.text(self.stage, place, self.session.appearance.theme.muted, content, SMALL * imgui.get_font_size())

    def _ray_names(self) -> None:
        """The label of each ray beside its middle: first the selected one, then the heaviest."""
        session = self.session
        tree = session.tree
        assert tree
        nodes = tree.nodes
        rows = [line.row for line in self.canvas.lines if line.kind != "shadow"]
        kept = self.canvas.kept
        rows.sort(key=lambda i: (i != session.selected, -nodes["weight"][i].max(), i))
        for i in rows[:MOST_LABELS]:
            start = session.frame.inside(nodes["origin"][i])
            end = session.frame.inside(nodes["point"][i])
            if np.isnan(end).any():
                end = start + 0.6 * nodes["direction"][i]
            at = self.at(0.5 * (start + end))
            if at is None:
                continue
            kind = tree.kind(i)
            color = session.appearance.theme.ray(kind)
            if kept is not None and i not in kept:
                color = faded(color, DIMMED)
            self.label(at, ray_label(tree, i), color, (8, 4))


PANEL = Panel("Scene", draw, Corner.TOP_LEFT, padding=(0, 0))

"""The ray tree as a diagram: eye at the top, reflected rays to the left, refracted ones right, stubs to the lights."""

import bisect
import math

import numpy as np
from imgui_bundle import imgui

from tracer.kernel.nodes import SHADOW
from tracer.tree.text import cut_summary
from viewer.base.srgb import display_color
from viewer.base.theme import DIMMED, SMALL, STYLES, faded
from viewer.base.wording import format_number
from viewer.explain.ray import headline
from viewer.figures.labels import CUTS, ray_label
from viewer.figures.layout.tidy_tree import Place, heaviest_places
from viewer.figures.lights import fate_of, ray_dash
from viewer.figures.ray_lines import relatives
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.panel import Corner, Panel
from viewer.session.session import Session

MOST_ROWS = 160  # the heaviest rays, if a tree has more
# Logical pixels between neighbours and between levels, at most and at least. A tree that needs less has to be moved.
WIDEST, NARROWEST = 170.0, 34.0
TALLEST, LOWEST = 104.0, 14.0
EYE_ROOM, EYE_AT = 40.0, 27.0  # above the first hit: the room for the eye, and its height
FOOT = 13.0  # below the last row
RADIUS = 11.0


def draw(session: Session, canvas: Canvas) -> None:
    corner = imgui.get_cursor_screen_pos()
    room = imgui.get_content_region_avail()
    if room.x < 8 or room.y < 8:
        return
    flags = imgui.ButtonFlags_
    imgui.invisible_button("tree", room, flags.mouse_button_left | flags.mouse_button_right)
    pad = imgui.get_window_draw_list()
    if not session.tree or not session.full_tree:
        _hint(session, pad, corner, room)
        return
    pad.push_clip_rect(corner, (corner.x + room.x, corner.y + room.y), True)
    diagram = _Diagram(session, canvas, pad, corner, room)
    diagram.draw()
    canvas.nodes = {i: diagram.at[i] for i in diagram.rows}
    pad.pop_clip_rect()


def _hint(session: Session, pad: imgui.ImDrawList, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    content, size = "Click a pixel of the image: its rays appear here as a tree.", imgui.get_font_size()
    width, height = d.text_size(content, size)
    at = (corner.x + 0.5 * (room.x - width), corner.y + 0.5 * (room.y - height))
    d.text(pad, at, session.appearance.theme.muted, content, size)


class _Diagram:
    def __init__(
        self, session: Session, canvas: Canvas, pad: imgui.ImDrawList, corner: imgui.ImVec2, room: imgui.ImVec2
    ) -> None:
        assert session.tree and session.full_tree
        self.session = session
        self.tree = session.tree
        self.pad = pad
        self.theme = session.appearance.theme
        full, kinds = session.full_tree, frozenset(session.shown.kinds)
        places = canvas.tree_places.get((full, kinds), lambda: heaviest_places(full, kinds, MOST_ROWS))
        self._fit(places, corner, room)
        self.rows = sorted(i for i in places if i < len(self.tree))
        self.folded = len(self.tree) - len(self.rows)
        self.levels: dict[float, list[float]] = {}  # positions of hits on each level, left to right
        for x, y in sorted(self.at[i] for i in self.rows if self.tree.nodes["kind"][i] != SHADOW):
            self.levels.setdefault(y, []).append(x)
        self.kept: set[int] | None = None
        if (selected := session.selected) is not None:
            key = (self.tree, selected, kinds)
            self.kept = canvas.tree_kept.get(key, lambda: relatives(self.tree, selected, self.rows))

    def _fit(self, places: dict[int, Place], corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
        """Map positions to pixels, as far apart as the room allows, up to WIDEST and TALLEST."""
        look = self.session.tree_view
        unit = d.unit()
        left = min(place.x for place in places.values()) - 0.9
        right = max(place.x for place in places.values()) + 1.0
        lowest = max(0.5, *(place.y for place in places.values()))
        head, foot = EYE_ROOM * unit, FOOT * unit
        width = min(WIDEST, max(NARROWEST, room.x / unit / (right - left)))
        height = min(TALLEST, max(LOWEST, (room.y - head - foot) / unit / lowest))
        self.step_x, self.step_y = width * unit * look.zoom, height * unit * look.zoom
        fits = room.x >= (right - left) * width * unit * 0.999
        middle = 0.5 * (left + right) if fits else 0.0  # too wide: keep the eye in the middle
        base_x = corner.x + 0.5 * room.x - middle * self.step_x + look.center[0] * unit
        base_y = corner.y + head + look.center[1] * unit
        self.at = {i: (base_x + p.x * self.step_x, base_y + p.y * self.step_y) for i, p in places.items()}
        self.text_size = SMALL * imgui.get_font_size()
        self.labels_edges = self.step_x >= 74 * unit and self.step_y >= 1.9 * self.text_size
        self.radius = min(RADIUS * unit, 0.3 * self.step_y, 0.2 * self.step_x)
        self.corner, self.room = corner, room

    def draw(self) -> None:
        self._levels()
        self._eye()
        for i in reversed(self.rows):
            self._edge(i)
        for i in self.rows:
            self._edge_label(i)
        for i in sorted(self.rows, key=lambda i: self.tree.nodes["kind"][i] != SHADOW):  # no light over a name
            self._node(i)
        self._note()
        self._handle_mouse()

    def opacity(self, i: int) -> float:
        return 1.0 if self.kept is None or i in self.kept else DIMMED

    def _top(self, i: int) -> tuple[float, float]:
        """The start of the edge to row i: its parent, or the eye."""
        parent = int(self.tree.nodes["parent"][i])
        if parent >= 0:
            return self.at[parent]
        x, y = self.at[0]
        return (x, y - EYE_AT * d.unit())

    def _levels(self) -> None:
        """The depths of the rays that are drawn, as faint lines with their numbers."""
        deepest = int(self.tree.nodes["depth"][self.rows].max())
        size = self.text_size
        for depth in range(deepest + 1):
            y = self.at[0][1] + depth * self.step_y
            ink = faded(self.theme.border, 0.9)
            d.line(self.pad, (self.corner.x + 60 * d.unit(), y), (self.corner.x + self.room.x, y), ink, 1.0)
            d.text(self.pad, (self.corner.x + 6 * d.unit(), y - 0.5 * size), self.theme.muted, f"depth {depth}", size)

    def _eye(self) -> None:
        x, y = self._top(0)
        r = 0.8 * self.radius
        d.eye(self.pad, (x, y), r, self.theme.text)
        d.text(self.pad, (x + 1.9 * r, y - 0.5 * self.text_size), self.theme.text, "eye", self.text_size)

    def _edge(self, i: int) -> None:
        tree = self.tree
        kind = tree.kind(i)
        style = STYLES[kind]
        unit = d.unit()
        color, dash = faded(self.theme.ray(kind), self.opacity(i)), ray_dash(tree, i)
        a, b = self._top(i), self.at[i]
        if i == 0:
            a = (a[0], a[1] + 0.65 * self.radius)
        width = style.width * unit * (1.7 if i == self.session.selected else 1.0)
        d.line(self.pad, a, b, color, width, (dash[0] * unit * 0.8, dash[1] * unit * 0.8))
        d.arrow(self.pad, a, b, 0.72, color, 9.0 * unit, style.arrow)

    def _edge_label(self, i: int) -> None:
        """The factor of a ray beside its edge, if there is room."""
        unit = d.unit()
        kind = self.tree.kind(i)
        if kind == "shadow" or i == 0 or not self.labels_edges:
            return
        a, b = self._top(i), self.at[i]
        content = f"{ray_label(self.tree, i)} {self._factor(i)}"
        size = self.text_size
        width, height = d.text_size(content, size)
        x, y = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])
        gap = 8.0 * unit
        x = x - width - gap if b[0] < a[0] - 1.0 else x + gap
        color = faded(self.theme.ray(kind), self.opacity(i))
        d.text(self.pad, (x, y - 0.5 * height), color, content, size, self.theme.panel)

    def _factor(self, i: int) -> str:
        return f"× {format_number(float(self.tree.nodes['factor'][i].max()), 3)}"

    def _node(self, i: int) -> None:
        if self.tree.nodes["kind"][i] == SHADOW:
            self._light_end(i)
            return
        x, y = self.at[i]
        opacity = self.opacity(i)
        r = self.radius
        fill = faded(display_color(self.tree.nodes["radiance"][i]), opacity)
        self.pad.add_circle_filled((x, y), r + 2.0 * d.unit(), d.u32(self.theme.panel))
        self.pad.add_circle_filled((x, y), r, d.u32(fill))
        ring = self.theme.accent if i == self.session.selected else faded(self.theme.text, 0.8 * opacity)
        self.pad.add_circle((x, y), r, d.u32(ring), 0, (3.0 if i == self.session.selected else 1.4) * d.unit())
        if self.step_x > 40 * d.unit():
            self._node_label(i, x, y, opacity)

    def _node_label(self, i: int, x: float, y: float, opacity: float) -> None:
        name = self.tree.object_name(i) or "background"
        note = CUTS.get(self.tree.end(i) or "", "")
        size = self.text_size
        color = faded(self.theme.text, opacity)
        # The label is at the node's height, between the incoming and the outgoing edges.
        gap = 6.0 * d.unit()
        at, room = x + self.radius + gap, self._room_beside(i) - gap
        # The ray's label stands here if there is no room at the edge, as for the camera ray; its factor, if it fits.
        label = "" if i and self.labels_edges else ray_label(self.tree, i)
        if note and room < d.text_size(f"{label}  {name}", size)[0] + gap + d.text_size(note, size)[0]:
            note = "cut"
        taken = gap + d.text_size(note, size)[0] if note else 0.0
        long = f"{label} {self._factor(i)}"
        if i and label and room >= d.text_size(f"{long}  {name}", size)[0] + taken:
            label = long
        if label:
            ink = faded(self.theme.ray(self.tree.kind(i)), opacity)
            d.text(self.pad, (at, y - 0.5 * size), ink, label, size, self.theme.panel)
            wide = d.text_size(f"{label}  ", size)[0]
            at += wide
            taken += wide
        content = d.shortened(name, size, room - taken)
        content = content if content == name or len(content) > 5 else ""
        d.text(self.pad, (at, y - 0.5 * size), color, content, size, self.theme.panel)
        if note:
            at += d.text_size(content, size)[0] + gap
            d.text(self.pad, (at, y - 0.5 * size), faded(self.theme.muted, opacity), note, size, self.theme.panel)

    def _room_beside(self, i: int) -> float:
        """Pixels between a node and its right neighbour on the same level, at most what a long name needs."""
        x, y = self.at[i]
        level = self.levels[y]
        next_one = bisect.bisect_right(level, x)
        right = level[next_one] - self.radius if next_one < len(level) else self.corner.x + self.room.x
        return min(right, x + 3.0 * self.step_x) - x - self.radius - 6.0 * d.unit()

    def _light_end(self, i: int) -> None:
        """The sign of what becomes of the shadow ray, as in figures."""
        x, y = self.at[i]
        opacity, r = self.opacity(i), 0.62 * self.radius
        ink = faded(self.theme.ray("shadow"), opacity)
        match fate_of(self.tree, i).name:
            case "away":
                d.line(self.pad, (x - 0.5 * r, y), (x + 0.5 * r, y), ink, 3.0 * d.unit())
            case "nothing":
                self.pad.add_circle((x, y), 0.6 * r, d.u32(ink), 0, 1.5 * d.unit())
            case "blocked":
                d.cross(self.pad, (x, y), 0.6 * r, ink, 2.2 * d.unit())
            case fate:
                d.sun(self.pad, (x, y), r, faded(self.theme.sun, opacity), self.theme.panel)
                if fate == "filtered":
                    self.pad.add_circle((x, y), 1.35 * r, d.u32(ink), 0, 1.2 * d.unit())
        if i == self.session.selected:
            self.pad.add_circle((x, y), 1.5 * r, d.u32(self.theme.accent), 0, 2.5 * d.unit())

    def _note(self) -> None:
        """A note in a corner about the rays that are not shown. Shorter if there is less room."""
        drawn, total, weight = len(self.rows), len(self.tree), format_number(self.tree.residual, 3)
        fewer = f"{drawn} of {total} rays drawn" if self.folded > 0 else ""
        most = self.tree.bound
        bound = f"at most {format_number(most, 3)} missing" if most < np.inf else "no bound on the missing light"
        shorter = (f"cut: {weight} of the weight, {bound}", f"cut rays: {weight} of the weight", f"cut: {weight}")
        margin = 8 * d.unit()
        x, _ = self._top(0)
        left, right = self.corner.x + margin, self.corner.x + self.room.x - margin
        ends = (x - 3 * self.radius, x + 6 * self.radius)  # of the eye with its name
        for cut in (cut_summary(self.tree), *shorter) if self.tree.residual > 0.0 else [""]:
            content = "; ".join(part for part in (fewer, cut) if part)
            width, _ = d.text_size(content, self.text_size)
            for at in (right - width, left):
                if at >= ends[1] or at + width <= ends[0]:
                    place = (at, self.corner.y + 4 * d.unit())
                    d.text(self.pad, place, self.theme.muted, content, self.text_size, self.theme.panel)
                    return

    def _handle_mouse(self) -> None:
        io = imgui.get_io()
        look = self.session.tree_view
        unit = d.unit()
        button = imgui.MouseButton_
        hovered = imgui.is_item_hovered()
        if imgui.is_item_active() and (imgui.is_mouse_dragging(button.left) or imgui.is_mouse_dragging(button.right)):
            look.move(io.mouse_delta.x / unit, io.mouse_delta.y / unit)
        if hovered and imgui.is_mouse_double_clicked(button.left):
            look.fit()
        if hovered and io.mouse_wheel != 0.0:
            look.zoom = min(6.0, max(0.3, look.zoom * 1.12**io.mouse_wheel))
        if not hovered:
            return
        row = self._row_at((imgui.get_mouse_pos().x, imgui.get_mouse_pos().y))
        if row is not None and not imgui.is_mouse_down(button.left):
            first, second = headline(self.tree, row)
            imgui.set_tooltip(f"{first}\n{second}")
        if imgui.is_mouse_released(button.left) and io.mouse_drag_max_distance_sqr[0] < io.mouse_drag_threshold**2:
            self.session.select(row)

    def _row_at(self, mouse: tuple[float, float]) -> int | None:
        """The node or edge under the mouse."""
        near = self.radius + 5.0 * d.unit()
        best = min(self.rows, key=lambda i: math.dist(self.at[i], mouse))
        if math.dist(self.at[best], mouse) <= near:
            return best
        reach = 6.0 * d.unit()
        for i in self.rows:
            a, b = np.array(self._top(i)), np.array(self.at[i])
            along = b - a
            t = min(1.0, max(0.0, float((np.array(mouse) - a) @ along) / max(1e-9, float(along @ along))))
            if float(np.hypot(*(a + t * along - mouse))) <= reach:
                return i
        return None


PANEL = Panel("Ray tree", draw, Corner.BOTTOM_LEFT, padding=(6, 5))

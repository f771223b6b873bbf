"""The ray tree: the marks of the figure `tree`, laid out for the panel. Click to select a ray, drag to move, wheel to
zoom, double click to fit.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from imgui_bundle import imgui

from tracer.tree.raytree import RayTree
from tracer.tree.text import cut_summary
from viewer.base.theme import PANEL_TEXT, SMALL, Arrow
from viewer.base.wording import format_number
from viewer.explain.ray import headline
from viewer.figures.figure.tree import plan_pages, plan_steps
from viewer.figures.layout.free_space import is_free
from viewer.figures.layout.sizes import OUTLINE
from viewer.figures.layout.tree_legend import sign_entries
from viewer.figures.layout.tree_plan import TreePlan
from viewer.figures.legend import Entry, legend_row, row_width
from viewer.figures.marks import Box, Disc, Line, Mark, Point, Text, widened, within
from viewer.figures.picking import mark_at, row_of
from viewer.figures.steps import of_kinds, whole
from viewer.figures.subject import FigureStyle
from viewer.figures.writers.imgui import draw_marks
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.panel import Panel
from viewer.panels.reveal import draw_position
from viewer.session.session import Session

ROW = 1.5  # from row to row of the legend, in its text sizes
POSITION = 4.0  # width of the step's number beside the title, in text sizes
EDGE = 6.0  # points: from the border of the panel to the legend
REACH = 6.0  # logical pixels: the largest distance of a click from a mark
GLOW = 4.0  # logical pixels: width of the line around the ray under the mouse
SMALLEST, LARGEST = 0.4, 6.0  # zoom


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
    look, unit, fit = session.tree_view, d.unit(), d.figure_scale(room)
    # Zoomed out, the same panel is a larger page: it has room for more rays, in smaller text.
    scale, wide = fit * look.zoom, max(1.0, 1.0 / look.zoom)
    page = (float(int(room.x / fit * wide)), float(int(room.y / fit * wide)))
    session.layout.papers["tree"] = (int(page[0]), int(page[1]))
    marks = _marks(session, canvas, page)
    middle = (corner.x + 0.5 * room.x + look.center[0] * unit, corner.y + 0.5 * room.y + look.center[1] * unit)
    origin = (middle[0] - 0.5 * scale * page[0], middle[1] - 0.5 * scale * page[1])
    _handle_mouse(session, canvas, marks, origin, scale)
    marks = _marks(session, canvas, page)  # with what has been selected now
    canvas.nodes = {row: _on_screen(at, origin, scale) for row, at in nodes(marks).items()}
    pad.push_clip_rect(corner, (corner.x + room.x, corner.y + room.y), True)
    draw_marks(pad, _glow(session, marks), origin, scale)
    draw_marks(pad, marks, origin, scale)
    pad.pop_clip_rect()


def _hint(session: Session, pad: imgui.ImDrawList, corner: imgui.ImVec2, room: imgui.ImVec2) -> None:
    size = imgui.get_font_size()
    content = d.shortened("Click a pixel: its rays appear here as a tree.", size, room.x)
    width, height = d.text_size(content, size)
    at = (corner.x + 0.5 * (room.x - width), corner.y + 0.5 * (room.y - height))
    d.text(pad, at, session.appearance.theme.muted, content, size)


def _marks(session: Session, canvas: Canvas, page: tuple[float, float]) -> list[Mark]:
    """The marks of the tree on show. They are made again only if something has changed."""
    full, kinds, selected = session.full_tree, frozenset(session.shown.kinds), session.selected
    assert full
    style = FigureStyle(
        session.appearance.theme, PANEL_TEXT, swatches=True, selected=selected, levels=True, legend=False, page=page
    )

    def plan_for(selected: int | None):
        steps = [of_kinds(whole(full), kinds)]
        return plan_steps(steps, replace(style, selected=selected), style.canvas)

    plan = canvas.tree_plan.get((full, kinds, page), lambda: plan_for(None))
    if selected is not None and selected not in plan.rows:
        plan = canvas.tree_plan_of_ray.get((full, kinds, page, selected), lambda: plan_for(selected))
    assert session.tree
    step = canvas.step(session.tree)

    def make() -> list[Mark]:
        marks = plan_pages(plan, [of_kinds(step, kinds)], style)[0]
        if step.sum is not None:  # the sum needs the room
            return marks
        marks += _signs(plan, style)
        return [*marks, *_note(step.tree, marks, style)]

    return canvas.tree_marks.get((plan, step, selected, style.theme.name), make)


def _signs(plan: TreePlan, style: FigureStyle) -> list[Mark]:
    """The legend of the signs, at the top right, beside the eye, or below an outline: as many as there is room for."""
    size, right = SMALL * style.text_size, style.page[0] - EDGE
    entries = [entry for entry in sign_entries(plan) if entry.what != "lights"]
    left, middle, most = plan.places.eye[0] + 2.0 * style.text_size, EDGE + size, 1
    if plan.style.eye == OUTLINE:
        lowest = max(y for _, y in plan.at.values()) + plan.box[1]
        left, most = EDGE, int((style.page[1] - EDGE - lowest) / (ROW * size))
        middle = style.page[1] - EDGE - size
    rows: list[list[Entry]] = [[]]
    for entry in entries:
        if rows[-1] and right - row_width([*rows[-1], entry], size) < left:
            rows.append([])
        rows[-1].append(entry)
    found: list[Mark] = []
    for k, row in enumerate(rows[:most]):
        if right - row_width(row, size) >= left:
            found += legend_row(row, right - row_width(row, size), middle - k * ROW * size, size, style.theme)
    return found


def _note(tree: RayTree, marks: Sequence[Mark], style: FigureStyle) -> list[Mark]:
    """A note about the rays that were cut, where there is room: shorter if there is less."""
    if tree.residual <= 0.0:
        return []
    size, (width, height) = SMALL * style.text_size, style.page
    weight, most = format_number(tree.residual, 3), tree.bound
    bound = f"at most {format_number(most, 3)} missing" if most < math.inf else "no bound on the missing light"
    for words in (cut_summary(tree), f"cut: {weight} of the weight, {bound}", f"cut: {weight} of the weight"):
        note = Text("note", (0.0, 0.0), words, size, style.theme.muted, "end")
        low, high = height - EDGE - size, EDGE + size + 1.6 * size
        for x, y, anchor in ((width - EDGE, low, "end"), (EDGE, low, "start"), (width - EDGE, high, "end")):
            found = replace(note, at=(x, y), anchor=anchor)
            if within(found.box(), style.canvas) and is_free(widened(found.box(), 2.0), marks):
                return [found]
    return []


def nodes(marks: list[Mark]) -> dict[int, Point]:
    """The places of the hits' boxes, and of the signs of shadow rays, by row."""
    found: dict[int, Point] = {}
    for mark in marks:
        kind, _, number = mark.name.rpartition("-")
        if isinstance(mark, Box) and kind == "hit":
            found[int(number)] = mark.center
        elif isinstance(mark, Disc | Line) and kind == "ray":
            found.setdefault(int(number), mark.center if isinstance(mark, Disc) else mark.end)
    return found


def _on_screen(at: Point, origin: Point, scale: float) -> Point:
    return (origin[0] + scale * at[0], origin[1] + scale * at[1])


def _glow(session: Session, marks: list[Mark]) -> list[Mark]:
    """The marks of the ray under the mouse, wider, in the colour of what is selected."""
    row = session.hovered
    if row is None:
        return []
    ink = session.appearance.theme.accent
    found: list[Mark] = []
    for mark in marks:
        stroke = getattr(mark, "stroke", None)
        if mark.name not in (f"ray-{row}", f"hit-{row}") or not stroke:
            continue
        wide = replace(stroke, color=ink, width=stroke.width + GLOW, dash=(0.0, 0.0))
        found.append(replace(mark, stroke=wide, **({"arrow": Arrow.NONE} if isinstance(mark, Line) else {})))  # type: ignore[call-arg]
    return found


def _handle_mouse(session: Session, canvas: Canvas, marks: list[Mark], origin: Point, scale: float) -> None:
    io, look, button = imgui.get_io(), session.tree_view, imgui.MouseButton_
    hovered = imgui.is_item_hovered()
    if imgui.is_item_active() and (imgui.is_mouse_dragging(button.left) or imgui.is_mouse_dragging(button.right)):
        look.move(io.mouse_delta.x / d.unit(), io.mouse_delta.y / d.unit())
    if hovered and imgui.is_mouse_double_clicked(button.left):
        look.fit()
    if hovered and io.mouse_wheel != 0.0:
        look.zoom = min(LARGEST, max(SMALLEST, look.zoom * 1.12**io.mouse_wheel))
    if not hovered:
        canvas.leave("tree")
        return
    assert session.tree
    mouse = imgui.get_mouse_pos()
    at = ((mouse.x - origin[0]) / scale, (mouse.y - origin[1]) / scale)
    row = row_of(mark_at(marks, at, REACH * d.unit() / scale, ("ray", "hit", "fold")))
    canvas.hover("tree", row)
    if row is not None and not imgui.is_mouse_down(button.left):
        first, second = headline(session.tree, row)
        imgui.set_tooltip(f"{first}\n{second}")
    if d.is_clicked():
        session.select(row)


def _head(session: Session, room: float) -> None:
    """The controls of the steps, while the tree is revealed step by step."""
    if session.step:
        draw_position(session, imgui.get_cursor_pos_x() + room)


PANEL = Panel(
    "Ray tree", draw, fills=True, head=_head, short="Tree",
    figure="tree", shows_ray=True, head_room=lambda session: POSITION if session.step else 0.0,
)  # fmt: skip

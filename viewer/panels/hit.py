"""The hit of the selected ray in its plane of incidence, as in the figure; without a selection the first hit.

The incoming ray is dragged by its end: the hit is shown as it would be at another angle. A double click brings back the
traced ray.
"""

from imgui_bundle import imgui

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.theme import PANEL_TEXT
from viewer.explain.ray import headline
from viewer.explain.turned import turned
from viewer.figures.figure.hit import hit_marks
from viewer.figures.marks import Mark, Point, with_line_width
from viewer.figures.picking import mark_at, row_of
from viewer.figures.steps import Step
from viewer.figures.writers.imgui import draw_marks
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.handles import drag
from viewer.panels.panel import Panel
from viewer.session.session import Session

REACH = 6.0  # logical pixels from the mouse to a ray
DIGITS = 1  # of the angle in degrees
THICKER = 1.6  # factor of the line widths of the ray under the mouse


def draw(session: Session, canvas: Canvas) -> None:
    corner, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
    if room.x < 8 or room.y < 8:
        return
    unit = d.figure_scale(room)
    tree = session.tree
    row = shown_row(tree, session.selected or 0) if tree else None
    if tree is None or row is None:
        imgui.text_colored(session.appearance.theme.muted, "This ray meets nothing." if tree else "No pixel is picked.")
        return
    imgui.invisible_button("hit", room)
    size = (round(room.x / unit), round(room.y / unit))
    session.layout.papers["hit"] = size

    def marks() -> list[Mark]:
        return canvas.hit.get(_key(session, row, size), lambda: _marks(session, tree, row, size))

    mouse = imgui.get_mouse_pos()
    at = ((mouse.x - corner.x) / unit, (mouse.y - corner.y) / unit)
    is_dragged = _drag(session, marks(), at)
    hovered = session.hovered if session.turn is None else None
    if imgui.is_item_hovered() and not is_dragged and session.turn is None:
        hovered = row_of(mark_at(marks(), at, REACH))
        canvas.hover("hit", hovered)
        if hovered is not None:
            imgui.set_tooltip("\n".join(headline(tree, hovered)))
            if d.is_clicked():
                session.select(hovered)
    else:
        canvas.leave("hit")
    name = f"ray-{hovered}"
    shown = (with_line_width(mark, THICKER) if mark.name == name else mark for mark in marks())
    draw_marks(imgui.get_window_draw_list(), shown, (corner.x, corner.y), unit)


def _drag(session: Session, marks: list[Mark], at: Point) -> bool:
    """Turn the ray with its handle. Returns whether the mouse is over the handle, or drags it."""
    dragging = drag(session, marks, at)
    if dragging.moved:
        if session.turn is None:
            session.notice.say("turned by hand; a double click brings back the traced ray")
        session.turn = round(dragging.moved[1], DIGITS)
    if dragging.is_put_back:
        session.turn_back()
    if dragging.over and imgui.is_item_hovered() and session.turn is None and not dragging.is_held:
        imgui.set_tooltip(dragging.over.title)
    return dragging.is_held or bool(dragging.over)


def shown_row(tree: RayTree, row: int) -> int | None:
    """The ray whose hit is shown for a selected ray: itself, if it meets a surface and is no shadow ray, else the ray
    that sends it out.
    """
    if tree.nodes["kind"][row] != SHADOW and tree.object_name(row):
        return row
    parent = int(tree.nodes["parent"][row])
    return parent if parent >= 0 else None


def _key(session: Session, row: int, size: tuple[int, int]) -> object:
    """All that the marks depend on."""
    return (session.tree, row, size, session.turn, session.appearance.theme, frozenset(session.shown.kinds))


def _marks(session: Session, tree: RayTree, row: int, size: tuple[int, int]) -> list[Mark]:
    """The marks, in logical pixels."""
    kinds, is_turned = session.shown.kinds, False
    if session.turn is not None and session.world:
        found = turned(session.world, tree, row, session.turn)
        if found is None:
            session.turn_back()
            session.notice.say("another surface is in the way of such a ray")
        else:
            tree, row, is_turned = found, 0, True
    rows = frozenset(i for i in (row, *tree.children[row]) if i == row or tree.kind(i) in kinds)
    step = Step(tree, rows, frozenset())
    where = (0.0, 0.0, float(size[0]), float(size[1]))
    return hit_marks(step, row, PANEL_TEXT, session.appearance.theme, session.world, where, is_turned)


PANEL = Panel("Hit", draw, fills=True, figure="hit", shows_ray=True)

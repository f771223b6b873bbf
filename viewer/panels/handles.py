"""Dragging the handles of figures in panels: which one is under the mouse, which one is held, where it was moved to."""

from collections.abc import Sequence
from dataclasses import dataclass

from imgui_bundle import imgui

from viewer.figures.marks import Handle, Mark, Point
from viewer.figures.picking import handle_at, nearest_value
from viewer.session.session import Session

REACH = 11.0  # points from the mouse to the middle of a handle


@dataclass(frozen=True)
class Dragging:
    """The handles of one figure in one frame."""

    over: Handle | None  # under the mouse
    is_held: bool  # whether the mouse button went down on one
    moved: tuple[str, float] | None  # the name and the new value of the one that is dragged
    is_put_back: bool  # whether a double click asks for the values at first


def drag(session: Session, marks: Sequence[Mark], at: Point, threshold: float = -1.0) -> Dragging:
    """Drag the handles of the figure that the last imgui item shows. `at` is the mouse in the unit of the marks;
    `threshold` are the pixels from which on a movement counts (negative: imgui's own).
    """
    over = handle_at(marks, at, REACH)
    if imgui.is_item_activated():
        session.held_handle = over.name if over else None
    is_hovered = imgui.is_item_hovered()
    if over and is_hovered:
        imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    is_held = imgui.is_item_active() and session.held_handle is not None
    moved = None
    if is_held and imgui.is_mouse_dragging(imgui.MouseButton_.left, threshold):
        held = (mark for mark in marks if isinstance(mark, Handle) and mark.name == session.held_handle)
        moved = next(((handle.name, nearest_value(handle, at)) for handle in held), None)
    is_put_back = is_hovered and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    return Dragging(over, is_held, moved, is_put_back)

"""A live piece of a lesson, drawn below its text. Its handles are dragged; a double click puts them back."""

import math

import numpy as np
from imgui_bundle import imgui

from viewer.base.theme import PANEL_TEXT
from viewer.figures.marks import Mark, Point
from viewer.figures.picking import distance
from viewer.figures.writers.imgui import draw_marks
from viewer.gl.canvas import Canvas
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.live.piece import LiveContext
from viewer.lessons.live.pieces.samples import SAMPLE
from viewer.lessons.text import Fence
from viewer.panels import draw as d
from viewer.panels.handles import drag
from viewer.session.actions import choose_sample
from viewer.session.session import Session

LEAST = (320.0, 220.0)  # points: the smallest room of a piece
REACH = 3.0  # points from the mouse to a mark that is clicked
ASPECT = 1.0  # its height, at most, in widths


def draw_piece(session: Session, canvas: Canvas, fence: Fence, corner: Point, width: float, height: float) -> float:
    """Draw a piece at a place on the screen, into at most this width and height in pixels, if that is not too small.
    Returns the height that it took.
    """
    scale = _scale(width)
    size = (round(width / scale), int(min(ASPECT * width, max(height, least_height(width))) / scale))
    canvas.live_places[fence.line] = (*corner, scale)
    imgui.set_cursor_screen_pos(corner)
    imgui.invisible_button(f"live {fence.line}", (width, max(1.0, size[1] * scale)))
    mouse = imgui.get_mouse_pos()
    at = ((mouse.x - corner[0]) / scale, (mouse.y - corner[1]) / scale)
    try:
        marks = _marks(session, canvas, fence, size)
        if not _drag(session, marks, at):
            _click(session, fence, marks, at)
        draw_marks(imgui.get_window_draw_list(), _marks(session, canvas, fence, size), corner, scale)
    except ValueError as error:
        d.text(imgui.get_window_draw_list(), corner, session.appearance.theme.muted, str(error), imgui.get_font_size())
    return size[1] * scale


def least_height(width: float) -> float:
    """The height of a piece that has no more room, in pixels."""
    return LEAST[1] * _scale(width)


def _scale(width: float) -> float:
    """Pixels per point."""
    return min(d.unit(), width / LEAST[0])


def _marks(session: Session, canvas: Canvas, fence: Fence, size: tuple[int, int]) -> list[Mark]:
    """The marks, in points from the piece's top left corner."""
    name, *words = fence.content.split()
    parameters = session.player.parameters
    rows = _rows(session)
    theme = session.appearance.theme

    def images(depth: int) -> np.ndarray | None:
        return session.small_images.get(session.world, depth, session.model) if session.world else None

    def of_row(row: int) -> list[Mark]:
        where = (0.0, 0.0, float(size[0]), float(size[1]))
        context = LiveContext(session.tree, row, session.world, theme, PANEL_TEXT, where, images)
        return live_kind(name).marks(context, parameters, words)

    def make() -> list[Mark]:
        try:
            return of_row(rows[0])
        except ValueError as error:
            if not session.tree or len(rows) == 1:
                raise
            marks = of_row(rows[1])
            session.notice.say(f"{error}; it still shows {session.tree.label(rows[1])}")
            return marks

    key = (session.tree, rows, theme, fence, size, tuple(sorted(parameters.items())))
    key = (*key, session.world, session.model, len(session.small_images.kept))
    return canvas.live[fence.line].get(key, make)


def _rows(session: Session) -> tuple[int, ...]:
    """The rows of the tree whose hits are looked at: that of the selected ray, and after it that of the step, for a
    piece that the selected ray has no hit for.
    """
    player, tree = session.player, session.tree
    paths = (player.hit, player.step.state.hit if player.step else None)
    rows = [tree.find(path) for path in paths if tree and path]
    return tuple(dict.fromkeys(row for row in rows if row is not None)) or (0,)


def _drag(session: Session, marks: list[Mark], at: Point) -> bool:
    """Move a parameter with its handle. Returns whether the mouse is at one, or holds one."""
    dragging = drag(session, marks, at, threshold=0.0)
    if dragging.is_put_back:
        session.player.parameters = {}
    elif dragging.moved:
        session.player.parameters = {**session.player.parameters, **dict([dragging.moved])}
    return dragging.over is not None or dragging.is_held


def _click(session: Session, fence: Fence, marks: list[Mark], at: Point) -> None:
    """Set what the mark under the mouse stands for, with a click."""
    kind = live_kind(fence.content.split()[0])
    found = [(distance(mark, at), given) for mark in marks if (given := kind.clicked(mark.name))]
    away, given = min(found, key=lambda one: one[0], default=(math.inf, {}))
    if away > REACH or not imgui.is_item_hovered():
        return
    imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    if not d.is_clicked():
        return
    if SAMPLE in given:
        choose_sample(session, int(given[SAMPLE]))
    else:
        session.player.parameters = {**session.player.parameters, **given}

"""The lesson: the step's text as far as it is revealed. A scene that belongs to no lesson has no such panel."""

import math

from imgui_bundle import imgui

from tracer.tree.names import kind_of
from viewer.base.theme import Color
from viewer.explain.listing import listing
from viewer.gl.canvas import Canvas
from viewer.lessons.expectation import conditions
from viewer.lessons.text import Fence, filled
from viewer.lessons.values import ABSENT, value_text
from viewer.panels import draw as d
from viewer.panels.lessons.goal import draw_goal, goal_height
from viewer.panels.lessons.live import draw_piece, least_height
from viewer.panels.lessons.sweep import draw_handle
from viewer.panels.lessons.text_flow import BETWEEN, Colors, TextFlow
from viewer.panels.panel import Panel
from viewer.session.session import Session
from viewer.session.view_state import Request

TITLE = 1.25  # size of a step's title, in font sizes


def draw(session: Session, canvas: Canvas) -> None:
    step = session.lesson_step
    assert step  # otherwise there is no such panel
    corner, (width, height) = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
    colors = Colors(session.appearance.theme, lambda target: _color(session, target))
    flow = TextFlow(colors, corner.x, corner.y, width)
    goal = conditions(step.state.goal, session.tree, session.player.hit)
    below = goal_height(goal, width)
    bottom = corner.y + height - (below + BETWEEN * flow.em if below else 0.0)
    flow.fence = lambda fence: _fence(session, canvas, flow, fence, bottom)
    flow.heading(step.title, TITLE, session.appearance.theme.accent)
    flow.y += 0.5 * BETWEEN * flow.em
    taken = draw_handle(session, canvas, (corner.x, flow.y), width)
    flow.y += taken + BETWEEN * flow.em if taken else 0.0
    for part in step.parts[: session.player.shown.parts]:
        flow.blocks(filled(part.blocks, lambda name: _value(session, name)))
    draw_goal(session.appearance.theme, goal, (flow.x, flow.y), width)
    flow.y += below + BETWEEN * flow.em if below else 0.0
    used = flow.y - BETWEEN * flow.em - corner.y
    imgui.set_cursor_screen_pos(corner)
    imgui.dummy((1.0, max(1.0, used)))
    line = imgui.get_text_line_height_with_spacing()
    session.player.lines_too_many = max(0, math.ceil((used - height) / line))
    _follow(session, canvas, flow.pointed)


def _fence(session: Session, canvas: Canvas, flow: TextFlow, fence: Fence, bottom: float) -> bool:
    """Draw a live piece, or the source text of a function. A piece takes the room down to `bottom` that is left by the
    text below it, hidden parts included, so that it keeps its size when they appear.
    """
    match fence.kind:
        case "live":
            room = bottom - flow.y - _below(session, canvas, flow, fence)
            flow.y += draw_piece(session, canvas, fence, (flow.x, flow.y), flow.width, room)
        case "source":
            _source(flow, fence.argument)
        case _:
            return False
    return True


def _below(session: Session, canvas: Canvas, flow: TextFlow, fence: Fence) -> float:
    """The height of all that comes below a live piece in its step, in pixels. It is laid out where it is not seen."""
    step = session.lesson_step
    blocks = [block for part in step.parts for block in part.blocks] if step else []
    after = blocks[blocks.index(fence) + 1 :] if fence in blocks else []

    def make() -> float:
        unseen = TextFlow(flow.colors, flow.x, 0.0, flow.width)
        unseen.fence = lambda other: _measure(unseen, other)
        unseen.pad.push_clip_rect((0.0, 0.0), (0.0, 0.0))
        unseen.blocks(filled(after, lambda name: _value(session, name)))
        unseen.pad.pop_clip_rect()
        return unseen.y

    key = (session.tree, step, flow.width, flow.em)
    return canvas.below[fence.line].get(key, make) if after else 0.0


def _measure(flow: TextFlow, fence: Fence) -> bool:
    """Go down by the height of a fenced block; a live piece has the least one."""
    if fence.kind == "live":
        flow.y += least_height(flow.width)
    elif fence.kind == "source":
        _source(flow, fence.argument)
    return fence.kind in ("live", "source")


def _source(flow: TextFlow, name: str) -> None:
    """The text of the function that computes the numbers, with its file and line."""
    try:
        found = listing(name)
    except ValueError as error:
        flow.code([], str(error))
    else:
        flow.code(found.lines, found.place)


def _value(session: Session, name: str) -> str:
    """The text of a number that the lesson names."""
    step = session.lesson_step
    return value_text(session.tree, step.state.hit if step else None, name) or ABSENT


def _color(session: Session, target: str) -> Color:
    """The colour of a link: that of the kind of its ray, also while the tree on show does not have it."""
    theme = session.appearance.theme
    kind = kind_of(target[1:]) if target.startswith("#") else None
    return theme.ray(kind) if kind else theme.accent


def _row(session: Session, target: str) -> int | None:
    return session.tree.find(target[1:]) if session.tree and target.startswith("#") else None


def _follow(session: Session, canvas: Canvas, target: str | None) -> None:
    """Light the ray of the link under the mouse, and select it with a click."""
    row = _row(session, target) if target else None
    if row is None:
        canvas.leave("lesson")
        return
    canvas.hover("lesson", row)
    imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    if imgui.is_mouse_clicked(imgui.MouseButton_.left):
        session.select(row)


def _head(session: Session, room: float) -> None:
    """The lesson's title, and the place of the step."""
    lesson, theme = session.lesson, session.appearance.theme
    if lesson:
        place = f"{session.player.moment.step + 1}/{len(lesson.steps)}"
        size = imgui.get_font_size()
        left = room - d.text_size(place, size)[0] - size
        imgui.text_colored(theme.muted, place)
        imgui.same_line(0.0, 0.6 * size)
        imgui.text(d.shortened(lesson.title, size, left))


PANEL = Panel(
    "Lesson", draw, head=_head, request=Request.SHOW_LESSON, exists=lambda session: session.lesson is not None
)

"""The recursive procedure beside the tree: its source text with the line that runs, and the calls that are active with
their values.
"""

from collections.abc import Sequence

from imgui_bundle import imgui

from tracer.formulas.vector import Vector
from tracer.tree.raytree import RayTree
from viewer.base.theme import faded
from viewer.base.wording import format_number, format_rgb
from viewer.explain.recursion import Call, Recording, Statement, Values, source
from viewer.figures.catalogue import RECURSION
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.panel import Corner, Panel
from viewer.session.actions import step_line
from viewer.session.session import Session
from viewer.session.view_state import Request

FONT = 1  # of the fonts that the backend loads: that for source text
HANG = 8  # characters by which the rest of a long line is indented
FEWEST = 5  # lines of source text that are in view at least
COLUMNS = ("ray", "depth", "n1", "kr", "kt", "color")  # the variables have their names in the source text
MOST_CALLS = 6  # that are listed: the last ones


def draw(session: Session, canvas: Canvas) -> None:
    theme, recursion = session.appearance.theme, session.recursion
    if not session.tree:
        imgui.text_colored(theme.muted, "No pixel is picked.")
        return
    recursion.ask()
    recording, moment = recursion.recording, recursion.moment
    _controls(session)
    rows = _rows(session.tree, recording, moment)
    said = _said(session, recording, moment)
    below = _height(rows, said)
    room = imgui.get_content_region_avail().y - below - imgui.get_style().item_spacing.y
    _source(session, recording, moment, room)
    if rows:
        _calls(session, rows)
    if said:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_colored(theme.muted, said)
        imgui.pop_text_wrap_pos()


def _controls(session: Session) -> None:
    """Buttons for lines, and the file."""
    for label, by, hint in (("< line", -1, "back (Shift+Page Up)"), ("line >", 1, "on (Shift+Page Down)")):
        if imgui.button(label):
            step_line(session, by)
        d.hint(f"one line {hint}")
        imgui.same_line()
    imgui.align_text_to_frame_padding()
    imgui.text_colored(session.appearance.theme.muted, "tracer/whitted.py")


def _said(session: Session, recording: Recording | None, moment: int | None) -> str:
    """What there is to say about the record: how to begin, that it is not there yet, why it ends."""
    reveal = session.reveal
    if not reveal.step or reveal.order != RECURSION:
        return "Press O, then Page Down: the tree grows depth-first, as this procedure calls itself."
    if not recording:
        return "The run is being recorded …"
    return recording.note if moment is None or moment == len(recording.moments) - 1 else ""


# --- the source text --------------------------------------------------------------------------------------------------


def _source(session: Session, recording: Recording | None, moment: int | None, room: float) -> None:
    """The source text in a part of the panel that scrolls to the line that runs."""
    theme, text = session.appearance.theme, source()
    imgui.push_font(imgui.get_io().fonts.fonts[FONT], 0.0)
    line_height = imgui.get_text_line_height()
    imgui.begin_child("source", (0.0, max(room, FEWEST * line_height)))
    runs, waiting = _marked(recording, moment)
    wide = imgui.calc_text_size("0").x
    gutter = (len(str(text.numbers[-1])) + 1) * wide
    most = max(HANG + 8, int((imgui.get_content_region_avail().x - gutter) / wide))
    pad = imgui.get_window_draw_list()
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, 0.0))
    for number, line in zip(text.numbers, text.lines, strict=True):
        parts = wrapped_code(line, most)
        at = imgui.get_cursor_screen_pos()
        end = (at.x + imgui.get_content_region_avail().x, at.y + len(parts) * line_height)
        is_running = runs is not None and runs.first <= number <= runs.last
        if is_running:
            pad.add_rect_filled(at, end, d.u32(theme.accent), 3.0 * d.unit())
            if session.recursion.scrolled((recording, moment, room)):
                imgui.set_scroll_from_pos_y(at.y - imgui.get_window_pos().y + 0.5 * line_height, 0.5)
        elif number in waiting:
            pad.add_rect_filled(at, end, d.u32(faded(theme.accent, 0.25)), 3.0 * d.unit())
        for k, part in enumerate(parts):
            imgui.text_colored(theme.on_accent if is_running else theme.muted, str(number) if k == 0 else " ")
            imgui.same_line(gutter)
            imgui.text_colored(theme.on_accent if is_running else theme.text, part)
    imgui.pop_style_var()
    imgui.end_child()
    imgui.pop_font()


def _marked(recording: Recording | None, moment: int | None) -> tuple[Statement | None, set[int]]:
    """The statement that runs, and the lines in which its callers wait."""
    if not recording or moment is None:
        return None, set()
    text = source()
    callers = [recording.moments[call.moment].line for call, _ in recording.stack(moment)[1:]]
    waiting = {line for first in callers for line in range(first, text.statement(first).last + 1)}
    return text.statement(recording.moments[moment].line), waiting


def wrapped_code(line: str, most: int) -> list[str]:
    """A line of source text in parts of at most `most` characters, broken at blanks. The rest is indented further."""
    indent = len(line) - len(line.lstrip())
    parts, left = [], line
    while len(left) > most:
        inner = len(left) - len(left.lstrip())
        cut = left.rfind(" ", inner + 1, most + 1)
        cut = cut if cut > 0 else most
        parts.append(left[:cut].rstrip())
        left = " " * min(indent + HANG, most // 2) + left[cut:].lstrip()
    return [*parts, left]


# --- the calls --------------------------------------------------------------------------------------------------------


def _rows(tree: RayTree, recording: Recording | None, moment: int | None) -> list[tuple[Call | None, list[str]]]:
    """The active calls, the first one on top: (call, values). If there are many, only the last ones."""
    if not recording or moment is None:
        return []
    stack = recording.stack(moment)
    hidden = max(0, len(stack) - MOST_CALLS)
    found: list[tuple[Call | None, list[str]]] = [(None, [f"… {hidden} more"])] if hidden else []
    return found + [(call, _values(tree, call, values)) for call, values in stack[hidden:]]


def _values(tree: RayTree, call: Call, values: Values) -> list[str]:
    return [
        tree.label(call.row),
        str(values.depth),
        format_number(values.n1, 4),
        _number(values.kr),
        _number(values.kt),
        _color(values.color),
    ]


def _number(x: float | None) -> str:
    return "" if x is None else format_number(x, 3)


def _color(color: Vector | None) -> str:
    return "" if color is None else format_rgb(color, 3).replace("  ", " ")


def _widths(rows: Sequence[tuple[Call | None, list[str]]]) -> list[float]:
    cells = [COLUMNS, *(row for call, row in rows if call)]
    gap = 0.8 * imgui.get_font_size()
    return [gap + max(imgui.calc_text_size(row[k]).x for row in cells) for k in range(len(COLUMNS))]


def _fits(rows: Sequence[tuple[Call | None, list[str]]]) -> bool:
    return sum(_widths(rows)) <= imgui.get_content_region_avail().x


def _height(rows: Sequence[tuple[Call | None, list[str]]], said: str) -> float:
    """The height of all that stands below the source text."""
    line = imgui.get_text_line_height_with_spacing()
    per_call = 1 if _fits(rows) else 2
    calls = line * (1 + per_call * len(rows)) if rows else 0.0
    wide = imgui.get_content_region_avail().x
    return calls + (imgui.calc_text_size(said, wrap_width=wide).y + line if said else 0.0)


def _calls(session: Session, rows: Sequence[tuple[Call | None, list[str]]]) -> None:
    """A line for each call, in columns; in a narrow panel two lines, with the colour in the second."""
    theme, tree, widths, fits = session.appearance.theme, session.tree, _widths(rows), _fits(rows)
    assert tree
    names = list(COLUMNS if fits else COLUMNS[:-1])
    left = imgui.get_cursor_pos_x()
    for call, cells in [(None, names), *rows]:
        x = left
        for k, cell in enumerate(cells):
            if k == len(COLUMNS) - 1 and not fits:
                imgui.set_cursor_pos_x(left + widths[0])
            elif k:
                imgui.same_line(x)
            color = theme.muted if call is None else theme.text
            imgui.text_colored(theme.ray(tree.kind(call.row)) if call and k == 0 else color, cell)
            x += widths[k]


PANEL = Panel("Recursion", draw, Corner.BOTTOM_RIGHT, request=Request.SHOW_RECURSION)

"""The recursive procedure beside the tree: its source text with the line that runs, and the calls that are active with
their values.
"""

from dataclasses import dataclass

from imgui_bundle import imgui

from tracer.tree.raytree import RayTree
from viewer.base.theme import faded
from viewer.base.wording import format_number, format_rgb
from viewer.explain.listing import wrapped_code
from viewer.explain.recursion import Recording, Statement, Values, source
from viewer.figures.catalogue import RECURSION
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.panel import Panel
from viewer.panels.reveal import draw_controls
from viewer.session.actions import step_line
from viewer.session.session import Session
from viewer.session.view_state import Request

NARROWEST = 12  # characters of a line
FEWEST = 3  # lines of source text that are in view at least
ROOMY = 18  # lines of text: in a panel of this height there is room for the controls of the steps
COLUMNS = ("ray", "depth", "n1", "kr", "kt", "color")  # the variables have their names in the source text
FEWEST_CALLS, MOST_CALLS = 2, 8  # that are listed, as there is room: the last ones


def draw(session: Session, canvas: Canvas) -> None:
    theme, recursion = session.appearance.theme, session.recursion
    if not session.tree:
        imgui.text_colored(theme.muted, "No pixel is picked.")
        return
    if session.reveal.step and session.reveal.order == RECURSION:
        recursion.ask()
    recording, moment = recursion.recording, recursion.moment
    if imgui.get_content_region_avail().y >= ROOMY * imgui.get_text_line_height_with_spacing():
        draw_controls(session)
    _lines(session)
    said = _said(session, recording, moment)
    room, line, gap = imgui.get_content_region_avail(), imgui.get_text_line_height_with_spacing(), _gap()
    high = room.y - gap - (imgui.calc_text_size(said, wrap_width=room.x).y + gap if said else 0.0)
    most = int(high / line) - FEWEST - 1
    table = _table(session.tree, recording, moment, min(max(most, FEWEST_CALLS), MOST_CALLS))
    _source(session, recording, moment, high - table.lines * line)
    if table.rows:
        _calls(session, table)
    if said:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_colored(theme.muted, said)
        imgui.pop_text_wrap_pos()


def _gap() -> float:
    """Between two items."""
    return imgui.get_style().item_spacing.y


def _lines(session: Session) -> None:
    """Buttons to go from line to line, and the name of the file."""
    for label, by, hint in (("< line", -1, "back (Shift+Page Up)"), ("line >", 1, "on (Shift+Page Down)")):
        if imgui.button(label):
            step_line(session, by)
        d.hint(f"one line {hint}")
        imgui.same_line()
    imgui.align_text_to_frame_padding()
    imgui.text_colored(session.appearance.theme.muted, "tracer/whitted.py")


def _said(session: Session, recording: Recording | None, moment: int | None) -> str:
    """A remark on the record: how to begin, that it is not there yet, why it ends."""
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
    imgui.push_font(d.font(d.SOURCE), 0.0)
    line_height = imgui.get_text_line_height()
    imgui.begin_child("source", (0.0, max(room, FEWEST * line_height)))
    runs, waiting = _marked(recording, moment)
    wide = imgui.calc_text_size("0").x
    gutter = (len(str(text.numbers[-1])) + 1) * wide
    most = max(NARROWEST, int((imgui.get_content_region_avail().x - gutter) / wide))
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
                imgui.set_scroll_from_pos_y(0.5 * (at.y + end[1]) - imgui.get_window_pos().y, 0.5)
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


# --- the calls --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Table:
    """The active calls, the first one on top: a line for each, or two lines if the panel is narrow."""

    columns: tuple[str, ...]
    rows: list[tuple[str, list[str]]]  # the kind of the call's ray, and its cells
    hidden: int  # calls above these

    @property
    def widths(self) -> list[float]:
        cells = [self.columns, *(row for _, row in self.rows)]
        gap = 0.8 * imgui.get_font_size()
        return [gap + max(imgui.calc_text_size(row[k]).x for row in cells) for k in range(len(self.columns))]

    @property
    def fits(self) -> bool:
        return sum(self.widths) <= imgui.get_content_region_avail().x

    @property
    def lines(self) -> int:
        return 1 + (self.hidden > 0) + len(self.rows) * (1 if self.fits else 2) if self.rows else 0


def _table(tree: RayTree, recording: Recording | None, moment: int | None, most: int) -> _Table:
    """The table of the calls at a moment, at most the last `most`: in a narrow panel with fewer decimals, then without
    the index.
    """
    if not recording or moment is None:
        return _Table(COLUMNS, [], 0)
    stack = recording.stack(moment)
    shown = stack[-most:]
    for columns, decimals in ((COLUMNS, 3), (COLUMNS, 2), (tuple(name for name in COLUMNS if name != "n1"), 2)):
        rows = []
        for call, values in shown:
            cells = _cells(tree.label(call.row), values, decimals)
            rows.append((tree.kind(call.row), [cells[name] for name in columns]))
        table = _Table(columns, rows, len(stack) - len(shown))
        if table.fits:
            break
    return table


def _cells(label: str, values: Values, decimals: int) -> dict[str, str]:
    def number(x: float | None) -> str:
        return "" if x is None else format_number(x, 3)

    color = "" if values.color is None else format_rgb(values.color, decimals, gap=" ")
    cells = (label, str(values.depth), format_number(values.n1, 4), number(values.kr), number(values.kt), color)
    return dict(zip(COLUMNS, cells, strict=True))


def _calls(session: Session, table: _Table) -> None:
    theme, widths, fits = session.appearance.theme, table.widths, table.fits
    left = imgui.get_cursor_pos_x()
    if table.hidden:
        imgui.text_colored(theme.muted, f"… {table.hidden} more")
    for kind, cells in [("", list(table.columns)), *table.rows]:
        x = left
        for k, cell in enumerate(cells):
            if k == len(cells) - 1 and not fits:
                imgui.set_cursor_pos_x(left + widths[0])
            elif k:
                imgui.same_line(x)
            color = theme.text if kind else theme.muted
            imgui.text_colored(theme.ray(kind) if kind and k == 0 else color, cell)
            x += widths[k]


PANEL = Panel("Recursion", draw, request=Request.SHOW_RECURSION)

"""Two small windows: the errors of a file or of an action, and the notes on a scene. Both use the words of the command
line.
"""

from collections.abc import Sequence
from pathlib import Path

from imgui_bundle import imgui

from tracer.printable import printable
from viewer.base.theme import Color
from viewer.panels import draw as d
from viewer.session.session import Session


def draw(session: Session) -> None:
    """Draw the window of the faults; without faults, that of the notes. Closing it removes them."""
    theme = session.appearance.theme
    opening = session.loader.opening
    is_there = opening is not None and opening.path.is_file()
    if session.faults:
        count = len(session.faults)
        said = "1 fault" if count == 1 else f"{count} faults"
        title, head, faults = "This did not work", f"{said}.", session.faults
        if session.faults_in_files:
            kept = "; the last good scene stays" if session.world else ""
            again = " Save the file, and it is read again." if is_there else ""
            title, head = "This cannot be shown", f"{said}{kept}.{again}"
            faults = [_short_path(fault) if is_there else fault for fault in faults]
        if not _box(title, head, faults, theme.fault, session):
            session.faults = []
    elif session.notes and not _box(
        "Notes on this scene", "It is shown, except for this:", session.notes, theme.accent, session
    ):
        session.notes = []


def _box(title: str, head: str, lines: Sequence[str], color: Color, session: Session) -> bool:
    """Draw one window in the middle. Returns whether it stays open."""
    unit = d.unit()
    room = imgui.get_main_viewport()
    width = min(860 * unit, 0.9 * room.work_size.x)
    middle = (room.work_pos.x + 0.5 * room.work_size.x, room.work_pos.y + 0.5 * room.work_size.y)
    imgui.set_next_window_pos(middle, imgui.Cond_.always, (0.5, 0.5))
    imgui.set_next_window_size_constraints((width, 0), (width, 0.8 * room.work_size.y))
    imgui.push_style_color(imgui.Col_.window_bg, session.appearance.theme.raised)
    imgui.push_style_color(imgui.Col_.border, color)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.5 * unit)
    flags = imgui.WindowFlags_
    opened, stays = imgui.begin(
        title,
        True,
        flags.no_docking | flags.no_collapse | flags.no_saved_settings | flags.no_move | flags.always_auto_resize,
    )
    if opened:
        imgui.push_text_wrap_pos(width - 20 * unit)
        imgui.text_colored(color, head)
        imgui.separator()
        for line in lines:
            imgui.text(printable(line))
        imgui.pop_text_wrap_pos()
    imgui.end()
    imgui.pop_style_var()
    imgui.pop_style_color(2)
    return bool(stays)


def _short_path(fault: str) -> str:
    """The fault with the file's name only: in the window it is known which file it is."""
    path, colon, rest = fault.partition(": ")
    return f"{Path(path).name}{colon}{rest}"

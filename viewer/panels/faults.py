"""The window that lists the errors of a file or of an action, in the words of the command line."""

from pathlib import Path

from imgui_bundle import imgui

from viewer.panels import draw as d
from viewer.session.session import Session


def draw(session: Session) -> None:
    """Draw the window if there are faults. Closing it removes them."""
    if not session.faults:
        return
    unit = d.unit()
    room = imgui.get_main_viewport()
    width = min(860 * unit, 0.9 * room.work_size.x)
    middle = (room.work_pos.x + 0.5 * room.work_size.x, room.work_pos.y + 0.5 * room.work_size.y)
    imgui.set_next_window_pos(middle, imgui.Cond_.always, (0.5, 0.5))
    imgui.set_next_window_size_constraints((width, 0), (width, 0.8 * room.work_size.y))
    imgui.push_style_color(imgui.Col_.window_bg, session.appearance.theme.raised)
    imgui.push_style_color(imgui.Col_.border, session.appearance.theme.fault)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.5 * unit)
    flags = imgui.WindowFlags_
    opened, stays = imgui.begin(
        "This cannot be shown",
        True,
        flags.no_docking | flags.no_collapse | flags.no_saved_settings | flags.no_move | flags.always_auto_resize,
    )
    if opened:
        count = len(session.faults)
        said = "1 fault" if count == 1 else f"{count} faults"
        kept = "; the last good scene stays" if session.world else ""
        opening = session.loader.opening
        is_there = opening is not None and opening.path.is_file()
        again = " Save the file, and it is read again." if is_there else ""
        imgui.push_text_wrap_pos(width - 20 * unit)
        imgui.text_colored(session.appearance.theme.fault, f"{said}{kept}.{again}")
        imgui.pop_text_wrap_pos()
        imgui.separator()
        imgui.push_text_wrap_pos(width - 20 * unit)
        for fault in session.faults:
            imgui.text(_short_path(fault) if is_there else fault)
        imgui.pop_text_wrap_pos()
    imgui.end()
    imgui.pop_style_var()
    imgui.pop_style_color(2)
    if not stays:
        session.faults = []


def _short_path(fault: str) -> str:
    """The fault with the file's name only: in the window it is known which file it is."""
    path, colon, rest = fault.partition(": ")
    return f"{Path(path).name}{colon}{rest}"

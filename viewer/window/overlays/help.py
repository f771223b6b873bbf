"""The window that explains keys and mouse."""

from collections.abc import Sequence

from imgui_bundle import imgui

from viewer.session.session import Session


def draw(session: Session, keys: Sequence[tuple[str, str]]) -> None:
    """Draw the window if it is switched on. `keys` are pairs of a key and its meaning."""
    if not session.shows_help:
        return
    room = imgui.get_main_viewport()
    middle = (room.work_pos.x + 0.5 * room.work_size.x, room.work_pos.y + 0.5 * room.work_size.y)
    imgui.set_next_window_pos(middle, imgui.Cond_.appearing, (0.5, 0.5))
    flags = imgui.WindowFlags_
    imgui.push_style_color(imgui.Col_.window_bg, session.appearance.theme.raised)
    opened, stays = imgui.begin(
        "Keys and mouse",
        True,
        flags.no_docking | flags.always_auto_resize | flags.no_collapse | flags.no_saved_settings,
    )
    if opened and imgui.begin_table("keys", 2, imgui.TableFlags_.sizing_fixed_fit):
        for key, meaning in keys:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text_colored(session.appearance.theme.accent, key)
            imgui.table_next_column()
            imgui.text(meaning)
        imgui.end_table()
    imgui.end()
    imgui.pop_style_color()
    session.shows_help = bool(stays)

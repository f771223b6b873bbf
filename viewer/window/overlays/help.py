"""The window that explains keys and mouse."""

from collections.abc import Sequence

from imgui_bundle import imgui

from viewer.base.theme import FONT_SIZE, SMALL
from viewer.session.session import Session

SHARE = 0.96  # of the window, at most
WIDEST = 11.0  # column of keys, in font sizes


def draw(session: Session, keys: Sequence[tuple[str, str]]) -> None:
    """Draw the window if it is switched on. `keys` are pairs of a key and its meaning."""
    if not session.shows_help:
        return
    room = imgui.get_main_viewport()
    middle = (room.work_pos.x + 0.5 * room.work_size.x, room.work_pos.y + 0.5 * room.work_size.y)
    imgui.set_next_window_pos(middle, imgui.Cond_.always, (0.5, 0.5))
    imgui.set_next_window_size_constraints((0.0, 0.0), (SHARE * room.work_size.x, SHARE * room.work_size.y))
    imgui.set_next_window_size((SHARE * room.work_size.x, 0.0))
    flags = imgui.WindowFlags_
    imgui.push_style_color(imgui.Col_.window_bg, session.appearance.theme.raised)
    opened, stays = imgui.begin(
        "Keys and mouse", True, flags.no_docking | flags.no_collapse | flags.no_saved_settings | flags.no_resize
    )
    if opened:
        _columns(session, keys)
    imgui.end()
    imgui.pop_style_color()
    session.shows_help = bool(stays)


def _columns(session: Session, keys: Sequence[tuple[str, str]]) -> None:
    """The keys in two columns of the same number of rows."""
    half = (len(keys) + 1) // 2
    imgui.push_font(None, SMALL * FONT_SIZE)
    widest = max(imgui.calc_text_size(key).x for key, _ in keys)
    if imgui.begin_table("keys", 4, imgui.TableFlags_.sizing_stretch_prop):
        fixed, free = imgui.TableColumnFlags_.width_fixed, imgui.TableColumnFlags_.width_stretch
        for _ in range(2):
            imgui.table_setup_column("", fixed, min(widest, WIDEST * imgui.get_font_size()))
            imgui.table_setup_column("", free)
        for k in range(half):
            imgui.table_next_row()
            for key, meaning in keys[k : k + half + 1 : half]:
                for content, color in (
                    (key, session.appearance.theme.accent),
                    (meaning, session.appearance.theme.text),
                ):
                    imgui.table_next_column()
                    imgui.push_text_wrap_pos(0.0)
                    imgui.text_colored(color, content)
                    imgui.pop_text_wrap_pos()
        imgui.end_table()
    imgui.pop_font()

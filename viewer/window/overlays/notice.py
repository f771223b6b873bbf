"""The line about the last action, on a plate over the scene, where it hides no text."""

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.base.theme import faded
from viewer.panels import draw as d
from viewer.session.session import Session

PLATE = 0.94  # opacity
MARGIN = 10.0  # logical pixels


def draw(session: Session, left: float, bottom: float, width: float) -> None:
    """Draw the line in the middle of this width, with its lower border above `bottom`."""
    if not session.notice.text:
        return
    unit, theme = d.unit(), session.appearance.theme
    imgui.set_next_window_pos((left + 0.5 * width, bottom - MARGIN * unit), imgui.Cond_.always, (0.5, 1.0))
    imgui.set_next_window_size_constraints((0.0, 0.0), (0.9 * width, 0.5 * bottom))
    flags = imgui.WindowFlags_
    imgui.push_style_color(imgui.Col_.window_bg, faded(theme.raised, PLATE))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 6.0 * unit)
    imgui.begin(
        "##notice", None, flags.no_decoration | flags.no_move | flags.no_docking | flags.no_saved_settings
        | flags.always_auto_resize | flags.no_inputs | flags.no_focus_on_appearing,
    )  # fmt: skip
    internal.bring_window_to_display_front(internal.get_current_window())
    imgui.push_text_wrap_pos(0.9 * width - 2.0 * MARGIN * unit)
    imgui.text(session.notice.text)
    imgui.pop_text_wrap_pos()
    imgui.end()
    imgui.pop_style_var()
    imgui.pop_style_color()

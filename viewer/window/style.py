"""A theme as an imgui style."""

from imgui_bundle import imgui

from viewer.base.theme import FONT_SIZE, Color, Theme, faded


def apply(theme: Theme, scale: float, zoom: float) -> None:
    """Set all colours and sizes. `scale` is the screen's, `zoom` the user's."""
    style = imgui.get_style()
    _reset(style)  # sizes are multiplied below, from the defaults, so that nothing is scaled twice
    style.font_size_base = FONT_SIZE
    style.font_scale_dpi = scale
    style.font_scale_main = zoom
    style.window_padding = imgui.ImVec2(8, 6)
    style.frame_padding = imgui.ImVec2(7, 4)
    style.item_spacing = imgui.ImVec2(8, 5)
    style.cell_padding = imgui.ImVec2(5, 2)
    style.scrollbar_size = 11
    style.frame_rounding = 4
    style.grab_rounding = 4
    style.tab_rounding = 4
    style.popup_rounding = 5
    style.window_rounding = 0
    style.window_border_size = 0
    style.tab_bar_border_size = 0
    style.docking_separator_size = 3
    style.window_menu_button_position = imgui.Dir.none
    style.hover_stationary_delay = 0.25
    style.scale_all_sizes(scale * zoom)
    col = imgui.Col_
    clear: Color = (0.0, 0.0, 0.0, 0.0)
    colors = {
        col.text: theme.text,
        col.text_disabled: theme.muted,
        col.window_bg: theme.panel,
        col.child_bg: clear,
        col.popup_bg: theme.raised,
        col.border: theme.border,
        col.frame_bg: theme.raised,
        col.frame_bg_hovered: theme.hover,
        col.frame_bg_active: theme.hover,
        col.title_bg: theme.ground,
        col.title_bg_active: theme.ground,
        col.title_bg_collapsed: theme.ground,
        col.menu_bar_bg: theme.ground,
        col.scrollbar_bg: clear,
        col.scrollbar_grab: theme.hover,
        col.scrollbar_grab_hovered: theme.muted,
        col.scrollbar_grab_active: theme.muted,
        col.check_mark: theme.accent,
        col.slider_grab: theme.accent,
        col.slider_grab_active: theme.accent,
        col.button: theme.raised,
        col.button_hovered: theme.hover,
        col.button_active: theme.accent,
        col.header: theme.raised,
        col.header_hovered: theme.hover,
        col.header_active: theme.hover,
        col.separator: theme.ground,
        col.separator_hovered: theme.accent,
        col.separator_active: theme.accent,
        col.resize_grip: clear,
        col.resize_grip_hovered: theme.hover,
        col.resize_grip_active: theme.accent,
        col.tab: theme.ground,
        col.tab_hovered: theme.hover,
        col.tab_selected: theme.panel,
        col.tab_selected_overline: theme.accent,
        col.tab_dimmed: theme.ground,
        col.tab_dimmed_selected: theme.panel,
        col.tab_dimmed_selected_overline: theme.panel,
        col.docking_preview: faded(theme.accent, 0.4),
        col.docking_empty_bg: theme.ground,
        col.table_row_bg: clear,
        col.table_row_bg_alt: clear,
        col.text_selected_bg: faded(theme.accent, 0.35),
        col.nav_cursor: theme.accent,
        col.modal_window_dim_bg: (0.0, 0.0, 0.0, 0.35),
        col.input_text_cursor: theme.text,
    }
    for which, color in colors.items():
        style.set_color_(which, color)


def _reset(style: imgui.Style) -> None:
    """Set every size to imgui's default."""
    defaults = imgui.Style()
    for name in dir(defaults):
        # The factor of scale_all_sizes must be reset as well, though its name is private.
        value = getattr(defaults, name)
        if (not name.startswith("_") or name == "_main_scale") and not callable(value):
            setattr(style, name, value)

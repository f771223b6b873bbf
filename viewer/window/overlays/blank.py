"""The black screen, over everything: the room looks at the lecturer."""

from imgui_bundle import imgui


def draw() -> None:
    room = imgui.get_main_viewport()
    imgui.set_next_window_pos(room.pos)
    imgui.set_next_window_size(room.size)
    imgui.set_next_window_focus()  # in front of all other windows
    imgui.push_style_color(imgui.Col_.window_bg, (0.0, 0.0, 0.0, 1.0))
    flags = imgui.WindowFlags_
    imgui.begin("##black", None, flags.no_decoration | flags.no_move | flags.no_docking | flags.no_saved_settings)
    imgui.end()
    imgui.pop_style_color()
    imgui.set_mouse_cursor(imgui.MouseCursor_.none)

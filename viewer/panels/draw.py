"""Helpers of all panels: text on a plate, fonts and sizes, buttons that are on or off, hints. Lines and signs are marks
(`viewer.figures.writers.imgui`).
"""

from collections.abc import Iterator
from contextlib import contextmanager

from imgui_bundle import imgui

from viewer.base.theme import FONT_SIZE, SMALL, Color, Theme, faded

Point = tuple[float, float]

ROOMY = (1060.0, 560.0)  # a panel from this size on, in logical pixels, is large
BOLD, ITALIC, SOURCE = 1, 2, 3  # numbers of fonts, after the usual one


def u32(color: Color) -> int:
    return imgui.get_color_u32(color)


def unit() -> float:
    """Pixels per logical pixel. Sizes are multiplied by it."""
    return imgui.get_font_size() / FONT_SIZE


def font(which: int) -> imgui.ImFont:
    """One of the fonts of the window (`viewer.window.fonts`)."""
    return imgui.get_io().fonts.fonts[which]


@contextmanager
def bold(size: float = 0.0) -> Iterator[None]:
    """Text of the second weight, at a font size in logical pixels (0: the size on hand)."""
    imgui.push_font(font(BOLD), size)
    try:
        yield
    finally:
        imgui.pop_font()


def figure_scale(room: imgui.ImVec2) -> float:
    """Pixels per point of a figure in a panel of this size: in a large panel, figures are larger than other text."""
    return unit() * max(1.0, min(room.x / (ROOMY[0] * unit()), room.y / (ROOMY[1] * unit())))


def small_text(content: str, color: Color) -> None:
    """A line of text of the smaller size."""
    imgui.push_font(None, SMALL * imgui.get_style().font_size_base)
    imgui.text_colored(color, content)
    imgui.pop_font()


def text_size(text: str, size: float) -> Point:
    """Width and height of a text at a font size."""
    found = imgui.calc_text_size(text)
    share = size / imgui.get_font_size()
    return (found.x * share, found.y * share)


def shortened(content: str, size: float, room: float) -> str:
    """A text cut to fit into `room`, with an ellipsis."""
    if text_size(content, size)[0] <= room:
        return content
    while len(content) > 4 and text_size(content + "…", size)[0] > room:
        content = content[:-1]
    return content.rstrip() + "…"


def text(
    draw: imgui.ImDrawList, at: Point, color: Color, content: str, size: float, plate: Color | None = None
) -> None:
    """A text with its top left corner at `at`. A `plate` of the background's colour makes it legible on any image."""
    size = round(size)
    x, y = round(at[0]), round(at[1])  # between pixels, letters blur
    if plate:
        width, height = text_size(content, size)
        grow = round(0.18 * size)
        draw.add_rect_filled(
            (x - grow, y - 1), (x + width + grow, y + height + 1), u32(faded(plate, 0.78)), 0.25 * size
        )
    draw.add_text(imgui.get_font(), size, (x, y), u32(color), content)


def toggle(theme: Theme, label: str, on: bool) -> bool:
    """A button that shows whether it is on. Returns whether it was pressed."""
    if on:
        imgui.push_style_color(imgui.Col_.button, theme.accent)
        imgui.push_style_color(imgui.Col_.button_hovered, theme.accent)
        imgui.push_style_color(imgui.Col_.text, theme.on_accent)
    pressed = imgui.button(label)
    if on:
        imgui.pop_style_color(3)
    return pressed


def is_clicked() -> bool:
    """Whether the left button came up over the item before, in the place where it went down: no drag."""
    io = imgui.get_io()
    is_released = imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.left)
    return is_released and io.mouse_drag_max_distance_sqr[0] < io.mouse_drag_threshold**2


def hint(content: str) -> None:
    """A tooltip for the item before."""
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        imgui.set_tooltip(content)

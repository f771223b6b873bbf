"""Drawing that all panels share: text with a halo, dashed lines, arrow heads, in the colours of a theme."""

import math
from collections.abc import Iterator
from contextlib import contextmanager

from imgui_bundle import imgui

from viewer.base.theme import FONT_SIZE, SMALL, Arrow, Color, RayStyle, Theme, faded

Point = tuple[float, float]


def u32(color: Color) -> int:
    return imgui.get_color_u32(color)


def unit() -> float:
    """Pixels per logical pixel. Sizes are multiplied by it."""
    return imgui.get_font_size() / FONT_SIZE


@contextmanager
def bold(size: float = 0.0) -> Iterator[None]:
    """Text of the second weight, at a font size in logical pixels (0: the size on hand)."""
    imgui.push_font(imgui.get_io().fonts.fonts[1], size)
    try:
        yield
    finally:
        imgui.pop_font()


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


def line(draw: imgui.ImDrawList, a: Point, b: Point, color: Color, width: float, dash: Point = (0.0, 0.0)) -> None:
    """A line, dashed if `dash` (on, off in pixels) is not zero."""
    if dash[0] <= 0.0:
        draw.add_line(a, b, u32(color), width)
        return
    span = math.dist(a, b)
    ink = u32(color)
    place = 0.0
    while place < span:
        end = min(place + dash[0], span)
        draw.add_line(_between(a, b, place / span), _between(a, b, end / span), ink, width)
        place += dash[0] + dash[1]


def arrow(draw: imgui.ImDrawList, a: Point, b: Point, at: float, color: Color, size: float, kind: Arrow) -> None:
    """An arrow head on the line from a to b, its tip at the share `at` of the length."""
    span = math.dist(a, b)
    if kind is Arrow.NONE or span < 1.5 * size:
        return
    dx, dy = (b[0] - a[0]) / span, (b[1] - a[1]) / span

    def back(tip: Point, length: float, side: float) -> Point:
        return (tip[0] - dx * length - dy * side, tip[1] - dy * length + dx * side)

    tip = _between(a, b, min(1.0, at + 0.5 * size / span))
    ink = u32(color)
    half = 0.42 * size
    if kind is Arrow.FILLED:
        draw.add_triangle_filled(tip, back(tip, size, half), back(tip, size, -half), ink)
        return
    for k in range(2 if kind is Arrow.DOUBLE else 1):
        head = back(tip, 0.5 * size * k, 0.0)
        for side in (half, -half):
            draw.add_line(head, back(head, 0.75 * size, side), ink, max(1.5, size / 6.0))


def cross(draw: imgui.ImDrawList, at: Point, radius: float, color: Color, width: float) -> None:
    ink = u32(color)
    draw.add_line((at[0] - radius, at[1] - radius), (at[0] + radius, at[1] + radius), ink, width)
    draw.add_line((at[0] - radius, at[1] + radius), (at[0] + radius, at[1] - radius), ink, width)


def sun(draw: imgui.ImDrawList, at: Point, radius: float, color: Color, halo: Color) -> None:
    """A light: a disc with eight rays."""
    for ink, grow in ((u32(halo), 1.5), (u32(color), 0.0)):
        draw.add_circle_filled(at, 0.55 * radius + grow, ink)
        for k in range(8):
            dx, dy = math.cos(k * math.pi / 4), math.sin(k * math.pi / 4)
            a = (at[0] + 0.75 * radius * dx, at[1] + 0.75 * radius * dy)
            b = (at[0] + (radius + grow * 0.5) * dx, at[1] + (radius + grow * 0.5) * dy)
            draw.add_line(a, b, ink, 1.6 + 2 * grow)


def eye(draw: imgui.ImDrawList, at: Point, radius: float, color: Color) -> None:
    ink = u32(color)
    draw.path_elliptical_arc_to(at, (1.5 * radius, 0.8 * radius), 0.0, 0.0, 2 * math.pi, 32)
    draw.path_stroke(ink, 1.6 * unit())
    draw.add_circle_filled(at, 0.45 * radius, ink)


def sample(draw: imgui.ImDrawList, at: Point, width: float, style: RayStyle, color: Color, scale: float) -> None:
    """A piece of a ray, for the legend."""
    a, b = at, (at[0] + width, at[1])
    dash = (style.dash[0] * scale * 0.8, style.dash[1] * scale * 0.8)
    line(draw, a, b, color, style.width * scale, dash)
    arrow(draw, a, b, 0.62, color, 9.0 * scale, style.arrow)


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


def hint(content: str) -> None:
    """A tooltip for the item before."""
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        imgui.set_tooltip(content)


def _between(a: Point, b: Point, share: float) -> Point:
    return (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))

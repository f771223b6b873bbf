"""The frame of the panels in one place: its titles, and below or behind them the panel in front.

Words on a picture stand on a plate. A click on a title brings its panel to the front, a double click gives it all of
the room.
"""

from collections.abc import Callable, Iterable, Sequence

from imgui_bundle import imgui

from viewer.base.theme import faded
from viewer.panels import draw as d
from viewer.panels.panel import Panel
from viewer.session.layout import Rectangle
from viewer.session.session import Session

PLATE = 0.82  # opacity
MARGIN = 8.0  # logical pixels: from the border of the panel
BETWEEN = 16.0  # two titles


def draw(
    session: Session,
    sharing: Sequence[Panel],
    front: Panel,
    where: Rectangle,
    body: Callable[[], object],
    head: Callable[[float], object],
) -> None:
    """Draw the panel in front of those that share a place.

    `body` draws its content, `head` what is beside the title, in so many pixels. The head comes last: it shows what is
    picked in the content.
    """
    _begin(front, where)
    if front.plate and len(sharing) == 1:
        body()
        _plate(session, front, front.plate(session))
    else:
        unit = d.unit()
        imgui.set_cursor_pos((0.0, 0.75 * MARGIN * unit + imgui.get_frame_height()))
        _body(session, front, body)
        _row(session, sharing, front, head)
    imgui.end()


def draw_first(front: Panel, where: Rectangle, part: Callable[[], object]) -> None:
    """Draw a part of a panel before the panel itself."""
    _begin(front, where)
    part()
    imgui.end()


def _begin(front: Panel, where: Rectangle) -> None:
    """Begin the window of a panel, or go on with it."""
    flags = imgui.WindowFlags_
    imgui.set_next_window_pos(where[:2])
    imgui.set_next_window_size(where[2:])
    imgui.push_style_var(imgui.StyleVar_.window_padding, (0.0, 0.0))
    imgui.begin(
        front.title, None, flags.no_decoration | flags.no_move | flags.no_docking | flags.no_saved_settings
        | flags.no_bring_to_front_on_focus | flags.no_scroll_with_mouse | flags.no_nav_focus,
    )  # fmt: skip
    imgui.pop_style_var()
    imgui.set_cursor_pos((0.0, 0.0))


def _body(session: Session, front: Panel, body: Callable[[], object]) -> None:
    flags = imgui.WindowFlags_
    still = flags.no_scrollbar | flags.no_scroll_with_mouse if front.fills else flags.none
    padded = imgui.ChildFlags_.none if front.fills else imgui.ChildFlags_.always_use_window_padding
    beside, above = 1.5 * MARGIN * d.unit(), 0.25 * MARGIN * d.unit()
    imgui.push_style_var(imgui.StyleVar_.window_padding, (beside, above))
    if not front.fills:  # as wide with a scroll bar as without: nothing moves when one appears
        room = imgui.get_content_region_avail().x - 2.0 * beside - imgui.get_style().scrollbar_size
        imgui.set_next_window_content_size((max(1.0, room), 0.0))
    if imgui.begin_child("body", (0.0, 0.0), padded, still):
        body()
        if session.scroll and not front.fills:
            lines = session.scroll * imgui.get_text_line_height_with_spacing()
            imgui.set_scroll_y(imgui.get_scroll_y() + lines)
    imgui.end_child()
    imgui.pop_style_var()


def _row(session: Session, sharing: Sequence[Panel], front: Panel, head: Callable[[float], object]) -> None:
    """The titles of all panels in the place, in a row."""
    unit = d.unit()
    imgui.set_cursor_pos((1.5 * MARGIN * unit, 0.75 * MARGIN * unit))
    imgui.begin_group()
    titles = sharing if len(sharing) > 1 or front.is_named else ()
    room = imgui.get_content_region_avail().x - front.head_room(session) * imgui.get_font_size()
    is_short = _row_width(panel.title for panel in titles) > room
    hidden = 0
    if is_short and _row_width(panel.short or panel.title for panel in titles) > room:
        titles, hidden = [front], len(titles) - 1
    for k, panel in enumerate(titles):
        if k:
            imgui.same_line(0.0, BETWEEN * unit)
        _title(
            session, panel, panel is front, len(sharing) > 1, panel.short if is_short and panel.short else panel.title
        )
    if hidden:
        imgui.same_line(0.0, BETWEEN * unit)
        imgui.text_colored(session.appearance.theme.muted, f"{hidden} more: P")
    if front.head:
        if titles:
            imgui.same_line(0.0, BETWEEN * unit)
        head(imgui.get_content_region_avail().x)
    elif front.plate:
        imgui.same_line(0.0, BETWEEN * unit)
        imgui.text(front.plate(session))
    imgui.end_group()


def _plate(session: Session, panel: Panel, words: str) -> None:
    """Words on the picture. The plate has its size at once: one that fits itself would be late by a frame."""
    unit, theme = d.unit(), session.appearance.theme
    text, (beside, above) = imgui.calc_text_size(words), (MARGIN * unit, 0.5 * MARGIN * unit)
    room = imgui.get_window_width() - 2.0 * beside
    imgui.set_cursor_pos((MARGIN * unit, MARGIN * unit))
    imgui.push_style_color(imgui.Col_.child_bg, faded(theme.panel, PLATE))
    imgui.push_style_var(imgui.StyleVar_.child_rounding, 6.0 * unit)
    imgui.push_style_var(imgui.StyleVar_.window_padding, (beside, above))
    flags = imgui.WindowFlags_
    size = (min(room, text.x + 2.0 * beside), text.y + 2.0 * above)
    if imgui.begin_child(
        "plate", size, imgui.ChildFlags_.always_use_window_padding,
        flags.no_scrollbar | flags.no_saved_settings | flags.no_nav,
    ):  # fmt: skip
        imgui.text(words)
        if imgui.is_window_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
            session.layout.maximise(panel.name)
    imgui.end_child()
    imgui.pop_style_var(2)
    imgui.pop_style_color()


def _row_width(titles: Iterable[str]) -> float:
    with d.bold():
        return sum(imgui.calc_text_size(title).x + BETWEEN * d.unit() for title in titles)


def _title(session: Session, panel: Panel, is_front: bool, is_choice: bool, words: str = "") -> None:
    theme, words = session.appearance.theme, words or panel.title
    with d.bold():
        size = imgui.calc_text_size(words)
        at = imgui.get_cursor_screen_pos()
        pressed = imgui.invisible_button(f"title {panel.title}", size)
        color = theme.text if is_front or imgui.is_item_hovered() else theme.muted
        pad = imgui.get_window_draw_list()
        pad.add_text(at, d.u32(color), words)
        if is_front and is_choice:
            below = at.y + size.y + 1.0
            pad.add_line((at.x, below), (at.x + size.x, below), d.u32(theme.accent), 2.0 * d.unit())
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        session.layout.maximise(panel.name)
    elif pressed:
        session.layout.bring_to_front(panel.name, session.appearance.is_lecture_size)

"""The menu of lessons: the course at the left, the deeper ones beside it, each with a picture of its scene."""

from imgui_bundle import imgui

from viewer.figures.marks import Raster
from viewer.figures.writers.imgui import draw_marks
from viewer.panels import draw as d
from viewer.session.actions import open_lesson
from viewer.session.lecture.lesson_list import SIZE, Entry
from viewer.session.session import Session

# In font sizes.
GAP = 0.6  # between a picture and its title
WIDEST = 22.0  # a title
BETWEEN = 1.4  # two columns
ROW = 2.4  # height of a row, if there is room
APART = 0.3  # two pictures
AROUND = 4.0  # the rows: the bar, the titles of the columns, margins


def draw(session: Session) -> None:
    """The content of the menu. Titles are read when it opens; pictures come when they are there."""
    listed = session.lesson_list
    if imgui.is_window_appearing() or not listed.entries:
        listed.read()
    em, theme = imgui.get_font_size(), session.appearance.theme
    columns = [
        (title, [entry for entry in listed.entries if entry.is_deeper == is_deeper])
        for title, is_deeper in (("The course", False), ("Deeper", True))
    ]
    columns = [(title, entries) for title, entries in columns if entries]
    whole = imgui.get_main_viewport().size
    room = whole.x / len(columns) - 2.0 * em
    most = max(len(entries) for _, entries in columns)
    high = min(ROW * em, (whole.y - AROUND * em) / most - imgui.get_style().item_spacing.y)
    for k, (title, entries) in enumerate(columns):
        if k:
            imgui.same_line(0.0, BETWEEN * em)
        imgui.begin_group()
        imgui.text_colored(theme.muted, title)
        wide = min(room, max(_width(entry, high) for entry in entries))
        for entry in entries:
            _row(session, entry, (wide, high))
        imgui.end_group()


def _picture_size(high: float) -> tuple[float, float]:
    """The size of a picture in a row of this height."""
    height = high - APART * imgui.get_font_size()
    return height * SIZE[0] / SIZE[1], height


def _width(entry: Entry, high: float) -> float:
    """The width of a row of this height, at most."""
    em = imgui.get_font_size()
    return _picture_size(high)[0] + GAP * em + min(WIDEST * em, imgui.calc_text_size(entry.title).x)


def _row(session: Session, entry: Entry, size: tuple[float, float]) -> None:
    em, theme, pad = imgui.get_font_size(), session.appearance.theme, imgui.get_window_draw_list()
    is_on = session.lesson is not None and session.lesson.name == entry.name
    if imgui.selectable(f"##{entry.name}", is_on, size=size)[0]:
        open_lesson(session, entry.name)
    (left, top), (_, bottom) = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    (wide, high), middle = _picture_size(size[1]), 0.5 * (top + bottom)
    corner = (left, middle - 0.5 * high)
    pixels = session.lesson_list.picture(entry.name) if session.warmup.ready else None
    if pixels is None:
        pad.add_rect_filled(corner, (left + wide, corner[1] + high), d.u32(theme.raised))
    else:
        center = (left + 0.5 * wide, middle)
        draw_marks(pad, [Raster(entry.name, center, (wide, high), SIZE, pixels.tobytes())], (0.0, 0.0), 1.0)
    at = left + wide + GAP * em
    content = d.shortened(entry.title, em, size[0] - (at - left))
    pad.add_text((round(at), round(middle - 0.5 * em)), d.u32(theme.accent if is_on else theme.text), content)

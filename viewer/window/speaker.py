"""The content of the speaker's window: the notes of the step on show, what comes next, and the time."""

import time

from imgui_bundle import imgui

from tracer.printable import printable, printable_lines
from viewer.base.files import Unusable
from viewer.lessons import lesson as lessons
from viewer.lessons.moments import count_presses
from viewer.panels import draw as d
from viewer.session.session import Session
from viewer.window import style

TITLE = "Speaker – raytree"
ZOOM = 1.35  # of the usual type
CLOCK = 2.2  # font sizes
MARGIN = 0.8  # around all, in font sizes


def draw(session: Session, scale: float) -> None:
    """Fill the window whose imgui context is current. `scale` is its screen's."""
    theme = session.appearance.theme
    style.apply(theme, scale, ZOOM)
    room, flags = imgui.get_main_viewport(), imgui.WindowFlags_
    imgui.set_next_window_pos(room.pos)
    imgui.set_next_window_size(room.size)
    imgui.push_style_color(imgui.Col_.window_bg, theme.panel)
    imgui.begin("##speaker", None, flags.no_decoration | flags.no_move | flags.no_saved_settings | flags.no_nav)
    em = imgui.get_font_size()
    imgui.set_cursor_pos((MARGIN * em, MARGIN * em))
    imgui.begin_group()
    _time(session, room.size.x - 2.0 * MARGIN * em)
    imgui.push_text_wrap_pos(room.size.x - MARGIN * em)
    _place(session)
    _notes(session)
    imgui.pop_text_wrap_pos()
    imgui.end_group()
    imgui.end()
    imgui.pop_style_color()


def _time(session: Session, wide: float) -> None:
    """The time since the lesson began against its minutes, and the time of day."""
    theme, lesson = session.appearance.theme, session.lesson
    seconds = session.clock.seconds if lesson else 0
    minutes = lesson.minutes if lesson else None
    is_over = minutes is not None and seconds > 60 * minutes
    left = imgui.get_cursor_pos_x()
    with d.bold(CLOCK * imgui.get_style().font_size_base):
        imgui.text_colored(theme.fault if is_over else theme.text, clock_text(seconds))
    low = imgui.get_cursor_pos_y()
    now, of_all = time.strftime("%H:%M"), f"of {minutes} minutes" if minutes else ""
    imgui.same_line()
    beside = imgui.get_cursor_pos_x()
    for x, words in ((beside, of_all), (left + wide - imgui.calc_text_size(now).x, now)):
        imgui.set_cursor_pos((x, low - 1.5 * imgui.get_font_size()))  # on the clock's baseline
        imgui.text_colored(theme.muted, words)
    imgui.set_cursor_pos((left, low + 0.2 * imgui.get_font_size()))


def clock_text(seconds: int) -> str:
    """Minutes and seconds."""
    return f"{seconds // 60}:{seconds % 60:02}"


def _place(session: Session) -> None:
    """The step on show and the presses in it, and what the next ones lead to."""
    theme, lesson, step = session.appearance.theme, session.lesson, session.lesson_step
    if not lesson or not step:
        imgui.text_colored(theme.muted, "No lesson is on show.")
        return
    player = session.player
    moment, presses = player.moment, count_presses(step, player.stages)
    place = f"{moment.step + 1}/{len(lesson.steps)}"
    imgui.text_colored(theme.muted, printable(lesson.title))
    with d.bold():
        imgui.text(printable(f"{place}  {step.title}"))
    if presses:
        imgui.text_colored(theme.muted, f"press {moment.press} of {presses}")
    imgui.text_colored(theme.muted, printable(f"next: {_next(session)}"))
    imgui.dummy((0.0, 0.4 * imgui.get_font_size()))


def _next(session: Session) -> str:
    """The title of the next step, or of the next lesson."""
    lesson, number = session.lesson, session.player.moment.step + 1
    assert lesson
    if number < len(lesson.steps):
        return lesson.steps[number].title
    name = lessons.neighbour(lesson, 1)
    if name is None:
        return "the end of the course" if lessons.ends_course(lesson) else "the end"
    try:
        return f"the lesson “{lessons.read_title(name)}”"
    except Unusable:
        return f"the lesson {name}"


def _notes(session: Session) -> None:
    step = session.lesson_step
    if not step:
        return
    if step.notes:
        imgui.text_wrapped(printable_lines(step.notes))
    else:
        imgui.text_colored(session.appearance.theme.muted, "no notes for this step")

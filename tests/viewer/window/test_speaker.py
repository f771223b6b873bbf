"""The speaker's window: a real second window, with notes and a clock; a remote works in it, too."""

from dataclasses import replace
from pathlib import Path

import glfw
import numpy as np
from imgui_bundle import imgui

from tests.viewer.desk import LINUX_ONLY, Desk
from tests.viewer.driver import viewer
from tests.viewer.screen import hand
from viewer.lessons import lesson as lessons
from viewer.lessons.moments import Moment
from viewer.session.lecture.clock import LessonClock
from viewer.window.speaker import TITLE, clock_text


def ink(picture: np.ndarray, rows: slice) -> int:
    """The pixels in these rows that are not the ground."""
    return int((np.abs(picture[rows].astype(int) - picture[0, 0]).max(axis=2) > 40).sum())


@LINUX_ONLY
def test_the_second_window_follows_the_lesson() -> None:
    desk = Desk("mirror-balls")
    session, app = desk.session, desk.app
    try:
        hand("windowactivate", "--sync", desk.id)
        hand("key", "w")
        desk.until(lambda: app.speaker is not None, "the speaker's window")
        speaker = app.speaker
        assert speaker and hand("search", "--name", TITLE)
        first, *rest = lessons.read("mirror-balls").steps
        silent, noted = replace(first, notes=""), replace(rest[0], notes="Ask first.\nThen press the key.")
        lesson = replace(lessons.read("mirror-balls"), steps=(silent, noted))
        pictures = []
        for step in (0, 1):
            session.player.show(lesson, Moment(step))
            app.settle()
            app.tell_speaker()
            pictures.append(speaker.picture().copy())
        # Notes are in the text's colour, which is brighter than the hint that there are none.
        assert ink(pictures[0], slice(200, None)) < ink(pictures[1], slice(200, None))
        before = desk.window_picture().copy()
        app.frame()
        app.tell_speaker()
        app.frame()
        assert np.array_equal(desk.window_picture(), before)  # neither window draws into the other
        session.player.show(lesson, Moment(0))
        app.settle()
        hand("windowfocus", "--sync", glfw.get_x11_window(speaker.window))
        desk.until(lambda: bool(glfw.get_window_attrib(speaker.window, glfw.FOCUSED)), "the focus")
        app.frame()  # keys that come in the frame in which the focus leaves the main window are dropped
        hand("key", "Page_Down")
        desk.until(lambda: session.player.moment != Moment(0), "the key in the speaker's window")
        glfw.set_window_should_close(speaker.window, True)
        app.tell_speaker()
        assert app.speaker is None and not session.guard.caught
        app.frame()
        assert desk.window.ctx.error == "GL_NO_ERROR"
    finally:
        app.close()


def test_without_a_screen_there_is_no_second_window() -> None:
    with viewer() as driver:
        driver.open("mirror-balls")
        driver.type("w")
        assert driver.app.speaker is None and driver.session.notice.text == "there is no screen for a second window"
        driver.press(imgui.Key.escape)


def test_the_clock_begins_with_the_lesson_and_at_its_first_moment_again() -> None:
    clock, lesson = LessonClock(), lessons.read("mirror-balls")
    other = replace(lesson, path=Path("other"))

    def begins(*at: object) -> bool:
        before, clock.began = clock.began, -1.0
        clock.look(*at)  # type: ignore[arg-type]
        found = clock.began != -1.0
        clock.began = clock.began if found else before
        return found

    assert begins(lesson, Moment(2)) and not begins(lesson, Moment(2, 1)) and not begins(lesson, Moment(1))
    assert begins(lesson, Moment()) and not begins(lesson, Moment()) and not begins(lesson, Moment(0, 1))
    assert begins(other, Moment(0, 1)) and clock.seconds == 0
    assert [clock_text(seconds) for seconds in (0, 59, 60, 754, 6001)] == ["0:00", "0:59", "1:00", "12:34", "100:01"]

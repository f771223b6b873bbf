"""Moments are prepared while the one before is on show: the first frame of the next one is complete."""

import numpy as np
from imgui_bundle import imgui

from tests.viewer.driver import Driver
from tests.viewer.session.given import begin, picture
from viewer.gl.magnified import Place
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import Moment
from viewer.panels.image import waiting_lines
from viewer.session.image_renderer import _new_picture
from viewer.session.lecture.ahead import LAST
from viewer.session.session import Session

K = imgui.Key


def wait_for_prepared(session: Session) -> None:
    """Wait for the scenes and images that are prepared for the next presses."""
    while session.loader.worker.submit(session.calls.run_posted).result() or session.image.aside or session.image.ahead:
        session.image.runner.submit(lambda: None).result()


def first_frame(driver: Driver, key: imgui.Key) -> np.ndarray:
    """The frame right after a key is pressed."""
    imgui.get_io().add_key_event(key, True)
    driver.frames(1)
    first = driver.app.surface.grab()[:-40].copy()
    imgui.get_io().add_key_event(key, False)
    return first


def test_the_keys_go_on_to_the_next_lesson(driver: Driver) -> None:
    """The neighbouring lesson is prepared as well: its first frame is complete."""
    first, second = (lessons.read(name) for name in ("snell", "lifeguard"))
    session = driver.session
    session.player.show(first, Moment(len(first.steps) - 1, LAST))
    driver.app.settle()
    before = picture(driver)
    for key, lesson, moment in ((K.page_down, second, Moment()), (K.page_up, first, session.player.moment)):
        wait_for_prepared(session)
        frame = first_frame(driver, key)
        assert session.lesson == lesson and session.player.moment == moment
        assert session.image.picture and session.image.picture.finished
        assert np.array_equal(frame, picture(driver))
    assert np.array_equal(before, picture(driver))


def test_the_next_moment_is_complete_in_the_first_frame(driver: Driver, mine: Lesson) -> None:
    """Scene, image and tree of the next step are prepared while the one before is on show."""
    begin(driver, mine)
    session = driver.session
    for key in (K.page_down, K.page_down, K.page_down, K.page_up, K.page_up):
        wait_for_prepared(session)
        before = session.player.moment
        first = first_frame(driver, key)
        assert session.player.moment != before and session.loader.loading is None
        assert session.image.picture and session.image.picture.finished and session.tree
        assert np.array_equal(first, picture(driver)), session.player.moment
    assert session.player.moment == Moment(0, 1)


def test_an_image_without_tiles_is_not_a_black_one(driver: Driver, mine: Lesson) -> None:
    """Until its first tile is there, the image's place says that it renders; a later image follows the one before."""
    begin(driver, mine)
    session = driver.session
    finished = session.image.picture
    assert finished and not finished.is_blank
    world, limits, size = session.image_job(2)
    later = _new_picture((world, limits, size), finished)
    assert later.follows and not later.is_blank and np.array_equal(later.shown, finished.shown)
    session.image.picture = _new_picture((world, limits, size), None)
    assert session.image.picture.is_blank
    assert driver.canvas.seen(Place(0.0, 0.0, 1.0, (0.0, 0.0, 9.0, 9.0))) is None
    assert waiting_lines(session) == ["Rendering ..."]

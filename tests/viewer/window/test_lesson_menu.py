"""The menu of lessons: two columns, and a picture of each scene, made when the menu first opens, then kept on disk."""

from pathlib import Path

import numpy as np
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

import tracer
from tests.viewer.driver import Driver, viewer
from viewer.base.srgb import srgb
from viewer.lessons import lesson
from viewer.session.lecture.lesson_list import SAMPLES, SIZE, LessonList


def wait(listed: LessonList) -> None:
    """Until the pictures that were asked for are made."""
    assert listed.runner
    listed.runner.submit(lambda: None).result()


def made(folder: Path, name: str) -> np.ndarray | None:
    """The picture of a lesson in a new list."""
    listed = LessonList(lambda call: call(), folder)
    listed.picture(name)
    wait(listed)
    listed.close()
    return listed.picture(name)


def test_a_picture_is_the_image_of_the_scene_and_is_kept(tmp_path: Path) -> None:
    """A damaged one is made again; one of another lesson, or in a folder that cannot be written to, is no fault."""
    world = tracer.prepare(tracer.load(lesson.read("glass-ball").scene))
    pixels = srgb(tracer.render(world, SIZE, samples=SAMPLES, depth=3).pixels)
    first = made(tmp_path, "glass-ball")
    assert first is not None and np.array_equal(first, pixels)
    (file,) = (tmp_path / "thumbnails").iterdir()
    written = file.stat().st_mtime_ns
    again = made(tmp_path, "glass-ball")
    assert again is not None and np.array_equal(again, pixels) and file.stat().st_mtime_ns == written
    content = file.read_bytes()
    for damaged in (b"", b"no picture", content[:200]):
        file.write_bytes(damaged)
        again = made(tmp_path, "glass-ball")
        assert again is not None and np.array_equal(again, pixels) and file.read_bytes() == content
    nowhere = tmp_path / "a file"
    nowhere.write_bytes(b"")
    again = made(nowhere, "glass-ball")
    assert again is not None and np.array_equal(again, pixels)


def open_menu(driver: Driver, x: float) -> internal.Window:
    driver.move(x, 1.0)
    driver.frames()
    driver.click(x, 12.0)
    driver.frames()
    (found,) = (w for w in imgui.get_current_context().windows if "##Menu_" in w.name and w.active)
    return found


def test_the_menu_opens_at_once_and_opens_lessons(tmp_path: Path) -> None:
    """At the start nothing is rendered; the first frame of the menu does not wait for a picture. In lecture mode, the
    menu stays while the mouse is on it.
    """
    with viewer() as driver:
        listed = driver.session.lesson_list
        listed.folder = tmp_path
        driver.open("two-lights")
        assert not listed.asked and listed.runner is None and not list(tmp_path.iterdir())
        for x, chosen in ((137.0, 1), (225.0, 2)):
            menu = open_menu(driver, x)
            assert [entry.name for entry in listed.entries] == lesson.names()
            course = [entry.name for entry in listed.entries if not entry.is_deeper]
            assert course == lesson.course()
            wait(listed)
            driver.frames()
            assert set(listed.pictures) == set(lesson.names())
            assert menu.pos.y + menu.size.y <= 720.0 and menu.pos.x + menu.size.x <= 1280.0
            em = imgui.get_font_size()
            high = (menu.size.y - 2.0 * em) / max(len(course), len(listed.entries) - len(course))
            driver.click(menu.pos.x + 60.0, menu.pos.y + 2.0 * em + (chosen + 0.5) * high)
            driver.app.settle()
            assert driver.session.lesson and driver.session.lesson.name == course[chosen]
            driver.move(400.0, 400.0)
            driver.press(imgui.Key.tab)

"""A lesson is given with two keys: every moment is an absolute state, the same forwards and backwards, bit by bit."""

from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

from tests.conftest import ALL_LESSONS
from tests.viewer.driver import Driver
from tests.viewer.session.given import TEXT, begin, picture
from viewer.figures.marks import Handle, point_along
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.moments import Moment
from viewer.lessons.skeleton import SCENE
from viewer.session.lecture.ahead import LAST
from viewer.session.loading.opening import Opening

K = imgui.Key


def test_two_keys_lead_through_every_moment_and_back(driver: Driver, mine: Lesson) -> None:
    begin(driver, mine)
    session, seen = driver.session, list[tuple[Moment, np.ndarray]]()
    while not seen or session.player.moment != seen[-1][0]:
        seen.append((session.player.moment, picture(driver)))
        driver.press(K.page_down)
        driver.app.settle()
    assert [moment for moment, _ in seen] == [
        Moment(0, 0), Moment(0, 1),
        Moment(1, 0), Moment(1, 1), Moment(1, 2), Moment(1, 3),  # depth 0, 1, 2, and the hidden part
        Moment(2, 0), Moment(2, 1),  # the camera ray, and the reflected ray
        Moment(3, 0), Moment(3, 1), Moment(3, 2),  # no sum, that of R, that of E
        Moment(4, 0), Moment(4, 1), Moment(4, 2),  # both ends of the sweep, and the hidden part
        Moment(5, 0), Moment(5, 1),
    ]  # fmt: skip
    assert session.notice.text == "the last step of Mine"
    for moment, forwards in reversed(seen):
        assert session.player.moment == moment
        assert np.array_equal(picture(driver), forwards), moment
        driver.press(K.page_up)
        driver.app.settle()
    assert session.player.moment == Moment()


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", ALL_LESSONS)
def test_every_lesson_is_given_from_start_to_end(driver: Driver, name: str) -> None:
    """Every moment of a lesson is the same forwards and backwards, and there is one for each press."""
    begin(driver, lessons.read(name))
    session, seen = driver.session, list[tuple[Moment, np.ndarray]]()
    while session.lesson and session.lesson.name == name and (not seen or session.player.moment != seen[-1][0]):
        seen.append((session.player.moment, picture(driver)))
        assert not session.faults
        driver.press(K.page_down)
        driver.app.settle()
    assert [moment.step for moment, _ in seen] == sorted(moment.step for moment, _ in seen)
    assert {moment.step for moment, _ in seen} == set(range(len(lessons.read(name).steps)))
    session.player.show(lessons.read(name), seen[-1][0])
    for moment, forwards in reversed(seen):
        assert np.array_equal(picture(driver), forwards), moment
        assert session.player.moment == moment
        driver.press(K.page_up)


def test_a_moment_is_the_same_after_wandering_off(driver: Driver, mine: Lesson) -> None:
    begin(driver, mine)
    driver.session.player.show(mine, Moment(1, 1))
    before = picture(driver)
    assert driver.session.world and driver.session.world.scene.objects[0].material.reflect == 0.4
    driver.session.pick(20, 200)
    driver.session.set_depth(3)
    driver.session.orbit.distance *= 2.0
    driver.session.shown.toggle_kind("shadow")
    driver.session.layout.maximise("image")
    driver.frames()
    driver.press(K.home)
    assert np.array_equal(picture(driver), before)


def test_no_press_is_lost_while_a_scene_is_loaded(driver: Driver, mine: Lesson) -> None:
    begin(driver, mine)
    session = driver.session
    session.player.show(mine, Moment(0, 1))
    session.loader.prepared.scenes.clear()
    session.player.go(1)
    assert session.loader.loading and session.player.moment == Moment(0, 1)
    session.player.go(1)
    driver.app.settle()
    assert session.player.moment == Moment(1, 1) and session.depth == 1


def test_the_text_is_shown_as_far_as_it_is_revealed(driver: Driver, mine: Lesson) -> None:
    begin(driver, mine)
    player = driver.session.player
    assert (player.shown.parts, driver.session.selection, driver.session.at) == (1, "R", None)
    driver.press(K.page_down)
    assert (player.shown.parts, driver.session.at) == (2, (1, 1))


def test_the_course_ends(driver: Driver) -> None:
    """Deeper lessons do not follow by themselves; among them, one follows the other."""
    last, deeper = lessons.course()[-1], [name for name in lessons.names() if name not in lessons.course()]
    lesson = lessons.read(last)
    driver.session.player.show(lesson, Moment(len(lesson.steps) - 1, LAST))
    driver.app.settle()
    assert driver.session.player.go(1) and driver.session.loader.loading is None
    assert driver.session.lesson == lesson
    assert driver.session.notice.text == "the course ends here; deeper lessons are in the menu"
    found = [lessons.neighbour(lessons.read(name), by) for name in (deeper[0], deeper[-1]) for by in (-1, 1)]
    assert found == [None, deeper[1], deeper[-2], None]


def test_a_lesson_begins_with_its_question(driver: Driver, mine: Lesson) -> None:
    """A lesson that was opened as a scene is given from the moment on show: the first press reveals no answer."""
    driver.session.loader.load(Opening(mine.scene, mine))
    driver.app.settle()
    driver.press(K.tab)
    assert not driver.session.layout.taught and driver.session.appearance.is_lecture_size
    driver.press(K.page_down)
    driver.app.settle()
    assert driver.session.layout.taught and driver.session.player.moment == Moment()
    shown = picture(driver)
    driver.press(K.page_down)
    assert driver.session.player.moment == Moment(0, 1)
    driver.press(K.page_up)
    assert np.array_equal(picture(driver), shown)


def test_a_live_piece_is_drawn_and_dragged(driver: Driver, tmp_path: Path) -> None:
    """The lifeguard's place on the shore: at 4 of 7 metres the time is least, 35/12 seconds."""
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    text = '+++\ntitle = "Guard"\nquestion = "Where?"\npixel = [160, 150]\n+++\n## One\n```live\nlifeguard 4 3\n```\n'
    (tmp_path / "lesson.md").write_text(text, "utf-8")
    begin(driver, read_file(tmp_path / "lesson.md"))
    ((line, (left, top, scale)),) = driver.canvas.live_places.items()
    handle = next(mark for mark in driver.canvas.live[line].last if isinstance(mark, Handle))
    before = picture(driver)
    low, high = handle.range
    goal = point_along((handle.path[0], handle.path[-1]), (4.0 - low) / (high - low))
    start, end = ((left + scale * x, top + scale * y) for x, y in (handle.at, goal))
    driver.drag([start, (start[0] + 3.0, start[1]), end])
    pixel = (high - low) / (scale * (handle.path[-1][0] - handle.path[0][0]))  # the mouse is at whole pixels
    assert driver.session.player.parameters == {"x": pytest.approx(4.0, abs=pixel)}
    assert not np.array_equal(picture(driver), before)
    driver.press(K.home)
    driver.move(5.0, 300.0)
    assert driver.session.player.parameters == {}


def test_a_piece_stays_at_the_hit_of_the_step(driver: Driver, tmp_path: Path) -> None:
    """A ray that meets nothing is selected: the piece still shows the hit of the step, and this is said."""
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    head = '+++\ntitle = "Ball"\nquestion = "Where?"\npixel = [160, 150]\n+++\n'
    text = head + '## One\n```step\nhit = "E"\n```\n```live\nsphere\n```\n'
    (tmp_path / "lesson.md").write_text(text, "utf-8")
    begin(driver, read_file(tmp_path / "lesson.md"))
    session, (line,) = driver.session, driver.canvas.live_places
    before = driver.canvas.live[line].last
    assert session.tree
    away = next(row for row in range(len(session.tree)) if session.tree.nodes["object"][row] < 0)
    session.select(away)
    driver.frames()
    assert driver.canvas.live[line].last == before
    assert (
        session.notice.text
        == f"sphere: {session.tree.label(away)} meets nothing; it needs a ray that meets a surface; it still shows E"
    )


def test_a_saved_lesson_is_shown_at_the_moment_on_show(driver: Driver, mine: Lesson) -> None:
    """Steps of one scene, which is not loaded again; and a fault of the text is told in the next frame."""
    begin(driver, mine)
    session = driver.session
    for _ in range(8):
        driver.press(K.page_down)
        driver.app.settle()
    moment, watch = session.player.moment, session.loader.watch
    assert moment == Moment(3, 0)

    def save(text: str) -> bool:
        """Whether the frame is drawn anew."""
        mine.path.write_text(text, "utf-8")
        found = []
        for _ in range(3):  # looks that agree
            watch.last = 0.0
            found.append(session.update())
        driver.app.settle()
        return any(found)

    save(TEXT.replace("Hidden", "Behind"))
    assert session.player.moment == moment and not session.faults
    assert save(TEXT.replace('title = "Mine"', "title ="))
    assert session.player.moment == moment and any("line 2" in fault for fault in session.faults)


def test_a_mouse_that_rests_lights_no_ray_of_the_next_moment(driver: Driver, mine: Lesson) -> None:
    begin(driver, mine)
    session = driver.session
    session.player.show(mine, Moment(1, 2))
    driver.app.settle()
    driver.frames()
    place = driver.canvas.nodes[0]
    driver.move(*place)
    driver.frames()
    assert session.hovered == 0
    driver.press(K.page_down)
    driver.app.settle()
    assert session.hovered is None
    driver.move(place[0] + 1.0, place[1])
    driver.frames()
    assert session.hovered == 0

"""The whole lecture in a real window, given with the two keys of a remote: Page Down and Page Up."""

import hashlib
from collections.abc import Callable

import pytest

from tests.viewer.desk import LINUX_ONLY, Desk
from tests.viewer.screen import hand
from viewer.lessons import lesson as lessons
from viewer.lessons.moments import Moment

pytestmark = [LINUX_ONLY, pytest.mark.slow, pytest.mark.timeout(1800)]

Place = tuple[str, Moment]
ROUNDS = 6000  # of events to wait for an image: that of three plates at depth 11 takes seconds
DEEPER = [name for name in lessons.names() if name not in lessons.course()]


def give(names: list[str]) -> None:
    """From the first moment of the first lesson to the last one of the last, and back: the same places and pictures."""
    desk = Desk(names[0])
    session, player = desk.session, desk.session.player
    hand("windowactivate", "--sync", desk.id)

    def is_at_rest() -> bool:
        small, loader = session.small_images, session.loader
        return desk.is_quiet() and not loader.loading and not player.sweeping.is_playing and small.is_at_rest

    def press(key: str, shown: Callable[[], bool]) -> None:
        hand("key", key)
        desk.until(lambda: shown() and is_at_rest(), f"{key} at {place()}", ROUNDS)

    def place() -> Place:
        assert session.lesson
        return session.lesson.name, player.moment

    def picture() -> str:
        """A hash of the window at rest without the bar, which has the times of images."""
        session.notice.text = ""
        for _ in range(4):
            desk.app.frame()
        return hashlib.sha256(desk.window_picture()[:-40].tobytes()).hexdigest()

    press("Tab", lambda: session.appearance.is_lecture_size)
    press("Page_Down", lambda: bool(session.layout.taught))
    seen: list[tuple[Place, str]] = []
    while True:
        assert not session.faults and player.lines_too_many == 0
        seen.append((place(), picture()))
        hand("key", "Page_Down")
        desk.until(
            lambda: (place() != seen[-1][0] or bool(session.notice.text)) and is_at_rest(),
            f"after {seen[-1][0]}",
            ROUNDS,
        )
        if place() == seen[-1][0]:
            break
    assert {name for (name, _), _ in seen} == set(names)
    for name in names:
        steps = {moment.step for (found, moment), _ in seen if found == name}
        assert steps == set(range(len(lessons.read(name).steps)))
    assert [place for place, _ in seen] == sorted(
        (place for place, _ in seen), key=lambda place: (names.index(place[0]), place[1])
    )
    for expected in reversed(seen[:-1]):
        press("Page_Up", lambda expected=expected: place() == expected[0])
        assert (place(), picture()) == expected
    desk.app.close()


def test_the_course() -> None:
    give(lessons.course())


def test_the_deeper_lessons() -> None:
    give(DEEPER)

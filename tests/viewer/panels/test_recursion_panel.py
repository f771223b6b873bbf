"""The recursion beside the tree: its line and the tree's step lead to each other, and nothing is cut off."""

from collections.abc import Iterator

import numpy as np
import pytest
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tests.viewer.driver import Driver, body, viewer
from viewer.explain.recursion import source
from viewer.figures.catalogue import RECURSION
from viewer.panels import recursion
from viewer.session.view_state import Request

Key = imgui.Key


@pytest.fixture
def glass() -> Iterator[Driver]:
    with viewer() as driver:
        driver.open("glass-ball")
        yield driver


def begin(driver: Driver) -> None:
    """Bring the panel to the front, and go to the first depth-first step."""
    driver.session.requests.append(Request.SHOW_RECURSION)
    driver.frames(4)
    driver.type("o")
    driver.press(Key.mod_ctrl, Key.page_down)
    driver.session.recursion.wait()
    driver.frames()


def window(title: str) -> internal.Window:
    found = internal.find_window_by_name(title)
    assert found
    return found


def test_nothing_is_recorded_while_the_panel_is_hidden_or_the_order_is_another(glass: Driver) -> None:
    session = glass.session
    for hidden, order in ((Request.SHOW_RAY, "recursion"), (Request.SHOW_RECURSION, "breadth")):
        session.requests.append(hidden)
        session.reveal.set_order(order)
        session.reveal.first()
        glass.frames(4)
        assert session.recursion.tree is None
    session.reveal.leave()
    begin(glass)
    assert session.recursion.recording and session.recursion.recording.tree is session.tree


def test_a_step_sets_the_line_and_a_line_the_step(glass: Driver) -> None:
    begin(glass)
    session = glass.session
    reveal, lines = session.reveal, session.recursion
    recording = lines.recording
    assert recording and reveal.order == RECURSION and lines.moment == 0
    seen = []
    for k in range(len(recording.moments)):
        assert lines.moment == k
        step = session.step
        moment = recording.moments[k]
        assert step and moment.row in step.current and moment.sums == (step.sum is not None)
        seen.append(reveal.position)
        glass.press(Key.mod_shift, Key.page_down)
    assert lines.moment == len(recording.moments) - 1  # it stays on the last line
    assert sorted(set(seen)) == list(range(len(reveal.steps or ()))) and seen == sorted(seen)
    for k in range(len(recording.moments) - 2, -1, -1):
        glass.press(Key.mod_shift, Key.page_up)
        assert lines.moment == k and reveal.position == seen[k]
    for position in (7, 3, 12, 0):  # a step chosen otherwise begins at its first line
        reveal.go_to(position)
        glass.frames()
        assert lines.moment == seen.index(position)


def test_another_pixel_has_its_own_run(glass: Driver) -> None:
    begin(glass)
    session = glass.session
    for x in (300, 420, 500, 640):
        session.pick(x, 300)
        glass.frames(1)
    session.recursion.wait()
    glass.frames()
    session.recursion.wait()
    glass.frames()
    assert session.recursion.recording and session.recursion.recording.tree is session.tree
    glass.type("1")  # another depth
    session.recursion.wait()
    glass.frames()
    assert session.recursion.recording and max(m.values.depth for m in session.recursion.recording.moments) == 1


def test_the_line_that_runs_is_marked_and_in_view(glass: Driver) -> None:
    begin(glass)
    session = glass.session
    theme = session.appearance.theme
    accent = (np.array(theme.accent[:3]) * 255).round()
    recording = session.recursion.recording
    assert recording
    for _ in recording.moments:
        place = window(recursion.PANEL.title).rect()
        picture = glass.picture()[int(place.min.y) : int(place.max.y), int(place.min.x) : int(place.max.x), :3]
        assert (np.abs(picture.astype(float) - accent).max(axis=2) < 3).sum() > 1500
        glass.press(Key.mod_shift, Key.page_down)


@pytest.mark.parametrize("size", [(900, 600), (1280, 720)])
@pytest.mark.parametrize("large", [False, True])
def test_nothing_is_cut_off_at_the_side(glass: Driver, size: tuple[int, int], large: bool) -> None:
    glass.resize(size)
    if large:
        glass.press(Key.tab)
    begin(glass)
    recording = glass.session.recursion.recording
    assert recording
    for k in range(0, len(recording.moments), 5):
        glass.session.recursion.go(k - (glass.session.recursion.moment or 0))
        glass.frames(3)
        panel = body(recursion.PANEL.title)
        assert panel.content_size.x <= panel.inner_rect.get_width()


def test_the_page_says_where_it_differs_from_the_kernel(glass: Driver) -> None:
    glass.open("scale")
    begin(glass)
    session = glass.session
    assert session.recursion.recording and "epsilon" in session.recursion.recording.note
    glass.press(Key.mod_ctrl, Key.page_down)
    glass.press(Key.mod_ctrl, Key.page_down)
    assert session.recursion.moment is None and session.step  # the tree goes on, the page shows no line
    glass.press(Key.mod_shift, Key.page_up)
    assert session.recursion.moment == 0  # back to the last line that there is


def test_lines_have_room() -> None:
    assert all(len(line) <= 64 for line in source().lines[1:])  # at the usual size, in a panel of 460 pixels


def test_the_controls_of_the_steps(glass: Driver) -> None:
    """Each button does what its key does. They are found by pressing along the rows of the panel."""
    glass.resize((1280, 1200))
    begin(glass)
    session = glass.session
    reveal = session.reveal

    def state() -> tuple[object, ...]:
        return (reveal.granularity, reveal.order, reveal.position, reveal.is_playing, reveal.loops, reveal.speed)

    def reset() -> None:
        reveal.set_order(RECURSION)
        reveal.go_to(5)
        reveal.pause()
        reveal.loops, reveal.speed = False, 1.0
        glass.frames(1)

    reset()
    start, found = state(), set()
    place = body(recursion.PANEL.title).inner_rect
    for y in (place.min.y + 14, place.min.y + 44):
        for x in range(int(place.min.x) + 12, int(place.max.x), 14):
            reset()
            glass.move(x, y)
            glass.button(True)
            glass.button(False)
            if state() != start:
                found.add(state())
    play, levels = ("rays", RECURSION, 5, True, False, 1.0), ("levels", "breadth")
    assert found >= {
        play,
        *(("rays", RECURSION, k, False, False, 1.0) for k in (0, 4, 6, len(reveal.steps or ()) - 1, None)),
        ("rays", RECURSION, 5, False, True, 1.0),
        *(("rays", RECURSION, 5, False, False, speed) for speed in (0.5, 2.0)),
    }
    assert {one[:2] for one in found} == {("rays", RECURSION), ("rays", "breadth"), levels}

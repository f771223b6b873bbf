"""A lecture at the desk: keys that are hit by accident, a remote, another keyboard. A real window, real keys."""

import math
import subprocess
import time
from collections.abc import Iterator
from dataclasses import replace

import pytest
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tests.viewer.desk import LINUX_ONLY, Desk
from tests.viewer.driver import Driver, body, viewer
from tests.viewer.screen import hand
from viewer.base.theme import FONT_SIZE, LECTURE_ZOOM
from viewer.figures.catalogue import BREADTH, RECURSION
from viewer.figures.steps import by_level
from viewer.panels import PANELS, ray, tree
from viewer.session.layout import Corner
from viewer.session.stepping.reveal import LEVELS, RAYS
from viewer.window import bar
from viewer.window.app import FASTEST

pytestmark = [pytest.mark.early, LINUX_ONLY]


@pytest.fixture
def desk() -> Iterator[Desk]:
    made = Desk("glass-ball")
    hand("windowactivate", "--sync", made.id)
    yield made
    made.app.close()


def key(desk: Desk, *names: str) -> None:
    """Type keys, and wait until the window has handled all of them: a change of the depth, typed last, says so."""
    depth = 1 if desk.session.depth != 1 else 2
    hand("key", *names, str(depth))
    desk.until(lambda: desk.session.depth == depth, f"the keys {names}")


def test_tab_changes_the_size_and_nothing_else(desk: Desk) -> None:
    hand("mousemove", *desk.pixel_at(300, 200), "click", 1)
    desk.until(lambda: desk.session.pixel != desk.session.lesson.first.state.pixel, "the click")  # type: ignore[union-attr]
    pixel = desk.session.pixel
    for large in (True, False, True, False):
        key(desk, "Tab")
        assert desk.session.appearance.is_lecture_size == large
        assert not imgui.get_io().want_text_input and not imgui.is_any_item_active()
    key(desk, "ctrl+Tab", "shift+Tab")
    assert desk.session.pixel == pixel and not imgui.get_io().want_text_input


def test_a_coordinate_is_typed_over_the_old_one_and_other_keys_leave_the_field(desk: Desk) -> None:
    left, top = desk.place()
    session = desk.session
    assert session.pixel
    row = session.pixel[1]

    def enter_field() -> None:
        hand("mousemove", left + 845, top + 43, "click", 1)
        desk.until(lambda: imgui.get_io().want_text_input, "the field")

    enter_field()
    hand("key", "3", "0", "5", "Return")
    desk.until(lambda: session.pixel == (305, row), "the typed coordinate")
    key(desk)
    for name, acted in (
        ("b", lambda: session.is_blank),
        ("period", lambda: session.is_blank),
        ("Tab", lambda: session.appearance.is_lecture_size),
        ("alt+Left", lambda: session.pixel != (305, row)),
        ("t", lambda: not session.appearance.theme.dark),
    ):
        enter_field()
        hand("key", name)
        desk.until(acted, f"{name} from within the field")
        if session.is_blank:
            hand("key", "space")
            desk.until(lambda: not session.is_blank, "the window")
        if session.appearance.is_lecture_size:
            hand("key", "Tab")
            desk.until(lambda: not session.appearance.is_lecture_size, "the usual size")
        key(desk)


def test_signs_above_digits_are_not_digits(desk: Desk) -> None:
    key(desk)
    hand("key", "parenleft", "ampersand", "exclam")
    key(desk, "a")
    assert desk.session.depth in (1, 2) and not desk.session.shown.labels


def test_lessons_and_panels_by_keys(desk: Desk) -> None:
    hand("key", "ctrl+o")
    desk.until(lambda: imgui.get_io().want_text_input, "the dialog")
    frames = imgui.get_frame_count()
    hand("key", "Return")  # the folder on show: the field takes the keyboard again
    desk.until(lambda: imgui.get_frame_count() > frames + 5 and imgui.get_io().want_text_input, "the field")
    hand("key", "ctrl+a")
    hand("type", "underwater")
    hand("key", "Return")
    desk.until(lambda: desk.session.lesson is not None and desk.session.lesson.name == "underwater", "the lesson")
    desk.until(desk.is_quiet, "its image")
    seen = []
    titles = {panel.title for panel in PANELS if panel.place is Corner.BOTTOM_RIGHT}
    for _ in range(len(titles) + 1):
        hand("key", "p")
        key(desk)
        seen += [title for title in titles if is_on_show(title)]
    assert len(seen) == len(titles) + 1 and set(seen) == titles and seen[0] == seen[-1]


def is_on_show(title: str) -> bool:
    found = internal.find_window_by_name(title)
    return found is not None and found.active


def test_escape_leaves_the_pixel(desk: Desk) -> None:
    pixel = desk.session.pixel
    desk.session.select(4)
    key(desk, "h")
    assert desk.session.shows_help
    key(desk, "Escape")
    assert not desk.session.shows_help and desk.session.selection
    key(desk, "Escape", "Escape", "Escape")
    assert desk.session.selection is None and desk.session.pixel == pixel and desk.session.tree


@pytest.mark.parametrize("name", ("b", "period"))
def test_the_remote_blanks_the_screen(desk: Desk, name: str) -> None:
    hand("key", name)
    desk.until(lambda: desk.session.is_blank and not desk.window_picture().any(), "the black screen")
    depth = desk.session.depth
    hand("key", "0")
    desk.until(lambda: not desk.session.is_blank, "the key that brings the window back")
    assert desk.session.depth == depth  # it does nothing else
    desk.until(lambda: bool(desk.window_picture().any()), "the window")
    hand("key", name)
    desk.until(lambda: desk.session.is_blank, "the black screen")
    before = desk.session.pixel
    hand("mousemove", *desk.pixel_at(100, 500), "click", 1)
    desk.until(lambda: not desk.session.is_blank, "the click that brings the window back")
    key(desk)
    assert desk.session.pixel == before


def test_keys_of_a_remote_do_no_harm(desk: Desk) -> None:
    session = desk.session
    key(desk, "r")
    desk.until(lambda: session.refinement.current is not None and bool(session.refinement.current.points), "a round")
    key(desk, "r")
    before = (session.world, session.pixel, session.loader.loading, session.selection, session.notice.text)
    runs = list(session.refinement.runs)
    key(desk, "F5", "space", "shift+F5", "space")
    assert (session.world, session.pixel, session.loader.loading, session.selection, session.notice.text) == before
    assert session.refinement.runs == runs


def test_a_remote_reveals_the_tree(desk: Desk) -> None:
    """Page Down and Page Up go step by step, F5 plays, Esc shows the whole tree, and only then unselects the ray."""
    session, reveal = desk.session, desk.session.reveal
    session.select(4)
    shown = (session.pixel, session.selection, session.depth)
    assert session.tree
    expected = list(by_level(session.tree))
    for k, step in enumerate(expected):
        hand("key", "ctrl+Next")
        desk.until(lambda k=k: reveal.position == k, "the next step")
        assert session.step == step
    for k in range(len(expected) - 2, -1, -1):
        hand("key", "ctrl+Prior")
        desk.until(lambda k=k: reveal.position == k, "the step before")
        assert session.step == expected[k]
    hand("key", "End")
    desk.until(lambda: session.step == expected[-1], "the last step")
    hand("key", "ctrl+Home")
    desk.until(lambda: session.step == expected[0], "the first step")
    for start in ("F5", "space"):
        hand("key", start)
        desk.until(lambda: reveal.is_playing and reveal.position == 2, f"the animation after {start}")
        hand("key", start)
        desk.until(lambda: not reveal.is_playing, f"the pause after {start}")
        hand("key", "ctrl+Home")
        desk.until(lambda: reveal.position == 0, "the first step")
    assert (session.pixel, session.selection, session.depth) == shown
    hand("key", "Escape")
    desk.until(lambda: session.step is None, "the whole tree")
    assert session.selection == shown[1]
    hand("key", "Escape")
    desk.until(lambda: session.selection is None, "no selected ray")


def test_shift_and_page_down_go_line_by_line(desk: Desk) -> None:
    session, lines = desk.session, desk.session.recursion
    hand("key", "shift+Next")
    desk.until(lambda: lines.moment == 0 and is_on_show("Recursion"), "the first line")
    assert session.reveal.order == RECURSION and session.reveal.position == 0
    hand("key", "shift+Next", "shift+Next", "shift+Next")
    desk.until(lambda: lines.moment == 3, "three lines on")
    assert session.reveal.position == 1  # the shadow rays have been sent
    hand("key", "shift+Prior", "shift+Prior")
    desk.until(lambda: lines.moment == 1, "two lines back")
    assert session.reveal.position == 0
    hand("key", "ctrl+Next", "ctrl+Next")
    desk.until(lambda: session.reveal.position == 2, "a step of the tree")
    recording = lines.recording
    assert recording and session.step and lines.moment == recording.find(max(session.step.current), False)


def test_order_granularity_speed_and_loop_by_keys(desk: Desk) -> None:
    reveal = desk.session.reveal
    key(desk, "o")
    assert (reveal.granularity, reveal.order) == (RAYS, RECURSION) and reveal.words in desk.session.notice.text
    key(desk, "o")
    assert (reveal.granularity, reveal.order) == (RAYS, BREADTH)
    key(desk, "g")
    assert (reveal.granularity, reveal.order) == (LEVELS, BREADTH)
    key(desk, "greater", "greater", "less", "e")
    assert reveal.speed == 2.0 and reveal.loops
    key(desk, "e")
    assert not reveal.loops and not desk.session.is_blank


def test_the_loop_never_sleeps_beyond_the_next_step(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    """An animation plays in the window's own loop, in which nothing else happens."""
    reveal, wait = desk.session.reveal, desk.window.wait
    desk.until(desk.is_quiet, "the image")
    slept: list[tuple[float, float]] = []

    def watched(seconds: float) -> None:
        slept.append((seconds, reveal.wait(time.monotonic())))
        wait(seconds)

    monkeypatch.setattr(desk.window, "wait", watched)
    monkeypatch.setattr(desk.app, "is_over", lambda: reveal.position == 3)
    reveal.change_speed(1)
    reveal.toggle_play()
    desk.app.run()
    assert all(seconds <= left + 1e-3 for seconds, left in slept)
    assert any(seconds > FASTEST for seconds, _ in slept)  # it does sleep


def test_back_and_forward(desk: Desk) -> None:
    session = desk.session
    first = session.pixel
    for x in (200, 240, 280):  # a drag is one step
        hand("mousemove", *desk.pixel_at(x, 300), *(("mousedown", 1) if x == 200 else ()))
        key(desk)
    hand("mouseup", 1)
    second = session.pixel
    assert second != first
    hand("mousemove", *desk.pixel_at(640, 320), "click", 1)
    desk.until(lambda: session.pixel != second, "the click")
    third = session.pixel
    session.select(0)
    key(desk, "Right", "Right", "Down")
    fourth = session.pixel
    found = []
    for _ in range(4):
        key(desk, "alt+Left")
        found.append((session.pixel, session.selection))
    assert found == [(third, "E"), (second, None), (first, None), (first, None)]
    assert "no place before" in session.notice.text
    for expected in (second, third, fourth):
        key(desk, "alt+Right")
        assert session.pixel == expected
    key(desk, "alt+Left")
    hand("mousemove", *desk.pixel_at(100, 100), "click", 1)
    desk.until(lambda: session.pixel not in (second, third), "the click")
    key(desk, "alt+Right")
    assert "no place after" in session.notice.text


def test_back_to_the_lesson_before() -> None:
    with viewer() as driver:
        driver.open("glass-ball")
        session = driver.session
        session.pick(100, 120)
        driver.type("1")
        session.select(0)
        driver.open("underwater")
        assert session.lesson and session.lesson.name == "underwater"
        driver.press(imgui.Key.mod_alt, imgui.Key.left_arrow)
        driver.app.settle()
        assert session.lesson.name == "glass-ball"
        assert (session.pixel, session.selection) == ((100, 120), "E")
        driver.press(imgui.Key.mod_alt, imgui.Key.right_arrow)
        driver.app.settle()
        assert session.lesson.name == "underwater" and session.pixel == session.lesson.first.state.pixel


def scroll_of_numbers() -> float:
    return body(ray.PANEL.title).scroll.y


def test_the_numbers_stay_in_place_while_the_pixel_moves(desk: Desk) -> None:
    session = desk.session
    assert session.tree
    session.select(session.tree.find("T"))
    key(desk)
    key(desk, "j", "j", "j")
    place = scroll_of_numbers()
    assert place > 100.0
    pixel = session.pixel
    key(desk, "Right", "Right", "Down")
    assert session.pixel != pixel and session.selection == "T" and session.selected
    assert scroll_of_numbers() == place
    key(desk, "k")
    assert scroll_of_numbers() < place
    key(desk, "k", "k", "k")
    assert scroll_of_numbers() == 0.0
    hand("mousemove", *desk.pixel_at(20, 20), "click", 1)  # the sky: no such ray
    desk.until(lambda: session.selected is None, "the click")
    key(desk, "alt+Left")
    assert session.selection == "T" and session.selected


@pytest.mark.parametrize("lecture", (False, True))
def test_the_most_telling_numbers_are_seen_without_scrolling(lecture: bool) -> None:
    """At 1280x720: angle, critical angle and radicand lie inside the panel."""
    with viewer() as driver:
        driver.open("underwater")
        driver.session.select(driver.session.tree.find("I"))  # type: ignore[union-attr]
        if lecture:
            driver.press(imgui.Key.tab)
        driver.frames(4)
        if lecture:
            driver.type("p")
            driver.frames(4)
        panel = body(ray.PANEL.title)
        inside, (left, top, right, bottom) = panel.inner_clip_rect, driver.canvas.ray_ends
        assert panel.scroll.y == 0.0 and inside.min.y <= top < bottom <= inside.max.y
        assert inside.min.x <= left < right <= inside.max.x + 1.0


@pytest.mark.parametrize("way", ("f", "double click", "new lesson"))
def test_tree_and_image_fit_again(desk: Desk, way: str) -> None:
    session = desk.session
    nodes, image = dict(desk.app.canvas.nodes), desk.app.canvas.image_place
    left, top = desk.place()
    on_tree = (round(left + nodes[0][0]) + 60, round(top + nodes[0][1]) + 8)
    hand("mousemove", *on_tree, "click", 4, "click", 4, "click", 4)
    desk.until(lambda: session.tree_view.zoom > 1.2, "the zoom of the tree")
    hand("mousedown", 3)
    desk.until(lambda: imgui.is_mouse_down(imgui.MouseButton_.right), "the button")
    hand("mousemove", on_tree[0] + 50, on_tree[1] + 40)
    desk.until(lambda: session.tree_view.center != (0.0, 0.0), "the drag of the tree")
    hand("mouseup", 3)
    on_image = desk.pixel_at(300, 200)
    hand("mousemove", *on_image, "click", 4, "click", 4)
    desk.until(lambda: session.image_view.zoom > 1.2, "the zoom of the image")
    if way == "f":
        key(desk, "f")
    elif way == "double click":
        hand("mousemove", *on_image, "click", "--repeat", 2, "--delay", 20, 1)
        desk.until(lambda: session.image_view.zoom == 1.0, "the double click on the image")
        hand("mousemove", *on_tree, "click", "--repeat", 2, "--delay", 20, 1)
        desk.until(lambda: session.tree_view.zoom == 1.0, "the double click on the tree")
    else:
        assert session.opening
        session.loader.load(replace(session.opening, path=LESSON))
        desk.until(lambda: session.path == LESSON and desk.is_quiet(), "the lesson")
    assert (session.tree_view.zoom, session.tree_view.center) == (1.0, (0.0, 0.0))
    assert (session.image_view.zoom, session.image_view.center) == (1.0, (0.5, 0.5))
    if way == "f":
        assert desk.app.canvas.image_place == image


@pytest.mark.parametrize("name", ("glass-ball", "underwater", "two-lights", "mirror-balls"))
def test_larger_text_enlarges_the_tree(name: str) -> None:
    with viewer() as driver:
        driver.open(name)
        low = text_height(driver)
        driver.press(imgui.Key.tab)
        driver.frames(4)
        driver.press(imgui.Key.f4)
        driver.frames(4)
        high = text_height(driver)
        assert high == pytest.approx(low * LECTURE_ZOOM)
        lowest = max(y for _, y in driver.canvas.nodes.values())
        assert lowest + high <= imgui.get_io().display_size.y - bar.height()  # nothing is hidden


def text_height(driver: Driver) -> float:
    """Pixels of the text in the tree."""
    first, last = (node for _, node in sorted(driver.canvas.nodes.items())[:: len(driver.canvas.nodes) - 1])
    places = [place for _, place in sorted(tree.nodes(driver.tree_marks()).items())]
    scale = math.dist(first, last) / math.dist(places[0], places[-1])
    return scale * max(text.size for text in driver.tree_texts())


@pytest.mark.parametrize(
    "layout", ("us", "ru", "fr", *(pytest.param(name, marks=pytest.mark.slow) for name in ("de", "gr")))
)
def test_keys_on_other_keyboards(desk: Desk, layout: str) -> None:
    """By the character, and where the layout has none that is bound, by the place. Places are X key codes."""
    session = desk.session
    digits, f_key, t_key, m_key = {0: 19, 1: 10, 2: 11, 3: 12}, 41, 28, 58
    try:
        subprocess.run(["setxkbmap", layout], check=True)
        hand("key", f_key)  # reads the new layout
        for depth in (0, 2, 3, 1):
            hand("key", digits[depth])
            desk.until(lambda depth=depth: session.depth == depth, f"depth {depth} on {layout}")
        dark = session.appearance.theme.dark
        hand("key", t_key)
        desk.until(lambda: session.appearance.theme.dark != dark, f"T on {layout}")
        model = session.model
        hand("key", 47 if layout == "fr" else m_key)  # on French keyboards M is right of L
        desk.until(lambda: session.model != model, f"M on {layout}")
    finally:
        subprocess.run(["setxkbmap", "us"], check=True)


def test_the_scale_of_the_screen_changes_while_the_window_is_open() -> None:
    with viewer() as driver:
        driver.open("glass-ball")
        size = driver.app.surface.state
        for scale, resolution in ((2.0, (2560, 1440)), (1.5, (1920, 1080)), (1.0, (1024, 768)), (1.0, (1280, 720))):
            driver.app.surface.scale = scale  # type: ignore[misc]
            imgui.get_io().display_size = imgui.ImVec2(*resolution)
            assert driver.app._has_events()  # so that a frame is drawn, though nothing else happened
            driver.frames(4)
            assert not driver.app._has_events()
            below = internal.find_window_by_name(bar.NAME)
            assert below and abs(below.size.y - 2.15 * FONT_SIZE * scale) <= 1.5
            assert (below.pos.y + below.size.y, below.size.x) == (resolution[1], resolution[0])
            assert driver.picture().shape == (resolution[1], resolution[0], 3)
            driver.click(*driver.pixel_at(200, 150))
            assert driver.aims_at(200, 150)
        assert driver.app.surface.state == size


LESSON = Desk.scene_of("underwater")

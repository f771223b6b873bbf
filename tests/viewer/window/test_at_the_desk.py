"""A lecture at the desk: keys that are hit by accident, a remote, another keyboard. A real window, real keys."""

import subprocess
from collections.abc import Iterator
from dataclasses import replace

import pytest
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tests.viewer.desk import LINUX_ONLY, Desk
from tests.viewer.driver import Driver, viewer
from tests.viewer.screen import hand
from viewer.panels import bar, ray, tree

pytestmark = LINUX_ONLY


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
    desk.until(lambda: desk.session.pixel != desk.session.lesson.pixel, "the click")  # type: ignore[union-attr]
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
        hand("mousemove", left + 788, top + 65, "click", 1)
        desk.until(lambda: imgui.get_io().want_text_input, "the field")

    enter_field()
    hand("key", "3", "0", "5", "Return")
    desk.until(lambda: session.pixel == (305, row), "the typed coordinate")
    key(desk)
    for name, acted in (
        ("b", lambda: session.is_blank),
        ("period", lambda: session.is_blank),
        ("Next", lambda: session.selection == "E"),
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
    for _ in range(4):
        hand("key", "p")
        key(desk)
        shown = [title for title in ("Selected ray", "Error", "Lesson") if not panel_of(title).hidden]
        seen += shown
    assert len(seen) == 4 and set(seen) == {"Selected ray", "Error", "Lesson"} and seen[0] == seen[3]


def panel_of(title: str) -> internal.Window:
    found = internal.find_window_by_name(title)
    assert found
    return found


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
        assert session.lesson.name == "underwater" and session.pixel == session.lesson.pixel


def scroll_of_numbers() -> float:
    found = internal.find_window_by_name(ray.PANEL.title)
    assert found
    return found.scroll.y


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
    """At 1280x720: the table with angle, critical angle and radicand lies inside the panel."""
    with viewer() as driver:
        driver.open("underwater")
        driver.session.select(driver.session.tree.find("I"))  # type: ignore[union-attr]
        if lecture:
            driver.press(imgui.Key.tab)
        driver.frames(4)
        panel = internal.find_window_by_name(ray.PANEL.title)
        table = internal.table_find_by_id(panel.get_id("interfaces"))
        assert panel and table and panel.scroll.y == 0.0
        inside, outer = panel.inner_clip_rect, table.outer_rect
        assert inside.min.y <= outer.min.y and outer.max.y <= inside.max.y and outer.max.x <= inside.max.x + 1.0
        assert table.row_pos_y2 <= inside.max.y


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
        before = drawn(driver)
        driver.press(imgui.Key.tab)
        driver.frames(4)
        after = drawn(driver)
        assert after.radius > 1.1 * before.radius
        assert after.text_size > 1.3 * before.text_size
        assert after.labels_edges or not before.labels_edges
        lowest = max(y for _, y in driver.canvas.nodes.values())
        assert lowest + after.radius <= after.corner.y + after.room.y  # nothing is hidden


def drawn(driver: Driver) -> tree._Diagram:
    made: list[tree._Diagram] = []
    draw = tree._Diagram.draw
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tree._Diagram, "draw", lambda self: (made.append(self), draw(self)))
        driver.frames(1)
    return made[-1]


@pytest.mark.parametrize("layout", ("us", "ru", "fr", "de", "gr"))
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
            assert below and below.size.y == round(2.15 * 16.0 * scale)
            assert (below.pos.y + below.size.y, below.size.x) == (resolution[1], resolution[0])
            assert driver.picture().shape == (resolution[1], resolution[0], 3)
            driver.click(*driver.pixel_at(200, 150))
            assert driver.aims_at(200, 150)
        assert driver.app.surface.state == size


LESSON = Desk.scene_of("underwater")

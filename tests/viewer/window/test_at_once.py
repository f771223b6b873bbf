"""All panels show a picked pixel and a selected ray in the same frame: it looks as after many frames.

Scroll bars and tooltips are left out, since imgui shows them a frame late.
"""

from collections.abc import Iterator

import numpy as np
import pytest
from imgui_bundle import imgui

from tests.viewer.driver import Driver, are_equal, viewer

SIZE = (1600, 1000)


@pytest.fixture(params=["desk", "lecture"])
def driver(request: pytest.FixtureRequest) -> Iterator[Driver]:
    with viewer(SIZE) as driver:
        driver.open("glass-ball")
        if request.param == "lecture":
            driver.press(imgui.Key.tab)
        yield driver


def bring_to_front(driver: Driver, panel: str) -> None:
    driver.session.layout.bring_to_front(panel, driver.session.appearance.is_lecture_size)
    driver.frames(4)


def check_first_frame(driver: Driver, place: tuple[float, float], is_click: bool) -> None:
    """The frame in which the mouse button goes down, or, for a click, up again, looks like those that follow."""
    driver.move(*place)
    driver.frames(4)
    before = driver.picture()
    driver.button(True)
    if is_click:
        driver.button(False)
    first = driver.picture()
    driver.frames(4)
    last = driver.picture()
    assert not are_equal(first, before)
    assert are_equal(_without_late(first), _without_late(last))


def _without_late(picture: np.ndarray) -> np.ndarray:
    """The picture with black in the places of the tooltip and of scroll bars, if they are there now."""
    kept = picture.copy()
    for window in imgui.get_current_context().windows:
        left, top, right, bottom = (int(side) for side in (*window.pos, *(window.pos + window.size)))
        if window.active and window.name.startswith("##Tooltip"):
            kept[top : bottom + 1, left : right + 1] = 0
        if window.active and "body" in window.name:
            kept[top : bottom + 1, right - int(imgui.get_style().scrollbar_size) - 1 : right + 1] = 0
    return kept


@pytest.mark.parametrize("panel", ["tree", "ray", "hit"])
def test_a_picked_pixel(driver: Driver, panel: str) -> None:
    bring_to_front(driver, panel)
    check_first_frame(driver, driver.pixel_at(300, 100), is_click=False)
    assert driver.aims_at(300, 100)


@pytest.mark.parametrize("panel", ["tree", "ray", "hit"])
def test_a_ray_selected_in_the_scene(driver: Driver, panel: str) -> None:
    bring_to_front(driver, panel)
    tree = driver.session.tree
    assert tree
    row = tree.find("R")
    assert row is not None
    place = driver.lone_place(row)
    assert place
    check_first_frame(driver, place, is_click=True)
    assert driver.session.selected == row


def test_a_ray_selected_in_the_tree(driver: Driver) -> None:
    tree = driver.session.tree
    assert tree
    row = tree.find("TR")
    assert row is not None
    bring_to_front(driver, "tree")
    check_first_frame(driver, driver.canvas.nodes[row], is_click=True)
    assert driver.session.selected == row

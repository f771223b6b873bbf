"""The window verifies the picked pixel's tree beside its frames, and says what is certain."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.viewer.driver import Driver, viewer_of
from viewer.session import verification

SCENE = """
format = 1
camera = { position = [1, 0, 5], look_at = [1, 0, 0] }
image = { width = 65, height = 49 }
background = { color = [0.3, 0.4, 0.6] }
material = [{ name = "red", color = [0.8, 0.2, 0.2], ambient = 0.2, reflect = 0.3 }]
object = [
    { name = "ball", shape = "sphere", center = [0, 0, 0], radius = 1, material = "red" },
    { name = "floor", shape = "plane", point = [0, -1, 0], normal = [0, 1, 0], material = "red" },
]
"""


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Driver]:
    with viewer_of(tmp_path / "ball.toml", SCENE) as driver:
        yield driver


def said(driver: Driver, row: int = 0) -> str:
    """The window's sentence when the verification has come."""
    driver.session.verification.wait()
    driver.frames(1)
    return driver.session.verification.text(row)


def test_a_picked_pixel_is_verified(room: Driver) -> None:
    room.session.pick(20, 20)
    assert room.session.verification.is_running
    assert room.session.verification.text(0) == "The tree is being verified …"
    assert said(room).startswith("Verified: the colour is known to within ")
    assert said(room).endswith(" decisions are certified.")
    assert not room.session.verification.is_running


def test_what_is_not_certified_is_named(room: Driver) -> None:
    """The middle pixel looks along the silhouette of the ball."""
    room.session.pick(32, 24)
    text = said(room)
    assert text.startswith("Verified in part: the colour is known to within 0.")
    assert text.endswith("0 of 1 decisions are certified. Not certified here: which surface it meets.")


def test_the_last_of_several_picks_is_verified(room: Driver) -> None:
    for x in range(5, 30):
        room.session.pick(x, 30)
    while room.session.verification.is_running:
        said(room)
    found, tree = room.session.verification.found, room.session.tree
    assert found
    assert tree
    assert len(found.rows) == len(tree)
    for (low, high), color in zip(found.color, tree.radiance, strict=True):
        assert low - 1e-12 <= color <= high + 1e-12


def test_large_trees_and_a_missing_library(room: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verification, "MOST_ROWS", 1)
    room.session.pick(20, 40)
    assert said(room) == "Not verified here: more than 1 rays. See raytree trace --verify."
    monkeypatch.undo()
    monkeypatch.setitem(sys.modules, "flint", None)
    room.session.pick(21, 40)
    assert said(room) == "Not verified: needs the extra raytree[verify]."

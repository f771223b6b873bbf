"""The 3D view keeps its surfaces from frame to frame: what it shows does not depend on how it came about."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from tests.viewer.driver import Driver, viewer
from viewer.base.orbit import Orbit
from viewer.base.theme import DARK
from viewer.gl.stage import ImagePlane, Stage
from viewer.gl.surfaces import Surfaces
from viewer.window.backend import Offscreen

KINDS = ("shadow", "reflection")


def _counted(name: str, draw: Callable[..., None], found: list[str]) -> Callable[..., None]:
    def counted(*arguments: object) -> None:
        found.append(name)
        draw(*arguments)

    return counted


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The draws of surfaces since the test has started."""
    found: list[str] = []
    for name in ("draw_opaque", "draw_clear", "draw_front"):
        monkeypatch.setattr(Surfaces, name, _counted(name, getattr(Surfaces, name), found))
    return found


def actions(driver: Driver) -> Iterator[str]:
    """Change the rays on show in all ways, one after the other; the image is at rest after each."""
    session = driver.session
    session.image.wait()
    driver.frames(3)
    assert session.pixel
    driver.click(*driver.pixel_at(session.pixel[0] + 12, session.pixel[1] + 6))
    yield "a pick"
    session.select(1)
    driver.frames()
    yield "a selection"
    driver.move(*driver.ray_at(0, 0.9))
    driver.frames()
    yield "the mouse over a ray"
    for depth in "13":
        driver.type(depth)
        session.image.wait()
        driver.frames(3)
        yield f"depth {depth}"
    for kind in KINDS:
        session.shown.toggle_kind(kind)
        driver.frames()
        yield f"without the kind {kind}"
    session.shown.normals = False
    driver.frames()
    yield "without normals"


@pytest.mark.parametrize("lesson", ["glass-ball", "underwater", pytest.param("two-lights", marks=pytest.mark.slow)])
def test_kept_surfaces_give_the_same_picture_as_drawing_everything(lesson: str) -> None:
    with viewer((900, 600)) as driver:
        driver.open(lesson)
        pictures = set()
        for action in actions(driver):
            kept = driver.canvas.stage.target.pixels()
            driver.resize((700, 500))
            driver.resize((900, 600))
            assert (kept == driver.canvas.stage.target.pixels()).all(), action
            pictures.add(kept.tobytes())
        assert len(pictures) >= 5


@pytest.mark.parametrize("lesson", ["glass-ball", "two-lights"])
def test_picks_selections_and_the_mouse_draw_no_surface(lesson: str, drawn: list[str]) -> None:
    with viewer((900, 600)) as driver:
        driver.open(lesson)
        driver.session.image.wait()
        driver.frames(3)
        assert drawn
        drawn.clear()
        for action in actions(driver):
            assert not drawn, action
        x, y = driver.ray_at(0, 0.5)
        driver.drag([(x, y), (x + 40, y), (x + 60, y + 10)])
        assert drawn


def test_a_new_depth_shows_the_image_before_until_it_has_tiles() -> None:
    """One pixel in a hundred of these images is black at most."""
    with viewer((900, 600)) as driver:
        driver.open("glass-ball")
        session = driver.session
        session.image.wait()
        for depth in "2130":
            driver.type(depth)
            picture = session.image.picture
            assert picture
            while not picture.finished:
                assert (picture.shown[..., :3] == 0).all(axis=2).mean() < 0.01
                driver.frames(1)


def test_magnified_pixels_of_the_image_plane_are_squares() -> None:
    """A black and a white pixel, each hundreds of pixels wide on the screen: at most two columns are between them."""
    surface = Offscreen((400, 300))
    stage = Stage(surface.ctx)
    try:
        texture = surface.ctx.texture((2, 1), 4, bytes([0, 0, 0, 255, 255, 255, 255, 255]))
        corners = np.array([(x, y, 0.0) for x in (-1.0, 1.0) for y in (1.0, -1.0)])
        stage.draw(Orbit(), DARK, (400, 300), 1.0, ImagePlane(corners, texture, None))
        row = stage.target.pixels()[150, 60:340].astype(int).mean(axis=1)
        dark, bright = row[20], row[-20]
        assert bright > dark + 100
        assert ((row > dark + 10) & (row < bright - 10)).sum() <= 2
    finally:
        stage.release()
        surface.close()

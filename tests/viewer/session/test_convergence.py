"""Refinement in the window: the same samples as `raytree render`, the curve of every method, and a map."""

import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

import tracer
from tests.viewer.driver import Driver, body, viewer_of
from tracer.image.progressive import RoundStats
from viewer.base.colormap import RANGES, colorize, gradient
from viewer.base.srgb import srgb
from viewer.panels import error
from viewer.session import actions
from viewer.session.actions import set_strategy
from viewer.session.refinement import BYTES_PER_PIXEL, STRATEGIES, Run, forecast

ADAPTIVE, EVEN, RANDOM, JITTERED = STRATEGIES
PATIENCE = 20_000  # frames
SCENE = """
format = 1
camera = { position = [0, 1, 6], look_at = [0, 0, 0] }
image = { width = 64, height = 48 }
background = { color = [0.3, 0.4, 0.6] }
light = [{ position = [4, 6, 5], color = [0.7, 0.7, 0.7] }]
material = [{ name = "mirror", diffuse = 0.3, reflect = 0.5, checker = { color = [0, 0, 0], size = 0.7 } }]
object = [
    { shape = "sphere", center = [-0.6, 0.2, 0], radius = 0.9, material = "mirror" },
    { shape = "sphere", center = [1.1, 0.0, 0.4], radius = 0.7, material = "mirror" },
    { shape = "plane", point = [0, -0.8, 0], normal = [0, 1, 0], material = "mirror" },
]
"""


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Driver]:
    with viewer_of(tmp_path / "mirrors.toml", SCENE) as driver:
        yield driver


def until(driver: Driver, there: Callable[[], bool]) -> None:
    for _ in range(PATIENCE):
        if there():
            return
        driver.frames(1)
        time.sleep(0.0)  # the threads that trace get the interpreter
    pytest.fail("it never came")


def current(driver: Driver) -> Run:
    run = driver.session.refinement.current
    assert run
    return run


def refine(driver: Driver, samples: float) -> Run:
    """Refine to a number of samples a pixel, then pause, with no work left."""
    session = driver.session
    if not session.refinement.is_running:
        driver.type("r")

    def there() -> bool:
        run = session.refinement.current
        return run is not None and bool(run.points) and run.points[-1].samples >= samples

    until(driver, there)
    driver.type("r")
    assert not session.refinement.is_running
    until(driver, lambda: session.image.picture is not None and session.image.picture.finished)
    return current(driver)


def test_the_image_is_that_of_its_samples(room: Driver) -> None:
    """The picture on the screen is the mean of each pixel's samples, equal to a plain image's to the last bit."""
    world = room.session.world
    assert world
    run = refine(room, 4.0)
    assert run.image and run.picture is room.session.image.picture
    sampled = run.image.statistics
    assert run.picture
    assert (run.picture.shown[..., :3] == srgb(sampled.means())).all()
    for count in (2, 8):
        here = sampled.counts == count
        assert here.any()
        plain = tracer.render(world, samples=count, depth=room.session.depth)
        assert sampled.means()[here].tobytes() == plain.pixels[here].tobytes()


def test_paused_and_gone_on_with(room: Driver) -> None:
    first = refine(room, 3.0)
    points = list(first.points)
    room.frames(5)
    assert first.points == points
    again = refine(room, 2.0 * points[-1].samples)
    assert again is first
    assert again.points[: len(points)] == points
    assert [p.seconds for p in again.points] == sorted(p.seconds for p in again.points)
    assert [p.samples for p in again.points] == sorted(p.samples for p in again.points)


def test_every_setting_keeps_its_curve(room: Driver) -> None:
    session = room.session
    deep = refine(room, 3.0)
    room.type("2")
    assert session.refinement.current is None
    shallow = refine(room, 3.0)
    assert (deep.depth, shallow.depth) == (3, 2)
    set_strategy(session, RANDOM)
    random = refine(room, 8.0)
    set_strategy(session, JITTERED)
    jittered = refine(room, 16.0)
    assert session.refinement.runs == [deep, shallow, random, jittered]
    assert [p.samples for p in random.points][:3] == [2.0, 4.0, 8.0]
    assert [p.samples for p in jittered.points][:2] == [4.0, 16.0]
    assert [run.name([]) for run in session.refinement.runs][1:] == ["depth 2, adaptive", "depth 2, random",
                                                                      "depth 2, jittered"]  # fmt: skip
    set_strategy(session, ADAPTIVE)
    room.type("3")
    before = len(deep.points)
    assert refine(room, deep.points[-1].samples + 0.1) is deep
    assert len(deep.points) > before
    session.refinement.clear()
    assert session.refinement.runs == [deep]


def test_an_image_that_was_dropped_is_begun_anew(room: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("viewer.session.refinement.MAX_BYTES", 3 * BYTES_PER_PIXEL * 64 * 48)
    runs = []
    for depth in range(4):
        room.type(str(depth))
        runs.append(refine(room, 2.0))
    assert [run.image is None for run in runs] == [True, False, False, False]
    assert [run.number for run in runs] == [0, 1, 2, 3]
    assert runs[0].points
    room.type("0")
    assert refine(room, 2.0) is not runs[0]


def test_another_scene_has_no_curves_yet(room: Driver) -> None:
    refine(room, 2.0)
    actions.open_lesson(room.session, "two-lights")
    room.app.settle()
    assert room.session.refinement.runs == []


def test_what_is_cut_is_worth_no_more_than_the_flat_line_says(room: Driver) -> None:
    world = room.session.world
    assert world
    for depth in (0, 1, 3):
        room.type(str(depth))
        run = refine(room, 2.0)
        made = run.image
        assert made
        there = tracer.render(world, samples=2, depth=40, min_weight=1e-9)
        two = tracer.render(world, samples=2, depth=depth)
        lacks = math.sqrt(float(np.mean((there.pixels - two.pixels) ** 2)))
        assert 0.0 < lacks <= run.floor < math.inf


def test_nothing_more_to_gain(tmp_path: Path) -> None:
    sky = (
        'format = 1\nobject = [{ shape = "sphere", center = [0, 0, 99], radius = 1 }]\n'
        "image = { width = 32, height = 24 }\ncamera = { position = [0, 0, 0], look_at = [0, 0, -1] }\n"
    )
    with viewer_of(tmp_path / "sky.toml", sky) as driver:
        driver.type("r")
        until(driver, lambda: not driver.session.refinement.is_running)
        assert current(driver).ended
        assert current(driver).points[-1].error == 0.0
        driver.type("r")  # once more, without an effect
        until(driver, lambda: not driver.session.refinement.is_running)


def test_maps(room: Driver) -> None:
    """The map shows each pixel's value on the colour scale in place of the image. The image returns at once."""
    state = room.session.refinement
    run = refine(room, 4.0)
    assert run.image
    room.frames()  # of the samples that came after the last frame
    image = room.picture()
    for shows, values in (
        ("error", run.image.statistics.errors()),
        ("samples", run.image.statistics.counts.astype(float)),
    ):
        state.shows = shows
        room.frames()
        room.unpick()
        shown = room.picture()
        expected = colorize(values, shows)
        for y, x in ((5, 5), (20, 30), (40, 60)):
            left, top = (int(place) for place in room.pixel_at(x, y))
            assert np.abs(shown[top, left].astype(int) - expected[y, x, :3]).max() <= 2
        assert len(np.unique(expected.reshape(-1, 4), axis=0)) > 3
    state.shows = "image"
    room.frames()
    assert (room.picture()[60:400, 800:1200] == image[60:400, 800:1200]).all()


def test_the_scale_of_a_map() -> None:
    low, high = RANGES["error"]
    row = colorize(np.array([[math.nan, 0.0, low, math.sqrt(low * high), high, 1.0]]), "error")[0]
    colors = (255 * np.array(gradient(3)).round(6)).round().astype(int)
    for k, expected in enumerate((0, 0, 0, 1, 2, 2)):
        assert np.abs(row[k].astype(int) - colors[expected]).max() <= 2
    light = np.array(gradient(64))[:, :3] @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(light) > 0.0).all()


def test_the_button_and_the_choice_of_a_way(room: Driver) -> None:
    """By the mouse: the panel comes to the front, its button refines, its list has every method."""
    room.type("r")
    room.type("r")
    place = body(error.PANEL.title).inner_rect
    room.click(place.min.x + 30, place.min.y + 18)
    assert room.session.refinement.is_running
    room.click(place.min.x + 30, place.min.y + 18)
    assert not room.session.refinement.is_running
    room.click(place.min.x + 120, place.min.y + 18)
    room.frames(3)
    line = imgui.get_text_line_height_with_spacing()
    room.click(place.min.x + 120, place.min.y + 18 + 2.9 * line)
    assert room.session.refinement.strategy in STRATEGIES[1:]


def test_forecast_of_a_power() -> None:
    points = [RoundStats(t, 1, 1.0, 1, 1, 0.3 * t**-0.75) for t in (0.5, 1.0, 2.0, 4.0)]
    assert forecast(points, 1.0) == pytest.approx(0.3 * 5.0**-0.75, rel=1e-12)
    assert math.isnan(forecast(points[:1], 1.0))
    assert math.isnan(forecast([], 1.0))
    risen = [RoundStats(t, 1, 1.0, 1, 1, 0.1 * t) for t in (1.0, 2.0)]
    assert forecast(risen, 1.0) == 0.2  # an error that rises is not extrapolated


def test_ticks_are_round_numbers() -> None:
    assert error.ticks(0.9, 6.0) == [1.0, 2.0, 5.0]
    assert error.ticks(0.0009, 0.2) == pytest.approx([0.001, 0.01, 0.1])

"""A sweep: between two pixels the camera's own ray is traced, and a number of the scene goes through its values."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.viewer.driver import Driver, viewer
from tests.viewer.session.given import begin, picture
from viewer.cli.main import main
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.moments import Moment
from viewer.lessons.sweep import STOPS
from viewer.reopen.view_state import ViewState
from viewer.session.lecture.sweeping import SECONDS
from viewer.session.restore.view import state_of

# A plane of water seen from below: the angle of incidence is that of the camera ray with the vertical.
SCENE = """\
format = 1
[camera]
position = [0, -2, 0]
look_at = [1, 0, 0]
fov = 60
[image]
width = 161
height = 121
[background]
color = [0.5, 0.6, 0.8]
[[light]]
position = [0, 9, 0]
[[material]]
name = "water"
transmit = 0.9
reflect = 0.1
ior = 1.33
[[object]]
name = "surface"
shape = "polygon"
vertices = [[-9, 0, -9], [-9, 0, 9], [9, 0, 9], [9, 0, -9]]
material = "water"
"""
LESSON = """\
+++
title = "Sweep"
question = "Where does it vanish?"
+++
## A place
```step
sweep = { of = "pixel", from = [80, 60], to = [80, 120], expect = { children = ["I"] } }
expect = { children = ["R", "T"] }
```
It is {theta1}.
???
Seen.
## Next
## An index
```step
pixel = [80, 60]
sweep = { of = 'material."water".ior', from = 1.0, to = 2.0 }
```
"""
FIRST, LAST = (80, 60), (80, 120)


@pytest.fixture
def lesson(tmp_path: Path) -> Lesson:
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    (tmp_path / "lesson.md").write_text(LESSON, "utf-8")
    return read_file(tmp_path / "lesson.md")


def direction(world: tracer.World, x: float, y: float) -> np.ndarray:
    """The camera's ray through the middle of a place in the image, by the pinhole camera's definition."""
    camera, image = world.scene.camera, world.scene.image
    assert camera.position and camera.look_at
    forward = np.subtract(camera.look_at, camera.position)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    half = math.tan(math.radians(camera.fov / 2))
    u, v = ((2 * x + 1 - image.width) / image.height, (image.height - 2 * y - 1) / image.height)
    found = forward + half * (u * right + v * np.cross(right, forward))
    return found / np.linalg.norm(found)


def test_the_step_after_goes_on_from_the_end(lesson: Lesson) -> None:
    place, after, index = lesson.steps
    assert (place.state.pixel, after.state.pixel, after.state.sweep) == (FIRST, LAST, None)
    assert index.state.set == {"material": {"water": {"ior": 1.0}}}
    assert index.state.swept(0.25).set == {"material": {"water": {"ior": 1.25}}}


def test_between_pixels_the_rays_are_those_of_the_camera(driver: Driver, lesson: Lesson) -> None:
    """The angle goes through the critical one, at which the refracted ray vanishes, without the jumps of pixels."""
    begin(driver, lesson)
    session, angles = driver.session, []
    sweeping = session.player.sweeping
    critical = math.asin(1 / 1.33)
    for share in np.linspace(0.0, 1.0, 41):
        sweeping.move_to(share)
        session.update()
        assert session.tree and session.world and session.pixel
        x, y = 80.0, 60.0 + 60.0 * share
        root = session.tree.nodes[0]
        assert root["direction"] == pytest.approx(direction(session.world, x, y), abs=4e-16)
        assert session.pixel == (80, int(y + 0.5))
        assert session.between == (None if y == int(y) else pytest.approx((x, y)))
        angles.append(float(root["theta1"]))
        kinds = {session.tree.kind(k) for k in session.tree.children[0]} - {"shadow"}
        assert kinds == ({"reflection", "refraction"} if angles[-1] < critical else {"tir"})
    assert angles == sorted(angles) and angles[0] < critical < angles[-1]
    for share, pixel in ((0.0, FIRST), (0.1, (80, 66)), (1.0, LAST)):  # at a pixel, it is the pixel's own tree
        sweeping.move_to(share)
        session.update()
        assert session.tree and session.world and session.between is None
        tree = tracer.trace(session.world, pixel)
        assert session.tree.nodes.tobytes() == tree.nodes.tobytes()


def test_it_moves_by_itself_and_ends_at_the_moment_of_the_lesson(driver: Driver, lesson: Lesson) -> None:
    begin(driver, lesson)
    session = driver.session
    sweeping = session.player.sweeping
    assert session.player.go(1) and sweeping.is_playing and sweeping.share == 0.0
    shares = [sweeping.advance(now) and sweeping.share for now in (0.0, 1.0, 3.0, SECONDS + 0.1, 9.0)]
    assert shares == [False, 1.0 / SECONDS, 3.0 / SECONDS, 1.0, False]
    assert session.swept is None and session.player.moment == Moment(0, 1) and session.pixel == LAST
    session.player.go(-1)
    session.player.go(1)
    session.player.go(1)  # while it moves, the key goes to its end
    assert not sweeping.is_playing and session.player.moment == Moment(0, 1) and sweeping.share == 1.0
    session.player.go(1)
    assert session.player.moment == Moment(0, 2) and sweeping.share == 1.0


def test_the_knob_is_dragged_and_a_pick_leaves_the_way(driver: Driver, lesson: Lesson) -> None:
    begin(driver, lesson)
    session = driver.session
    (left, top), width = driver.canvas.sweep_place
    driver.drag([(left + 1.0, top), (left + 0.3 * width, top), (left + 0.613 * width, top)])
    assert session.player.sweeping.share == pytest.approx(0.613, abs=1.0 / width)
    assert session.between and session.at == (1, 0)
    near, place, sweeping = session.pixel, session.between, session.player.sweeping
    assert near and not sweeping.is_left
    session.pick(*near)
    assert session.between is None and session.swept is None and session.tree
    assert session.tree.pixel == near and sweeping.is_left
    sweeping.move_to(sweeping.share)
    assert session.between == place and not sweeping.is_left


def test_a_number_of_the_scene_goes_through_its_values(driver: Driver, lesson: Lesson) -> None:
    begin(driver, lesson)
    session = driver.session
    session.player.show(lesson, Moment(2, 0))
    driver.app.settle()
    for k in range(0, STOPS + 1, 6):
        session.pick(75, 40)  # the pixel that is picked on the way stays
        session.player.sweeping.move_to(k / STOPS + 0.01)
        driver.app.settle()
        assert session.world and session.pixel == (75, 40) and session.tree
        assert session.world.scene.objects[0].material.ior == 1.0 + k / STOPS
        again = tracer.prepare(tracer.load(lesson.scene, changes={"material": {"water": {"ior": 1.0 + k / STOPS}}}))
        assert session.tree.nodes.tobytes() == tracer.trace(again, (75, 40)).nodes.tobytes()
        assert session.image.picture
        assert np.array_equal(session.image.picture.pixels, tracer.render(again).pixels)


def test_a_place_of_the_way_is_part_of_the_view(lesson: Lesson, tmp_path: Path) -> None:
    """A new window that is opened with the state shows the same picture, and the command line has the same tree."""
    with viewer() as driver:
        begin(driver, lesson)
        driver.session.player.sweeping.move_to(0.53)
        before = picture(driver)
        assert driver.session.tree
        state, written = state_of(driver.session), driver.session.tree.to_json()
        assert (state.at, state.swept) == ((1, 0), 0.53)
    with viewer() as driver:
        driver.session.loader.open(lesson.scene, lesson, state)
        assert np.array_equal(picture(driver), before)
        driver.session.loader.open(lesson.scene, lesson, ViewState(swept=0.5))
        assert "--swept needs --at with a step that has a sweep (1, 3), got no --at" in driver.session.faults[0]
    file = tmp_path / "tree.json"
    where = ["--at", "1", "--swept", "0.53"]
    assert main(["export", str(lesson.path), *where, "--format", "json", "-o", str(file)]) == 0
    assert json.loads(file.read_text("utf-8"))["nodes"] == json.loads(written)["nodes"]

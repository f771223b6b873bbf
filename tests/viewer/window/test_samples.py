"""A pixel of several samples in the window: the image is their mean, and the tree that of the chosen one. Real GL, real
events, no screen.
"""

import math
import shlex
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

import tracer
from tests.tracer.image.test_scene_samples import COUNT, PIXELS, SIZE, mean, with_samples
from tests.viewer.driver import Driver, viewer
from tests.viewer.session.test_convergence import until
from tests.viewer.session.test_figure_export import save
from tests.viewer.session.test_reopening import drop, fresh
from tracer.kernel.limits import make_limits
from viewer.base.srgb import srgb
from viewer.cli.main import main
from viewer.panels.pixel.colors import pixel_mean
from viewer.panels.pixel.dots import LEAST_PIXEL, dots
from viewer.reopen.places import read_figure
from viewer.session.image_renderer import ImageRenderer
from viewer.session.layout import Corner
from viewer.session.restore.command import view_command
from viewer.session.restore.view import state_of

PICKED = PIXELS[1]


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Driver]:
    monkeypatch.chdir(tmp_path)
    with viewer() as driver:
        driver.open_file(with_samples("mirror-balls", tmp_path))
        driver.session.pick(*PICKED)
        driver.app.settle()
        yield driver


def enlarge(driver: Driver) -> None:
    """Zoom with the wheel until the picked pixel shows its dots."""
    while driver.canvas.image_place[2] < 2.0 * LEAST_PIXEL:
        driver.wheel(*driver.pixel_at(*PICKED), 1.0)


def sample(driver: Driver) -> int | None:
    assert driver.session.tree
    return driver.session.tree.sample


def test_the_image_is_the_mean_of_the_trees_on_show(room: Driver, tmp_path: Path) -> None:
    """To the last bit, in two scenes; a kept image comes back at once with the same bits."""
    session = room.session
    for path in (session.path, with_samples("two-lights", tmp_path)):
        assert path
        room.open_file(path)
        assert session.world and session.image.picture and session.image.picture.finished
        pixels = session.image.picture.pixels
        assert pixels.tobytes() == tracer.render(session.world).pixels.tobytes()
        for x, y in PIXELS:
            session.pick(x, y)
            colors = []
            for k in range(COUNT):
                assert sample(room) == k and session.tree and session.full_tree
                assert (session.full_tree.radiance == session.tree.radiance).all()
                colors.append(session.tree.radiance)
                room.type("s")
            assert mean(colors).tobytes() == pixels[y, x].tobytes()
            count, rgb = pixel_mean(session) or (0, np.zeros(3))
            assert count == COUNT and (rgb == pixels[y, x]).all()
        first, depth = session.image.picture, session.depth
        session.set_depth(1)
        room.app.settle()
        assert session.image.picture is not first
        session.set_depth(depth)
        assert session.image.picture is first and first.finished


def test_pixel_centres_are_shown_before_the_mean(tmp_path: Path) -> None:
    """The first full image is that of one sample, and it says so; the last one is the mean."""
    world = tracer.prepare(tracer.load(with_samples("two-lights", tmp_path)))
    renderer = ImageRenderer()
    seen: list[tuple[bool, bytes]] = []

    def look() -> None:
        picture = renderer.picture
        assert picture
        if picture.share in (1.0 / (1 + COUNT), 1.0):
            seen.append((picture.is_preview, picture.pixels.tobytes()))

    renderer.progress = look
    try:
        renderer.show(world, make_limits(world, records=False), SIZE)
        renderer.wait()
    finally:
        renderer.close()
    assert seen == [(n == 1, tracer.render(world, samples=n).pixels.tobytes()) for n in (1, COUNT)]


def test_a_click_on_a_dot_shows_the_rays_of_its_sample(room: Driver) -> None:
    session = room.session
    assert dots(session, room.canvas.image_place) == []  # while a pixel is small
    enlarge(room)
    for k in (2, 0, 3, 1):
        spots = dots(session, room.canvas.image_place)
        assert len(spots) == COUNT
        room.click(*spots[k])
        assert sample(room) == k and session.pixel == PICKED and session.tree and session.world
        # The camera ray of the tree meets the image where the dot is drawn.
        view, toward = session.world.view(), session.tree.nodes["direction"][0]
        toward = toward / (toward @ np.array(view.forward))
        half = math.sqrt(np.array(view.up) @ np.array(view.up))
        u, v = (toward @ np.array(axis) / half**2 for axis in (view.right, view.up))
        left, top, scale = room.canvas.image_place
        assert left + scale * 0.5 * (view.width + u * view.height) == pytest.approx(spots[k][0], abs=1e-6 * scale)
        assert top + scale * 0.5 * (view.height - v * view.height) == pytest.approx(spots[k][1], abs=1e-6 * scale)
    # Beside the dots, the pixel keeps its sample; the next pixel has it, too.
    x, y = PICKED
    room.click(*room.pixel_at(x + 1, y))
    assert session.pixel == (x + 1, y) and sample(room) == 1


def test_keys_and_buttons_go_from_sample_to_sample(room: Driver) -> None:
    session = room.session
    found = []
    for keys in ("sss", "s"):
        room.type(keys)
        found.append(sample(room))
    imgui.get_io().add_key_event(imgui.Key.mod_shift, True)
    room.type("S")
    imgui.get_io().add_key_event(imgui.Key.mod_shift, False)
    found.append(sample(room))
    left, top, _, _ = room.app.tiles.places[Corner.TOP_RIGHT]
    for across in (22, 22, 46):  # logical pixels from the left end of the panel: the buttons < and >
        room.click(left + across, top + 40)
        found.append(sample(room))
    assert found == [3, 0, 3, 2, 1, 2]
    assert session.pixel == PICKED


def test_a_sample_is_of_one_scene_and_comes_back_in_the_history(room: Driver, tmp_path: Path) -> None:
    session = room.session
    room.type("ss")
    session.pick(*PIXELS[2])
    assert sample(room) == 2
    room.type("s")
    room.press(imgui.Key.mod_alt, imgui.Key.left_arrow)
    assert (session.pixel, sample(room)) == (PICKED, 2)
    room.press(imgui.Key.mod_alt, imgui.Key.right_arrow)
    assert (session.pixel, sample(room)) == (PIXELS[2], 3)

    # The file is saved with fewer samples, then another scene is opened, then one with the pixel's centre only.
    path = session.path
    assert path
    path.write_text(path.read_text("utf-8").replace("samples = 4", "samples = 2"), "utf-8")
    session.loader.reload()
    room.app.settle()
    assert (session.pixel, sample(room)) == (PIXELS[2], 1)
    for count, wanted in ((COUNT, 0), (1, None)):
        room.open_file(with_samples("two-lights", tmp_path, count))
        session.pick(*PICKED)
        assert sample(room) == wanted and state_of(session).sample is None
    enlarge(room)
    assert dots(session, room.canvas.image_place) == [pytest.approx(room.pixel_at(*PICKED))]
    assert pixel_mean(session) is None
    room.type("s")
    assert "has one sample, its centre" in session.notice.text and sample(room) is None


def test_a_figure_and_a_command_line_bring_the_sample_back(room: Driver) -> None:
    session = room.session
    room.type("sss")
    words = shlex.split(view_command(session, str(session.path), (1280, 720)))
    assert words[words.index("--sample") + 1] == "3"
    room.session.export.figure = "tree"
    figure = save(room)
    assert read_figure(figure.resolve()).state.sample == 3
    assert ", sample 3 of 4, depth 3" in figure.read_text("utf-8")
    command = shlex.split(session.export.command)
    assert main([*command[1:], "-o", "again.svg"]) == 0
    assert Path("again.svg").read_bytes() == figure.read_bytes()
    assert session.tree
    before = session.tree.nodes.tobytes()

    fresh(room)
    drop(room, figure.resolve())
    assert room.session.tree and sample(room) == 3
    assert room.session.tree.nodes.tobytes() == before
    # Exported again from the figure, it is the same tree.
    assert main(["export", str(figure), "--format", "json", "-o", "again.json"]) == 0
    assert '"sample": 3' in Path("again.json").read_text("utf-8")


def test_a_refined_image_is_never_coarser_than_its_samples(room: Driver) -> None:
    """A pixel that has more samples than the scene asks for shows their mean, any other one that of the scene's."""
    session = room.session
    assert session.image.picture and session.world
    first = session.image.picture.pixels
    room.type("r")
    until(room, lambda: session.refinement.current is not None and len(session.refinement.current.points) > 3)
    room.type("r")
    session.image.runner.submit(lambda: None).result()  # no tile is being traced any more
    run = session.refinement.current
    assert run and run.image and run.picture
    counts = run.image.statistics.counts
    assert counts.min() < COUNT < counts.max()
    for few in (True, False):
        y, x = np.argwhere((counts < COUNT) == few)[0]
        session.pick(int(x), int(y))
        count, rgb = pixel_mean(session) or (0, np.zeros(3))
        assert count == (COUNT if few else counts[y, x])
        wanted = first[y, x] if few else tracer.render(session.world, samples=int(count)).pixels[y, x]
        assert rgb.tobytes() == wanted.tobytes()
        assert (run.picture.shown[y, x, :3] == srgb(wanted)).all()

"""The light that a level adds to the image: its numbers are those of the trees, and the window never waits for them."""

import re
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.scenes import ball, world_of
from tests.viewer.driver import viewer
from tests.viewer.lessons.test_live import GLASS, LAMPS, context, words
from tracer.kernel.nodes import SHADOW
from tracer.scene import Image
from viewer.figures.marks import Mark, Raster
from viewer.lessons.lesson import read_file
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.live.pieces.difference import Difference, small_image
from viewer.lessons.moments import Moment

SIZE = (24, 18)


def small_world(**options: object) -> tracer.World:
    balls = (ball((-0.9, 0, 0), 1.0, GLASS), ball((1.1, 0.2, -1.0), 0.8, GLASS))
    return world_of(*balls, lights=LAMPS, background=(0.3, 0.4, 0.5), image=Image(*SIZE), **options)


@pytest.mark.parametrize("model", ["whitted", "fresnel"])
def test_the_numbers_are_those_of_the_trees(model: str) -> None:
    """Pixel by pixel; a pixel changes exactly if its tree has rays at that level."""
    world, d = small_world(), 3
    found = Difference(d, small_image(world, d, model) - small_image(world, d - 1, model))
    has_rays = np.zeros(SIZE[::-1], bool)
    for y, x in np.ndindex(*SIZE[::-1]):
        trees = [tracer.trace(world, (x, y), depth=depth, model=model) for depth in (d, d - 1)]
        assert np.array_equal(found.pixels[y, x], trees[0].radiance - trees[1].radiance)
        nodes = trees[0].nodes
        has_rays[y, x] = ((nodes["depth"] == d) & (nodes["kind"] != SHADOW)).any()
    assert 0.0 < found.changed == has_rays.mean() < 1.0
    assert found.largest == found.pixels.max() and found.mean == pytest.approx(found.pixels.mean())
    assert 0.2 < found.times * found.largest <= 1.0


def test_the_first_level_adds_the_image_and_one_without_rays_nothing() -> None:
    world = small_world()
    first = picture(live_kind("difference").marks(context(world, None), {"d": 0.4}))
    assert first.shape == SIZE and "depth 0" in words(live_kind("difference").marks(context(world, None), {"d": 0}))
    matte = world_of(ball((0, 0, 0), 1.0), lights=LAMPS, image=Image(*SIZE))
    assert "nothing is added" in words(live_kind("difference").marks(context(matte, None), {}, ("2",)))
    with pytest.raises(ValueError, match=r"difference: d must be from 0 to 6, got 7"):
        live_kind("difference").marks(context(world, None), {}, ("7",))


def picture(marks: list[Mark]) -> Raster:
    (found,) = (mark for mark in marks if isinstance(mark, Raster))
    return found


SCENE = """
format = 1
[image]
width = 40
height = 30
[background]
color = [0.5, 0.6, 0.7]
[[material]]
name = "mirror"
reflect = 0.5
[[object]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "mirror"
"""
TEXT = '+++\ntitle = "Mine"\nquestion = "Why?"\npixel = [20, 15]\n+++\n## One\n```live\ndifference 1\n```\n'


def test_the_window_shows_it_when_it_is_traced(tmp_path: Path) -> None:
    """The first frame says that it is being traced; a background thread brings it, for this scene and no other."""
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    (tmp_path / "lesson.md").write_text(TEXT, "utf-8")
    lesson = read_file(tmp_path / "lesson.md")
    with viewer() as driver:
        images = driver.session.small_images
        driver.session.player.show(lesson, Moment())
        driver.app.settle()
        assert driver.session.faults == []
        (line,) = driver.canvas.live_places
        share = re.search(r"([\d.]+) % of the pixels", words(driver.canvas.live[line].last))
        world = driver.session.world
        assert world
        trees = [tracer.trace(world, (x, y), depth=1) for x, y in np.ndindex(40, 30)]
        assert share and share[1] == f"{100 * np.mean([len(tree) > 1 for tree in trees]):.1f}"
        assert picture(driver.canvas.live[line].last).shape == (40, 30)
        driver.session.player.parameters = {"d": 2.0}
        while images.runner.submit(lambda: None).result() or (2, "whitted") not in images.asked:
            driver.app.frame()  # without an update of the session, nothing that is posted arrives
            assert "is being traced" in words(driver.canvas.live[line].last)
        driver.frames()
        assert "depth 2 − depth 1" in words(driver.canvas.live[line].last)
        assert "nothing is added" in words(driver.canvas.live[line].last)

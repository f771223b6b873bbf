"""Every shape in the 3D view and in the scene's figure, by its `example()`."""

import numpy as np
import pytest

import tracer
from tests.scenes import world_of
from tracer.scene import Camera, Light, Material, Object
from tracer.shapes import SHAPE_NAMES, SHAPES
from tracer.shapes.shape import Shape
from viewer.base.orbit import Frame, initial_orbit
from viewer.base.theme import DARK
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.gl.stage import Stage
from viewer.window.backend import Offscreen

RED = Material("red", color=(1.0, 0.0, 0.0), ambient=0.3, diffuse=0.7)
GLASS = Material("glass", transmit=0.9, reflect=0.1, ior=1.5)


def world(shape: Shape, material: Material) -> tracer.World:
    lamp = Light("lamp", position=(3.0, 6.0, 5.0))
    return world_of(Object(shape, material, "it"), lights=[lamp], camera=Camera((1.5, 2.0, 4.0), (0.0, 0.0, 0.0)))


@pytest.mark.parametrize("shape", SHAPES, ids=SHAPE_NAMES)
def test_it_is_drawn_in_the_3d_view(shape: type[Shape]) -> None:
    surface = Offscreen((400, 300))
    stage = Stage(surface.ctx)
    try:
        for material in (RED, GLASS):
            own = world(shape.example(), material)
            frame = Frame.of(own)
            orbit = initial_orbit(own, frame, None)
            stage.set_world(own, frame)
            stage.draw(orbit, DARK, (400, 300), 1.0, None)
            picture = stage.target.pixels().astype(int)
            if material is RED:
                red = (picture[..., 0] > 60) & (picture[..., 1] < 30) & (picture[..., 2] < 30)
                assert red.mean() > 0.01
            else:
                assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    finally:
        stage.release()
        surface.close()


@pytest.mark.parametrize("shape", SHAPES, ids=SHAPE_NAMES)
def test_it_has_an_outline_and_its_name_in_the_figure_of_the_scene(shape: type[Shape]) -> None:
    own = world(shape.example(), RED)
    subject = Subject(by_depth([tracer.trace(own, (32, 24))]), own, initial_orbit(own, Frame.of(own), None))
    (page,) = pages("scene", subject, FigureStyle())
    assert any(mark.title == "it" for mark in page.marks)

"""The camera of the 3D view: its start."""

import math

import numpy as np
import pytest

from tests.scenes import ball, plane, polygon, world_of
from tracer.formulas.vector import Vector
from tracer.scene import Camera
from viewer.base.orbit import Frame, initial_orbit, project


@pytest.mark.parametrize("radius", [50.0, 1e9])
def test_a_scene_is_seen_and_not_the_earth_it_stands_on(radius: float) -> None:
    """An object far larger than the distance to the camera's target does not count, unless it is the only one."""
    earth, item = ball((0, -radius - 1.0, 0), radius), ball((1, 0, 0), 1.0)
    floor = polygon([(-radius, -1, -radius), (-radius, -1, radius), (radius, -1, radius), (radius, -1, -radius)])
    camera = Camera(position=(0.0, 0.0, 10.0), look_at=(0.0, 0.0, 0.0))
    alone = Frame.of(world_of(item, camera=camera))
    assert alone.middle.tolist() == [1.0, 0.0, 0.0]
    for ground in (earth, floor):
        frame = Frame.of(world_of(ground, item, camera=camera))
        assert (frame.middle.tolist(), frame.radius) == (alone.middle.tolist(), alone.radius)
        assert Frame.of(world_of(ground, camera=camera)).radius >= radius
    everything = Frame.of(world_of(earth, item, camera=Camera()))
    assert everything.radius >= radius
    assert np.isfinite(everything.middle).all()


@pytest.mark.parametrize("eye", [(0.0, 2.0, 10.0), (4.0, 0.5, -3.0), (0.0, -2.0, 4.0)])
@pytest.mark.parametrize("walls", ["floor", "floor wall", "floor wall ceiling", "floor wall ceiling left"])
@pytest.mark.parametrize("radius", [0.0, 0.05, 1.0])
def test_an_infinite_plane_hides_nothing(walls: str, eye: Vector, radius: float) -> None:
    """Eye, the point that it looks at and where the ray to it ends are in the picture, from the eye's side of every
    plane. A small ball (0: none) on the floor does not decide how much of the floor is seen.
    """
    side = 1.0 if eye[1] > 0.0 else -1.0
    planes = {
        "floor": ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0)), "wall": ((5.0, 0.0, 0.0), (-1.0, 0.0, 0.0)),
        "ceiling": ((0.0, 12.0 * side, 0.0), (0.0, -1.0, 0.0)), "left": ((-9.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    }  # fmt: skip
    items = [plane(*planes[name], name=name) for name in walls.split()]
    balls = [ball((1.0, radius * side, 0.0), radius)] if radius else []
    target = (0.0, 0.0, 0.0)
    world = world_of(*items, *balls, camera=Camera(position=eye, look_at=target))
    frame = Frame.of(world)
    orbit = initial_orbit(world, frame, None)
    place = frame.middle + frame.radius * orbit.eye
    for name in walls.split():
        point, normal = planes[name]
        ours, theirs = (np.dot(np.subtract(at, point), normal) for at in (place, eye))
        assert ours * theirs > 0.0
    shown, depths = project(frame.inside((eye, target)), orbit.matrix(1.5), (1.0, 1.0))
    assert (depths > 0.0).all() and (np.abs(shown - 0.5) < 0.5).all()
    assert frame.radius >= 0.5 * math.dist(eye, target)

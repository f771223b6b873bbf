"""The camera of the 3D view: its start."""

import numpy as np
import pytest

from tests.scenes import ball, polygon, world_of
from tracer.scene import Camera
from viewer.base.orbit import Frame


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

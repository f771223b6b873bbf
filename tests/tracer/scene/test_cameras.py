"""Cameras: parameters that an author leaves out are chosen so that the scene is in view."""

import numpy as np
import pytest

from tests.scenes import ball, world_of
from tracer.scene import Camera


@pytest.mark.parametrize(
    ("center", "radius", "camera"),
    [
        ((1e9, 0.0, 0.0), 1e-12, Camera()),  # no float64 differs from 1e9 by as little
        ((0.0, 0.0, 0.0), 1.0, Camera(position=(0.0, 0.0, 0.0))),  # the camera stands at its target
        ((0.0, 0.0, 0.0), 1.0, Camera(position=(0.0, 5.0, 0.0))),  # straight down, along `up`
        ((0.0, 0.0, 0.0), 1e-150, Camera(up=(0.0, 1e-150, 0.0))),
    ],
)
def test_what_is_left_open_of_a_camera_always_gives_one(center: tuple, radius: float, camera: Camera) -> None:
    view = world_of(ball(center, radius), camera=camera).view()
    axes = np.array([view.forward, np.divide(view.right, np.linalg.norm(view.right)), view.up])
    axes[2] /= np.linalg.norm(view.up)
    assert np.abs(axes @ axes.T - np.eye(3)).max() <= 8 * 2.0**-53

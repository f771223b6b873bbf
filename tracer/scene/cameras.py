"""The view of a scene's camera. A position or target that the scene file leaves out is chosen so that the whole scene
is visible.
"""

import math
import operator
from dataclasses import replace

from tracer.formulas.camera import View, make_view
from tracer.formulas.vector import Vector, add, cross, rescale, scale, unit
from tracer.scene.scene import Camera, Scene

MARGIN = 1.1  # ratio of the radius that a default camera sees to the radius of the scene


def scene_view(scene: Scene, extent: tuple[Vector, float], size: tuple[int, int] | None = None) -> View:
    """The view of the scene's camera.

    `extent` is (centre, radius) of the scene; `size` is (width, height) in pixels, by default the scene's own.
    ValueError for a size below 1x1.
    """
    width, height = (operator.index(value) for value in size or (scene.image.width, scene.image.height))
    if width < 1 or height < 1:
        raise ValueError(f"size must be at least 1x1, got {width}x{height}")
    camera = placed_camera(scene, extent, (width, height))
    assert camera.position is not None and camera.look_at is not None
    return make_view(camera.position, camera.look_at, camera.up, camera.fov, (width, height))


def placed_camera(scene: Scene, extent: tuple[Vector, float], size: tuple[int, int]) -> Camera:
    """The scene's camera with a position and a target, for an image of this size."""
    camera = scene.camera
    middle, radius = extent
    look_at = camera.look_at or middle
    position = camera.position or framing_position(camera, look_at, radius, size)
    return replace(camera, position=position, look_at=look_at)


def framing_position(camera: Camera, look_at: Vector, radius: float, size: tuple[int, int]) -> Vector:
    """The position from which a camera sees a whole ball about `look_at`, from above and from the side, in an image of
    this size.
    """
    width, height = size
    narrow = math.radians(camera.fov) / 2
    if width < height:
        narrow = math.atan(math.tan(narrow) * width / height)
    up = unit(rescale(camera.up))
    aside = unit(cross(up, (0.0, 0.0, 1.0) if abs(up[2]) < 0.9 else (1.0, 0.0, 0.0)))
    ahead = cross(aside, up)
    away = unit(add(add(scale(0.35, up), scale(0.45, aside)), ahead))
    # For a tiny scene far from the origin, the camera's position would have too few digits.
    least = 2.0**-40 * max(map(abs, look_at))
    return add(look_at, scale(MARGIN * (max(radius, least) or 1.0) / math.sin(narrow), away))

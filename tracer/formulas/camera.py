"""The pinhole camera: from a place in the image to a ray, and where it stands when the author did not say.

(x, y) counts in pixels from the image's top left corner, so pixel (i, j) covers i..i+1, j..j+1 and its centre is at
+0.5. The field of view is over the image's full height. Directions are -z forward, x right, y up in the camera's
frame.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector, add, cross, rescale, scale, subtract, unit
from tracer.scene import Scene

BATCH = 64  # pixels of a line whose directions are worked out together
MARGIN = 1.1  # how much more than the whole scene a framing camera sees


class View(NamedTuple):
    """A camera as kernels take it: right and up have the length of half the image's height at distance 1."""

    eye: Vector
    forward: Vector
    right: Vector
    up: Vector
    width: int
    height: int


def make_view(eye: Vector, look_at: Vector, up: Vector, fov: float, size: tuple[int, int]) -> View:
    """`fov` in degrees; `size` in pixels, width first."""
    eye = _vector(eye)  # floats, whatever the author wrote: kernels are compiled for one type
    gaze = subtract(look_at, eye)
    forward = unit(rescale(gaze)) if any(gaze) else (0.0, 0.0, -1.0)
    aside = cross(forward, rescale(up))
    if not any(aside):  # a view straight along `up`, which only a camera can have that its author left open
        aside = cross(forward, (0.0, 0.0, 1.0) if abs(forward[2]) < 0.5 else (1.0, 0.0, 0.0))
    right = unit(rescale(aside))
    half = math.tan(math.radians(fov) / 2)
    return View(eye, forward, scale(half, right), scale(half, cross(right, forward)), *size)


def scene_view(scene: Scene, extent: tuple[Vector, float], size: tuple[int, int] | None = None) -> View:
    """The scene's camera for an image of this size; what the author left out frames the scene's middle and radius."""
    camera = scene.camera
    width, height = size or (scene.image.width, scene.image.height)
    middle, radius = extent
    look_at = camera.look_at or middle
    position = camera.position
    if position is None:
        narrow = math.radians(camera.fov) / 2
        if width < height:
            narrow = math.atan(math.tan(narrow) * width / height)
        up = unit(rescale(camera.up))
        aside = unit(cross(up, (0.0, 0.0, 1.0) if abs(up[2]) < 0.9 else (1.0, 0.0, 0.0)))
        ahead = cross(aside, up)
        away = unit(add(add(scale(0.35, up), scale(0.45, aside)), ahead))
        # Of a speck far from the origin no camera can come near: its place has no digits for that.
        least = 2.0**-40 * max(map(abs, look_at))
        position = add(look_at, scale(MARGIN * (max(radius, least) or 1.0) / math.sin(narrow), away))
    return make_view(position, look_at, camera.up, camera.fov, (width, height))


def _vector(array: Sequence[float] | np.ndarray) -> Vector:
    return (float(array[0]), float(array[1]), float(array[2]))


@inlined
def pixel_direction(view: View, x: float, y: float) -> Vector:
    """Unit direction of the ray through the image at (x, y), in pixels."""
    u = (2.0 * x - view.width) / view.height
    v = (view.height - 2.0 * y) / view.height
    return unit(add(view.forward, add(scale(u, view.right), scale(v, view.up))))


@inlined
def pixel_directions(view: View, x: int, y: int, step: int, right: int, ahead: Any) -> None:
    """Directions through the centres of pixels x, x + step ... of a line, before `right` and no more than AHEAD.

    They go into the columns of `ahead` (3, AHEAD). The processor takes four roots or quotients at once, and none of
    them is waited for.
    """
    for k in range(min(BATCH, -((x - right) // step))):
        d = pixel_direction(view, x + k * step + 0.5, y + 0.5)
        ahead[0, k] = d[0]
        ahead[1, k] = d[1]
        ahead[2, k] = d[2]

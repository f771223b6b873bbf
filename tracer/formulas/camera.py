"""The pinhole camera: the ray through a point of the image.

Image coordinates (x, y) are in pixels from the top left corner: pixel (i, j) covers i..i+1, j..j+1, its centre is at
(i + 0.5, j + 0.5). The field of view spans the image's full height. Camera frame: x right, y up, -z forward.
"""

import math
from typing import Any, NamedTuple

from tracer.compile.jit import inlined
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, add, as_floats, cross, dot, length, rescale, scale, subtract, unit

BATCH = 64  # pixels whose directions are computed together
FRAME_ROUNDING = 3.0  # rounding errors of the cross product that gives the camera's frame, in u


class View(NamedTuple):
    """A camera in the form that kernels use. `right` and `up` are as long as half the image's height at distance 1."""

    eye: Vector
    forward: Vector
    right: Vector
    up: Vector
    width: int
    height: int


def make_view(eye: Vector, look_at: Vector, up: Vector, fov: float, size: tuple[int, int]) -> View:
    """The view of a camera. `fov` in degrees over the full height, `size` as (width, height) in pixels."""
    eye = as_floats(eye)  # floats, whatever the author wrote: kernels are compiled for one type
    gaze = subtract(look_at, eye)
    forward = unit(rescale(gaze)) if any(gaze) else (0.0, 0.0, -1.0)
    aside = cross(forward, rescale(up))
    if not any(aside):  # the view is along `up`, which is possible only if the scene leaves out `position` or `look_at`
        aside = cross(forward, (0.0, 0.0, 1.0) if abs(forward[2]) < 0.5 else (1.0, 0.0, 0.0))
    right = unit(rescale(aside))
    half = math.tan(math.radians(fov) / 2)
    return View(eye, forward, scale(half, right), scale(half, cross(right, forward)), *size)


@inlined
def pixel_direction(view: View, x: float, y: float) -> Vector:
    """Unit direction of the ray through image point (x, y), in pixels."""
    u = (2.0 * x - view.width) / view.height
    v = (view.height - 2.0 * y) / view.height
    return unit(add(view.forward, add(scale(u, view.right), scale(v, view.up))))


def direction_error(view: View, given_up: Vector, direction: Vector) -> float:
    """Bound on the rounding error of `pixel_direction` due to the camera's frame, to first order, in radians.

    The frame turns about the line of sight by the error of its cross product over the sine of the angle to `given_up`,
    the author's `up`. The half height of the image is a tangent, whose condition number is 2x / sin 2x.
    """
    aside = length(cross(view.forward, unit(rescale(given_up))))
    off_axis = length(cross(view.forward, direction))
    half = length(view.up)
    tangent = math.atan(half) * (1.0 + half * half) / half
    twist = FRAME_ROUNDING / aside if aside > 0.0 else 0.0
    stretch = tangent * abs(dot(view.forward, direction))
    return U * off_axis * (twist + stretch)


@inlined
def center_directions(direction_of: Any, view: View, pixels: Any, first: int, directions: Any) -> None:
    """Store the directions through the centres of pixels `first`, `first` + 1, ... in the columns of `directions`.

    Computed BATCH at a time, so that the processor takes several roots and quotients at once. `direction_of` is
    `pixel_direction` or a replacement.
    """
    for k in range(min(BATCH, len(pixels) - first)):
        d = direction_of(view, pixels[first + k].x + 0.5, pixels[first + k].y + 0.5)
        directions[0, k] = d[0]
        directions[1, k] = d[1]
        directions[2, k] = d[2]

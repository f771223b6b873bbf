"""A place in the image that need not be a pixel's centre."""

from tracer.formulas.camera import pixel_direction
from tracer.formulas.vector import Vector
from tracer.kernel.world import World


def ray_between(world: World, between: tuple[float, float]) -> tuple[Vector, Vector]:
    """(origin, direction) of the camera ray at a place in the image, in pixels from the centre of pixel (0, 0)."""
    view = world.view()
    return view.eye, pixel_direction(view, between[0] + 0.5, between[1] + 0.5)

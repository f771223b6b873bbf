"""A place in the image of a step: a pixel with its tree, or a place between pixels with its ray."""

import tracer
from tracer.formulas.camera import pixel_direction
from tracer.formulas.sampler import sample_number
from tracer.formulas.vector import Vector
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.lessons.step import State


def pixel_fault(size: tuple[int, int], pixel: tuple[int, int]) -> str:
    """The fault of a pixel outside an image of this width and height; empty if it is inside."""
    (width, height), (x, y) = size, pixel
    if 0 <= x < width and 0 <= y < height:
        return ""
    return f"pixel must be within 0,0 .. {width - 1},{height - 1}, got {x},{y}"


def pixel_tree(world: World, state: State, depth: int | None = None) -> RayTree:
    """The tree of the pixel and the sample of a step's state, at this depth or at that of the state. ValueError for a
    sample that the scene does not have.
    """
    sample = sample_number(world.scene.image.samples, state.sample)
    depth = state.depth if depth is None else depth
    return tracer.trace(world, state.pixel, sample=sample, depth=depth, model=state.model)


def ray_between(world: World, between: tuple[float, float]) -> tuple[Vector, Vector]:
    """(origin, direction) of the camera ray at a place in the image, in pixels from the centre of pixel (0, 0)."""
    view = world.view()
    return view.eye, pixel_direction(view, between[0] + 0.5, between[1] + 0.5)

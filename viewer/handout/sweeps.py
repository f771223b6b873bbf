"""The positions of a step's sweep: the tree at each."""

from collections.abc import Callable
from dataclasses import dataclass

import tracer
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.lessons.image_place import pixel_tree, ray_between
from viewer.lessons.step import Step
from viewer.lessons.sweep import Sweep

POSITIONS = 13  # of a sweep, with both ends; the window stops at each of them, too


@dataclass(frozen=True)
class Position:
    """One position of a sweep. `words` say where it is; `place` is that of its ray in the image, in pixels from the
    centre of pixel (0, 0).
    """

    world: World
    tree: RayTree
    words: str
    place: tuple[float, float]


def positions(step: Step, sweep: Sweep, world_of: Callable[[float], World]) -> list[Position]:
    """The positions, from the start to the end. `world_of` prepares the step's scene at a share of the sweep."""
    return [_position(step, sweep, world_of, k / (POSITIONS - 1)) for k in range(POSITIONS)]


def _position(step: Step, sweep: Sweep, world_of: Callable[[float], World], share: float) -> Position:
    state, between = step.state.swept(share), sweep.between(share)
    world = world_of(share)
    if between:
        tree = tracer.trace(world, ray=ray_between(world, between), depth=state.depth, model=state.model)
    else:
        tree = pixel_tree(world, state)
    return Position(world, tree, sweep.words(share), between or state.pixel or (0, 0))

"""The positions of a step's sweep: the tree at each.

Between two pixels, the camera ray goes through points between them, since whole pixels jump over what is of interest,
like the critical angle. A number of the scene is changed in it.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import tracer
from tracer.formulas.camera import pixel_direction
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_number
from viewer.lessons.step import PIXEL, Step, Sweep

POSITIONS = 13  # of a sweep, with both ends


@dataclass(frozen=True)
class Position:
    """One position of a sweep. `words` say where it is; `pixel` is the place in the image, in pixels from the top left,
    of its ray.
    """

    world: World
    tree: RayTree
    words: str
    pixel: tuple[float, float]


def positions(step: Step, sweep: Sweep, world: World) -> list[Position]:
    """The positions, from the start to the end. Raises SceneError if the scene does not allow a value."""
    return [_position(step, sweep, world, k / (POSITIONS - 1)) for k in range(POSITIONS)]


def _position(step: Step, sweep: Sweep, world: World, share: float) -> Position:
    state, value = step.state, sweep.at(share)
    words = ", ".join(format_number(x) for x in value)
    if sweep.of == PIXEL:
        view = world.view()
        x, y = value
        ray = (view.eye, pixel_direction(view, x + 0.5, y + 0.5))
        tree = tracer.trace(world, ray=ray, depth=state.depth, model=state.model)
        whole = x == int(x) and y == int(y)
        return Position(world, tree, f"pixel {words}" if whole else f"between pixels, at {words}", (x, y))
    changes = _both(state.set, tomllib.loads(f"{sweep.of} = {value[0]!r}"))
    changed = tracer.prepare(tracer.load(step.scene, changes=changes))
    tree = tracer.trace(changed, state.pixel, depth=state.depth, model=state.model)
    return Position(changed, tree, f"{sweep.of} = {words}", state.pixel or (0, 0))


def _both(first: Mapping[str, Any], second: Mapping[str, Any]) -> dict[str, Any]:
    """Two nested tables in one. A value of the second goes before that of the first."""
    found = dict(first)
    for key, value in second.items():
        inner = found.get(key)
        if isinstance(value, Mapping) and isinstance(inner, Mapping):
            value = _both(inner, value)
        found[key] = value
    return found

"""Light and surroundings for a file that has none, such as a bare mesh."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tracer.formulas.vector import Vector, as_floats
from tracer.scene.scene import Background, Light, Object, Tracing, middle_and_radius


def default_lights(objects: Sequence[Object]) -> tuple[Light, ...]:
    """A key light from above on one side, and a weaker one from the other. The objects must be bounded."""
    boxes = [box for item in objects if (box := item.shape.bounds()) is not None]
    middle, radius = middle_and_radius(np.concatenate(boxes))

    def at(x: float, y: float, z: float) -> Vector:
        return as_floats(middle + radius * np.array([x, y, z]))

    return (
        Light("key", position=at(3.0, 4.0, 4.0), color=(0.8, 0.8, 0.78)),
        Light("fill", position=at(-4.0, 2.0, 3.0), color=(0.3, 0.32, 0.36)),
    )


def default_surroundings() -> dict[str, Any]:
    """A blue background and white ambient light, as arguments of `Scene`."""
    return {"background": Background((0.55, 0.65, 0.8)), "tracing": Tracing(ambient=(1.0, 1.0, 1.0))}

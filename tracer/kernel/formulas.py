"""The functions that the kernel computes with, as a table that is part of the world.

A kernel calls `world.formulas.intersect(...)`. So the same kernel can be compiled with other formulas, to compare
their accuracy and speed (`tracer.measure.precision.textbook_kernel`).
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from tracer.formulas.camera import pixel_direction
from tracer.formulas.optics import mirrored, sine, transmission
from tracer.shapes import interaction, intersect, next_hit
from tracer.shapes.planar import plane_distance, plane_interaction

Function = Callable[..., Any]


class Formulas(NamedTuple):
    """`name` tells compiled kernels apart. The functions are those of `tracer.shapes` and `tracer.formulas`."""

    name: str
    pixel_direction: Function
    intersect: Function
    next_hit: Function
    interaction: Function
    plane_distance: Function
    plane_interaction: Function
    mirrored: Function
    sine: Function
    transmission: Function

    def __reduce__(self) -> tuple[Callable[[str], "Formulas"], tuple[str]]:
        """Pickle by name: another process has its own functions."""
        return (_named, (self.name,))


STABLE = Formulas(
    name="stable",
    pixel_direction=pixel_direction,
    intersect=intersect,
    next_hit=next_hit,
    interaction=interaction,
    plane_distance=plane_distance,
    plane_interaction=plane_interaction,
    mirrored=mirrored,
    sine=sine,
    transmission=transmission,
)


def _named(name: str) -> Formulas:
    if name != STABLE.name:
        raise ValueError(f"only the {STABLE.name} formulas are known to another process, got {name}")
    return STABLE

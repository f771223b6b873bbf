"""The shapes the tracer knows. A new one is a file beside this one and its name in SHAPES.

A shape's file has NAME, the dataclass an author writes, and what kernels call, all with the row of `world.surfaces`
the shape was packed into:
    intersect(world, surface, ray, floor, ceiling, exactly)   smallest t > 0 that is >= floor, infinite for none;
        what lies beyond the ceiling is left out. Where it need not be exact any number within the limits will do
    again(world, surface, ray)              the same for a ray that starts on this very surface
    locate(world, surface, ray, t)          the hit point, the outward normal, the normal to shade with
    turning(world, surface, p, v)           how the normal to shade with turns where the hit point p moves by a small v
"""

import math
from collections.abc import Callable
from types import ModuleType
from typing import Any

from tracer.compile.jit import compiled
from tracer.formulas.vector import Vector
from tracer.rays import Ray
from tracer.shapes import box, cone, disc, plane, polygon, sphere, triangle

SHAPES: tuple[ModuleType, ...] = (sphere, plane, polygon, triangle, box, cone, disc)

CODES = {module.NAME: code for code, module in enumerate(SHAPES)}

# Numba compiles a choice between known functions, not a table of functions: so each of the four is folded from the
# last shape to the first into `if this shape: its own, else: the rest`, which the compiler turns into one jump.


def _fold(part: str, otherwise: Callable[..., Any], link: Callable[..., Any]) -> Callable[..., Any]:
    rest = otherwise
    for code in reversed(range(len(SHAPES))):
        rest = link(code, getattr(SHAPES[code], part), rest)
    return rest


def _link_intersect(code: int, own: Any, rest: Any) -> Any:
    @compiled
    def choose(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
        if surface.form == code:
            return own(world, surface, ray, floor, ceiling, exactly)
        return rest(world, surface, ray, floor, ceiling, exactly)

    return choose


def _link_again(code: int, own: Any, rest: Any) -> Any:
    @compiled
    def choose(world: Any, surface: Any, ray: Ray) -> float:
        if surface.form == code:
            return own(world, surface, ray)
        return rest(world, surface, ray)

    return choose


def _link_locate(code: int, own: Any, rest: Any) -> Any:
    @compiled
    def choose(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        if surface.form == code:
            return own(world, surface, ray, t)
        return rest(world, surface, ray, t)

    return choose


def _link_turning(code: int, own: Any, rest: Any) -> Any:
    @compiled
    def choose(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
        if surface.form == code:
            return own(world, surface, p, v)
        return rest(world, surface, p, v)

    return choose


@compiled
def _no_intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    return math.inf


@compiled
def _no_again(world: Any, surface: Any, ray: Ray) -> float:
    return math.inf


@compiled
def _no_locate(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    nowhere = (math.nan, math.nan, math.nan)
    return (nowhere, nowhere, nowhere)


@compiled
def _no_turning(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
    return (0.0, 0.0, 0.0)


intersect = _fold("intersect", _no_intersect, _link_intersect)
again = _fold("again", _no_again, _link_again)
locate = _fold("locate", _no_locate, _link_locate)
turning = _fold("turning", _no_turning, _link_turning)

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

from tracer.compile.jit import inlined
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
    @inlined
    def choose(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
        if surface.form == code:
            return own(world, surface, ray, floor, ceiling, exactly)
        return rest(world, surface, ray, floor, ceiling, exactly)

    return choose


def _link_next_hit(code: int, own: Any, rest: Any) -> Any:
    @inlined
    def choose(world: Any, surface: Any, ray: Ray) -> float:
        if surface.form == code:
            return own(world, surface, ray)
        return rest(world, surface, ray)

    return choose


def _link_interaction(code: int, own: Any, rest: Any) -> Any:
    @inlined
    def choose(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        if surface.form == code:
            return own(world, surface, ray, t)
        return rest(world, surface, ray, t)

    return choose


def _link_normal_derivative(code: int, own: Any, rest: Any) -> Any:
    @inlined
    def choose(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
        if surface.form == code:
            return own(world, surface, p, v)
        return rest(world, surface, p, v)

    return choose


@inlined
def _no_intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    return math.inf


@inlined
def _no_next_hit(world: Any, surface: Any, ray: Ray) -> float:
    return math.inf


@inlined
def _no_interaction(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    nowhere = (math.nan, math.nan, math.nan)
    return (nowhere, nowhere, nowhere)


@inlined
def _no_normal_derivative(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
    return (0.0, 0.0, 0.0)


intersect = _fold("intersect", _no_intersect, _link_intersect)
next_hit = _fold("next_hit", _no_next_hit, _link_next_hit)
interaction = _fold("interaction", _no_interaction, _link_interaction)
normal_derivative = _fold("normal_derivative", _no_normal_derivative, _link_normal_derivative)

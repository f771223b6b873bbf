"""The shapes that the tracer knows. To add one, write a file like `sphere.py` and add its class to SHAPES.

A shape's file has its class (see `shape.py`) and the functions that kernels call. `surface` is its row of
`world.surfaces`.

    intersect(world, surface, ray, t_min, t_max, exact) -> t
        The smallest distance t > 0 with t_min <= t <= t_max at which the ray meets the surface, inf for none. Unless
        `exact`, any number between t_min and t_max will do for t: only whether the surface is met counts.
    next_hit(world, surface, ray) -> t
        The same for a ray that starts on this very surface.
    interaction(world, surface, ray, t) -> (point, normal, shading normal)
        The hit point, the unit outward normal there, and the one to shade with.
    normal_derivative(world, surface, p, v) -> change
        The change of the shading normal when the hit point p moves by a small vector v.
"""

import math
import sys
from collections.abc import Callable, Mapping
from typing import Any

from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector
from tracer.rays import Ray
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.shape import Shape
from tracer.shapes.sphere import Sphere
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow
from tracer.shapes.triangle import Triangle

SHAPES: tuple[type[Shape], ...] = (Sphere, Plane, Polygon, Triangle, Box, Cone, Disc, Mesh)

SHAPE_NAMES = tuple(shape.name for shape in SHAPES)
INTERSECTED = tuple(shape for shape in SHAPES if not shape.packed_as)
CODES = {shape.name: code for code, shape in enumerate(INTERSECTED)}  # in the field `shape_code` of a surface's row

Function = Callable[..., Any]


def function(shape: type[Shape], part: str) -> Function:
    """One of a shape's functions for kernels, from the file of its class."""
    return getattr(sys.modules[shape.__module__], part)


# Numba cannot call through a table of functions. So each function is a chain of choices, `if surface.shape_code ==
# code: own else: rest`, which LLVM compiles into one jump. `replaced` has functions for some shapes, instead of their
# own.


def choose_intersect(replaced: Mapping[str, Function] | None = None) -> Function:
    """`intersect` for any shape."""

    @inlined
    def none(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
        return math.inf

    def link(code: int, own: Function, rest: Function) -> Function:
        @inlined
        def intersect(
            world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool
        ) -> float:
            if surface.shape_code == code:
                return own(world, surface, ray, t_min, t_max, exact)
            return rest(world, surface, ray, t_min, t_max, exact)

        return intersect

    return _chain("intersect", replaced, none, link)


def choose_next_hit(replaced: Mapping[str, Function] | None = None) -> Function:
    """`next_hit` for any shape."""

    @inlined
    def none(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
        return math.inf

    def link(code: int, own: Function, rest: Function) -> Function:
        @inlined
        def next_hit(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
            if surface.shape_code == code:
                return own(world, surface, ray)
            return rest(world, surface, ray)

        return next_hit

    return _chain("next_hit", replaced, none, link)


def choose_interaction(replaced: Mapping[str, Function] | None = None) -> Function:
    """`interaction` for any shape."""

    @inlined
    def none(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        nowhere = (math.nan, math.nan, math.nan)
        return (nowhere, nowhere, nowhere)

    def link(code: int, own: Function, rest: Function) -> Function:
        @inlined
        def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
            if surface.shape_code == code:
                return own(world, surface, ray, t)
            return rest(world, surface, ray, t)

        return interaction

    return _chain("interaction", replaced, none, link)


def choose_normal_derivative() -> Function:
    """`normal_derivative` for any shape."""

    @inlined
    def none(world: ShapeArrays, surface: SurfaceRow, p: Vector, v: Vector) -> Vector:
        return (0.0, 0.0, 0.0)

    def link(code: int, own: Function, rest: Function) -> Function:
        @inlined
        def normal_derivative(world: ShapeArrays, surface: SurfaceRow, p: Vector, v: Vector) -> Vector:
            if surface.shape_code == code:
                return own(world, surface, p, v)
            return rest(world, surface, p, v)

        return normal_derivative

    return _chain("normal_derivative", None, none, link)


def _chain(
    part: str, replaced: Mapping[str, Function] | None, none: Function, link: Callable[..., Function]
) -> Function:
    """Link the functions of all shapes, from the last shape to the first."""
    rest = none
    for shape in reversed(INTERSECTED):
        own = (replaced or {}).get(shape.name) or function(shape, part)
        rest = link(CODES[shape.name], own, rest)
    return rest


intersect = choose_intersect()
next_hit = choose_next_hit()
interaction = choose_interaction()
normal_derivative = choose_normal_derivative()

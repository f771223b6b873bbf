"""The textbook's formulas in our kernel, in double and in single precision: what the stable ones are compared with.

The quadratic is solved by (-b -+ sqrt(b^2 - ac)) / a, planes by one division; the hit point is origin + t direction;
the normal of a box is that of the face nearest to the hit; a direction is normalised by a square root and three
divisions. In single precision, distances, points and directions have 24 bits, and what has no formula here is
computed in double and rounded. There is no smallest distance: as always, a ray does not meet the surface that it
leaves.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from tracer.compile.jit import inlined
from tracer.formulas.camera import pixel_direction
from tracer.formulas.optics import transmission
from tracer.formulas.vector import Vector, add, dot, scale, subtract, unit, vector
from tracer.image.render import render
from tracer.image.warmup import BALL
from tracer.kernel.formulas import Formulas, Function
from tracer.kernel.world import World, prepare
from tracer.rays import Ray
from tracer.scene import Scene
from tracer.shapes import INTERSECTED, choose_interaction, choose_intersect, choose_next_hit, function
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow

KINDS = ("double", "single")


def textbook_world(kind: str, scene: Scene) -> World:
    """The scene, to be traced by the textbook's formulas."""
    return prepare(scene, formulas=textbook_formulas(kind))


def warm_up() -> None:
    """Compile the kernels with the textbook's formulas, or load them from disk."""
    for kind in KINDS:
        render(textbook_world(kind, BALL), (1, 1))


def textbook_formulas(kind: str) -> Formulas:
    """The formulas in `double` or `single` precision."""
    of = {"double": to_double, "single": to_single}[kind]
    parts: dict[str, dict[str, Function]] = {
        "intersect": {"sphere": _sphere(of)},
        "interaction": {"sphere": _on_sphere(of), "box": _on_box(of)},
        "next_hit": {},
    }
    direction, bend = pixel_direction, transmission
    if kind == "single":
        wrappers = {"intersect": _rounded_intersect, "interaction": _rounded_interaction, "next_hit": _rounded_next_hit}
        for part, wrap in wrappers.items():
            own = parts[part]
            parts[part] = {s.name: wrap(own.get(s.name) or function(s, part)) for s in INTERSECTED}
        direction, bend = _rounded_vector(direction), _rounded_vector(bend)
    return Formulas(
        name=f"textbook {kind}",
        pixel_direction=direction,
        intersect=choose_intersect(parts["intersect"]),
        next_hit=choose_next_hit(parts["next_hit"]),
        interaction=choose_interaction(parts["interaction"]),
        plane_distance=_plane(of),
        plane_interaction=_on_plane(of),
        mirrored=_mirrored(of),
        sine=_sine(of),
        transmission=bend,
    )


@inlined
def to_double(x: float) -> Any:
    """The number in double precision."""
    return np.float64(x)


@inlined
def to_single(x: float) -> Any:
    """The number in single precision."""
    return np.float32(x)


Convert = Callable[[float], Any]  # to_double or to_single


def _triple(of: Convert) -> Callable[[Any], Any]:
    """Convert the three components of a vector."""

    @inlined
    def triple(a: Any) -> Any:
        return (of(a[0]), of(a[1]), of(a[2]))

    return triple


def _sphere(of: Convert) -> Function:
    triple = _triple(of)

    @inlined
    def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
        d, r = triple(ray.direction), of(surface.r)
        f = subtract(triple(ray.origin), triple(vector(surface.a)))
        a, b, c = dot(d, d), dot(f, d), dot(f, f) - r * r
        discriminant = b * b - a * c
        if discriminant < 0.0:
            return math.inf
        root = of(math.sqrt(discriminant))
        near, far = np.float64((-b - root) / a), np.float64((-b + root) / a)
        if near > 0.0 and near >= t_min:
            return near
        return far if far > 0.0 and far >= t_min else math.inf

    return intersect


def _on_sphere(of: Convert) -> Function:
    triple, wide = _triple(of), _triple(to_double)

    @inlined
    def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        p = add(triple(ray.origin), scale(of(t), triple(ray.direction)))
        n = scale(of(1.0) / of(surface.r), subtract(p, triple(vector(surface.a))))
        return (wide(p), wide(n), wide(n))

    return interaction


def _plane(of: Convert) -> Function:
    triple = _triple(of)

    @inlined
    def plane_distance(
        world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool
    ) -> float:
        n = triple(vector(surface.normal))
        t = np.float64(dot(n, subtract(triple(vector(surface.a)), triple(ray.origin))) / dot(n, triple(ray.direction)))
        return t if t > 0.0 and t_min <= t <= t_max else math.inf

    return plane_distance


def _on_plane(of: Convert) -> Function:
    triple, wide = _triple(of), _triple(to_double)

    @inlined
    def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        n = wide(triple(vector(surface.normal)))
        return (wide(add(triple(ray.origin), scale(of(t), triple(ray.direction)))), n, n)

    return interaction


def _on_box(of: Convert) -> Function:
    triple, wide = _triple(of), _triple(to_double)

    @inlined
    def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        p = add(triple(ray.origin), scale(of(t), triple(ray.direction)))
        low, high = triple(vector(surface.a)), triple(vector(surface.b))
        nearest, n = math.inf, (0.0, 0.0, 0.0)
        for k in range(3):
            for side, plane in ((-1.0, low[k]), (1.0, high[k])):
                away = abs(p[k] - plane)
                if away < nearest:
                    nearest = away
                    n = (side if k == 0 else 0.0, side if k == 1 else 0.0, side if k == 2 else 0.0)
        return (wide(p), n, n)

    return interaction


def _mirrored(of: Convert) -> Function:
    triple, wide = _triple(of), _triple(to_double)

    @inlined
    def mirrored(v: Vector, n: Vector) -> Vector:
        a, b = triple(v), triple(n)
        return wide(triple(unit(subtract(a, scale(of(2.0) * dot(b, a), b)))))

    return mirrored


def _sine(of: Convert) -> Function:
    triple = _triple(of)

    @inlined
    def sine(v: Vector, n: Vector) -> float:
        c1 = dot(triple(v), triple(n))
        return np.float64(of(math.sqrt(max(of(0.0), of(1.0) - c1 * c1))))

    return sine


# What has no formula of its own in single precision is computed in double, and rounded.


def _rounded_intersect(own: Function) -> Function:
    @inlined
    def rounded(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
        t = np.float64(np.float32(own(world, surface, ray, t_min, t_max, exact)))
        return t if t >= t_min else math.inf  # rounding must not put a hit before the last one

    return rounded


def _rounded_next_hit(own: Function) -> Function:
    @inlined
    def rounded(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
        return np.float64(np.float32(own(world, surface, ray)))

    return rounded


def _rounded_interaction(own: Function) -> Function:
    narrow, wide = _triple(to_single), _triple(to_double)

    @inlined
    def rounded(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        p, n, shading_n = own(world, surface, ray, t)
        return (wide(narrow(p)), wide(narrow(n)), wide(narrow(shading_n)))

    return rounded


def _rounded_vector(own: Function) -> Function:
    narrow, wide = _triple(to_single), _triple(to_double)

    @inlined
    def rounded(*arguments: Any) -> Vector:
        return wide(narrow(own(*arguments)))

    return rounded

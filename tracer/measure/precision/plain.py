"""The textbook's formulas in this program's kernel: what the stable ones are measured against.

The quadratic by (-b -+ sqrt(b^2 - ac)) / a, planes by one division, the hit where the ray says, of a box the nearest
face, directions by a root and three divisions; in double precision, or in single: then lengths, places and directions
have 24 bits, and what has no formula here is worked out in double and rounded. No smallest distance: that a ray does
not meet the surface it leaves is known as ever. A process that does this does nothing else: see `otherkernel`.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from tracer import shapes
from tracer.compile.jit import inlined
from tracer.formulas import camera
from tracer.formulas.vector import Vector, add, dot, scale, subtract, unit, vector
from tracer.kernel import closest_hit, entry, interface, scatter, trace
from tracer.rays import Ray
from tracer.shapes import box, planar, polygon, sphere, triangle
from tracer.shapes import plane as plane_shape
from tracer.tree import error_propagation

KINDS = ("double", "single")
FLAT = (plane_shape, polygon, triangle)


@inlined
def double_of(x: float) -> Any:
    return np.float64(x)


@inlined
def single_of(x: float) -> Any:
    return np.float32(x)


def use(kind: str) -> None:
    """Put these formulas where kernels will look them up; nothing must be compiled yet."""
    of = {"double": double_of, "single": single_of}[kind]
    sphere.intersect, sphere.interaction = _sphere(of), _on_sphere(of)
    distance = _plane(of)
    for flat in FLAT:
        vars(flat)["plane_distance"] = distance
    plane_shape.interaction = polygon.interaction = planar.interaction = _on_plane(of)
    box.interaction = _on_box(of)
    scatter.mirrored = trace.mirrored = _mirrored(of)
    scatter.sine = trace.sine = _sine(of)
    if kind == "single":
        _round_the_rest()
    closest_hit.intersect = shapes._fold("intersect", shapes._no_intersect, shapes._link_intersect)
    closest_hit.next_hit = shapes._fold("next_hit", shapes._no_next_hit, shapes._link_next_hit)
    interface.interaction = trace.interaction = error_propagation.interaction = shapes._fold(
        "interaction", shapes._no_interaction, shapes._link_interaction
    )


def _sphere(of: Callable[[float], Any]) -> Callable[..., float]:
    triple = _triple(of)

    @inlined
    def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
        d, r = triple(ray.direction), of(surface.r)
        f = subtract(triple(ray.origin), triple(vector(surface.a)))
        a, b, c = dot(d, d), dot(f, d), dot(f, f) - r * r
        discriminant = b * b - a * c
        if discriminant < 0.0:
            return math.inf
        root = of(math.sqrt(discriminant))
        near, far = np.float64((-b - root) / a), np.float64((-b + root) / a)
        if near > 0.0 and near >= floor:
            return near
        return far if far > 0.0 and far >= floor else math.inf

    return intersect


def _on_sphere(of: Callable[[float], Any]) -> Callable[..., tuple[Vector, Vector, Vector]]:
    triple, wide = _triple(of), _triple(double_of)

    @inlined
    def locate(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        p = add(triple(ray.origin), scale(of(t), triple(ray.direction)))
        n = scale(of(1.0) / of(surface.r), subtract(p, triple(vector(surface.a))))
        return (wide(p), wide(n), wide(n))

    return locate


def _plane(of: Callable[[float], Any]) -> Callable[..., float]:
    triple = _triple(of)

    @inlined
    def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
        n = triple(vector(surface.normal))
        t = np.float64(dot(n, subtract(triple(vector(surface.a)), triple(ray.origin))) / dot(n, triple(ray.direction)))
        return t if t > 0.0 and floor <= t <= ceiling else math.inf

    return intersect


def _on_plane(of: Callable[[float], Any]) -> Callable[..., tuple[Vector, Vector, Vector]]:
    triple, wide = _triple(of), _triple(double_of)

    @inlined
    def locate(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        n = wide(triple(vector(surface.normal)))
        return (wide(add(triple(ray.origin), scale(of(t), triple(ray.direction)))), n, n)

    return locate


def _on_box(of: Callable[[float], Any]) -> Callable[..., tuple[Vector, Vector, Vector]]:
    triple, wide = _triple(of), _triple(double_of)

    @inlined
    def locate(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
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

    return locate


def _mirrored(of: Callable[[float], Any]) -> Callable[[Vector, Vector], Vector]:
    triple, wide = _triple(of), _triple(double_of)

    @inlined
    def mirrored(v: Vector, n: Vector) -> Vector:
        a, b = triple(v), triple(n)
        return wide(triple(unit(subtract(a, scale(of(2.0) * dot(b, a), b)))))

    return mirrored


def _sine(of: Callable[[float], Any]) -> Callable[[Vector, Vector], float]:
    triple = _triple(of)

    @inlined
    def sine(v: Vector, n: Vector) -> float:
        c1 = dot(triple(v), triple(n))
        return np.float64(of(math.sqrt(max(of(0.0), of(1.0) - c1 * c1))))

    return sine


def _triple(of: Callable[[float], Any]) -> Callable[[Any], Any]:
    @inlined
    def triple(a: Any) -> Any:
        return (of(a[0]), of(a[1]), of(a[2]))

    return triple


def _round_the_rest() -> None:
    """Whatever is left in double precision gives numbers of single precision."""
    for shape in shapes.SHAPES:
        own: Any = shape
        own.intersect, own.next_hit = _rounded(own.intersect), _rounded_again(own.next_hit)
        own.interaction = _rounded_place(own.interaction)
    # `look_ahead` asks the camera's, too.
    camera.pixel_direction = entry.pixel_direction = _rounded_direction(camera.pixel_direction)  # type: ignore[attr-defined]
    scatter.transmission = trace.transmission = _rounded_way(scatter.transmission)


def _rounded(intersect: Any) -> Any:
    @inlined
    def rounded(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
        t = np.float64(np.float32(intersect(world, surface, ray, floor, ceiling, exactly)))
        return t if t >= floor else math.inf  # what has been met is not met again

    return rounded


def _rounded_again(again: Any) -> Any:
    @inlined
    def rounded(world: Any, surface: Any, ray: Ray) -> float:
        return np.float64(np.float32(again(world, surface, ray)))

    return rounded


def _rounded_place(locate: Any) -> Any:
    narrow, wide = _triple(single_of), _triple(double_of)

    @inlined
    def rounded(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
        p, n, shading_n = locate(world, surface, ray, t)
        return (wide(narrow(p)), wide(narrow(n)), wide(narrow(shading_n)))

    return rounded


def _rounded_direction(direction: Any) -> Any:
    narrow, wide = _triple(single_of), _triple(double_of)

    @inlined
    def rounded(view: Any, x: float, y: float) -> Vector:
        return wide(narrow(direction(view, x, y)))

    return rounded


def _rounded_way(transmission: Any) -> Any:
    narrow, wide = _triple(single_of), _triple(double_of)

    @inlined
    def rounded(v: Vector, n: Vector, n1: float, n2: float, c1: float, c2: float) -> Vector:
        return wide(narrow(transmission(v, n, n1, n2, c1, c2)))

    return rounded

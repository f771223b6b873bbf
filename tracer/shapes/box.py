"""Box: all p with low <= p <= high, its faces parallel to the axes. Packed as a = low, b = high.

The slab test (Kay & Kajiya, SIGGRAPH 1986): the ray is inside between the last of the three planes at which it enters a
slab and the first at which it leaves one. A direction that is 0 along an axis never crosses that slab's planes: there
the ray's origin decides.
"""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector, add, scale
from tracer.rays import Ray
from tracer.shapes import planar
from tracer.shapes.polygon import Polygon
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import flat


@dataclass(frozen=True, slots=True)
class Box(Shape):
    name: ClassVar[str] = "box"
    curved: ClassVar[bool] = False

    min: Vector = field(metadata=fields.point())
    max: Vector = field(metadata=fields.point())

    @classmethod
    def example(cls) -> "Box":
        return cls((-1.0, -0.5, -0.75), (1.0, 0.5, 0.75))

    def pack(self, rows: np.ndarray) -> None:
        rows["a"] = self.min
        rows["b"] = self.max

    def bounds(self) -> np.ndarray:
        return np.array([self.min, self.max])[None]

    def is_closed(self) -> bool:
        return True

    def contains(self, p: np.ndarray) -> bool:
        return bool(np.all(np.less(self.min, p)) and np.all(np.less(p, self.max)))

    def faults(self) -> list[str]:
        if all(low < high for low, high in zip(self.min, self.max, strict=True)):
            return []
        return [f"max must be above min along each axis, got min {list(self.min)} and max {list(self.max)}"]

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        low, high = np.array(self.min), np.array(self.max)
        faces = []
        for axis in range(3):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            for side, end in ((1.0, high), (-1.0, low)):
                at = np.where(np.arange(3) == axis, end, low)
                p, q = u * (high - low), v * (high - low)
                square = [at, at + p, at + p + q, at + q][:: int(side)]
                faces += [[square[0], square[1], square[2]], [square[0], square[2], square[3]]]
        return flat(np.array(faces))

    def faces(self) -> list[tuple[Shape, ...]]:
        """Its six sides."""
        low, high = np.array(self.min), np.array(self.max)
        found: list[tuple[Shape, ...]] = []
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for end in (low, high):
                corners = np.tile(end, (4, 1))
                corners[:, u] = (low[u], high[u], high[u], low[u])
                corners[:, v] = (low[v], low[v], high[v], high[v])
                found.append((Polygon(tuple(tuple(corner) for corner in corners.tolist())),))
        return found


@inlined
def slab_interval(surface: SurfaceRow, ray: Ray) -> tuple[float, float]:
    """The distances at which the ray enters and leaves. It misses where the first is larger.

    Each is computed by one division, like the distance to a plane: where a box stands on a plane, both are met at the
    same t.
    """
    enter, leave = -math.inf, math.inf
    for k in range(3):
        if ray.direction[k] == 0.0:
            if not surface.a[k] <= ray.origin[k] <= surface.b[k]:
                return (math.inf, -math.inf)
        else:
            low = (surface.a[k] - ray.origin[k]) / ray.direction[k]
            high = (surface.b[k] - ray.origin[k]) / ray.direction[k]
            enter = max(enter, min(low, high))
            leave = min(leave, max(low, high))
    return (enter, leave)


@inlined
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The distance at which the ray enters the box or, from inside, leaves it."""
    enter, leave = slab_interval(surface, ray)
    if enter > leave:
        return math.inf
    if enter > 0.0 and enter >= t_min:
        return enter
    if leave > 0.0 and leave >= t_min:
        return leave
    return math.inf


@inlined
def next_hit(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """A ray that starts on the box and goes inwards meets it once more, where it leaves."""
    _, leave = slab_interval(surface, ray)
    return leave if ray.side < 0.0 and leave > 0.0 else math.inf


@inlined
def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit point, exactly on the face whose plane is crossed at t, and that face's normal twice."""
    enter, _ = slab_interval(surface, ray)
    entering = enter == t
    p = add(ray.origin, scale(t, ray.direction))
    for k in range(3):
        if ray.direction[k] != 0.0:
            at_low = (ray.direction[k] > 0.0) == entering
            plane = surface.a[k] if at_low else surface.b[k]
            if (plane - ray.origin[k]) / ray.direction[k] == t:
                n = -1.0 if at_low else 1.0
                if k == 0:
                    return ((plane, p[1], p[2]), (n, 0.0, 0.0), (n, 0.0, 0.0))
                if k == 1:
                    return ((p[0], plane, p[2]), (0.0, n, 0.0), (0.0, n, 0.0))
                return ((p[0], p[1], plane), (0.0, 0.0, n), (0.0, 0.0, n))
    return (p, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


normal_derivative = planar.constant_normal

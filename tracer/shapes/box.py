"""Box: all p with low <= p <= high, its faces along the axes. Packed as a = low, b = high.

The ray is inside between the last of the three planes it enters by and the first it leaves by (Kay & Kajiya, SIGGRAPH
1986). A direction of 0 along an axis never crosses that pair of planes: it is decided by where the ray starts.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector, add, scale
from tracer.rays import Ray
from tracer.shapes import planar

NAME = "box"


@dataclass(frozen=True, slots=True)
class Box:
    min: Vector = field(metadata=fields.point())
    max: Vector = field(metadata=fields.point())

    def pack(self, rows: Any) -> None:
        rows["a"] = self.min
        rows["b"] = self.max

    def bounds(self) -> np.ndarray:
        return np.array([self.min, self.max])[None]

    def contains(self, p: np.ndarray) -> bool:
        return bool(np.all(np.less(self.min, p)) and np.all(np.less(p, self.max)))

    def faults(self) -> list[str]:
        if all(low < high for low, high in zip(self.min, self.max, strict=True)):
            return []
        return [f"max must be above min along each axis, got min {list(self.min)} and max {list(self.max)}"]


@inlined
def slab_interval(surface: Any, ray: Ray) -> tuple[float, float]:
    """The distances at which the ray enters and leaves; entering is after leaving where it misses.

    Both are worked out as a plane's are, by one division: a box that stands on a plane meets the ray where that does.
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
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    enter, leave = slab_interval(surface, ray)
    if enter > leave:
        return math.inf
    if enter > 0.0 and enter >= floor:
        return enter
    if leave > 0.0 and leave >= floor:
        return leave
    return math.inf


@inlined
def next_hit(world: Any, surface: Any, ray: Ray) -> float:
    """From its own surface a ray meets the box once more if it goes inwards: where it leaves."""
    _, leave = slab_interval(surface, ray)
    return leave if ray.side < 0.0 and leave > 0.0 else math.inf


@inlined
def interaction(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit, put exactly on the face whose plane is crossed at t."""
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

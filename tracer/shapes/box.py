"""Box: all p with low <= p <= high, its faces parallel to the axes. Packed as a = low, b = high, r = the largest
coordinate of both.

The slab test (Kay & Kajiya, SIGGRAPH 1986): the ray is inside between the last of the three planes at which it enters a
slab and the first at which it leaves one. A direction that is 0 along an axis never crosses that slab's planes: there
the ray's origin decides.
"""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.intrinsics import noinline, vector_at
from tracer.compile.jit import compiled, inlined
from tracer.formulas.exact import Exact, exact
from tracer.formulas.vector import Vector, add, scale
from tracer.rays import APPROACH, BEFORE, Ray
from tracer.shapes import planar
from tracer.shapes.outline import PLANE_ERROR
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
        rows["r"] = max(map(abs, (*self.min, *self.max)))

    def bounds(self) -> np.ndarray:
        return np.array([self.min, self.max])[None]

    def is_closed(self) -> bool:
        return True

    def contains(self, p: np.ndarray) -> bool:
        return bool(np.all(np.less(self.min, p)) and np.all(np.less(p, self.max)))

    def contains_each(self, points: np.ndarray) -> np.ndarray:
        return np.logical_and((points > self.min).all(axis=1), (points < self.max).all(axis=1))

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        return np.any((points == self.min) | (points == self.max), axis=1, keepdims=True)[:, 0]

    def touches(self, p: Exact, row: int) -> bool:
        low, high = exact(self.min), exact(self.max)
        between = all(low[k] <= p[k] <= high[k] for k in range(3))
        return between and any(p[k] in (low[k], high[k]) for k in range(3))

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
def may_start_on(surface: SurfaceRow, ray: Ray) -> bool:
    """Whether the ray may start on the box, by rounding, or runs in the plane of a face.

    A ray that starts in the plane of a face beside the box crosses the planes of other faces first, or misses.
    """
    d = ray.direction
    outside = -math.inf
    for k in range(3):
        outside = max(outside, max(surface.a[k] - ray.origin[k], ray.origin[k] - surface.b[k]))
    parallel = d[0] == 0.0 or d[1] == 0.0 or d[2] == 0.0
    return parallel or abs(outside) <= PLANE_ERROR * (surface.r + ray.magnitude)


@inlined
def interval(surface: SurfaceRow, ray: Ray) -> tuple[float, float]:
    """As `slab_interval`, for a ray that may start on another surface, one that touches the box."""
    enter, leave = slab_interval(surface, ray)
    if ray.start >= 0:
        steepest = max(abs(ray.inverse[0]), max(abs(ray.inverse[1]), abs(ray.inverse[2])))
        reach = steepest * PLANE_ERROR * (surface.r + ray.magnitude)
        if enter <= reach and leave >= -reach:  # else it starts off the box
            return start_interval(surface, ray, enter, leave)
    return (enter, leave)


@compiled
def start_interval(surface: SurfaceRow, ray: Ray, enter: float, leave: float) -> tuple[float, float]:
    """As `interval`, where the ray may start on the box; `enter` and `leave` are the `slab_interval`."""
    noinline()
    if may_start_on(surface, ray) and is_in_contact(surface, ray):
        return contact_interval(surface, ray)
    return (enter, leave)


@inlined
def exit_distance(surface: SurfaceRow, ray: Ray) -> float:
    """The distance at which a ray leaves the box, on which it starts, and into which it goes. On an edge it is 0: the
    origin may be beside the face by rounding.
    """
    leave = math.inf
    for k in range(3):
        if ray.direction[k] != 0.0:
            face = surface.b[k] if ray.direction[k] > 0.0 else surface.a[k]
            leave = min(leave, (face - ray.origin[k]) / ray.direction[k])
    return max(leave, 0.0) + 0.0  # not -0


@inlined
def touches(face: float, ray: Ray, k: int) -> bool:
    """Whether rounding can tell the origin from the plane of a face across axis k."""
    return abs(face - ray.origin[k]) <= PLANE_ERROR * (abs(face) + ray.magnitude)


@inlined
def is_in_contact(surface: SurfaceRow, ray: Ray) -> bool:
    """Whether the ray starts in the plane of a face."""
    found = False
    for k in range(3):
        found = found or touches(surface.a[k], ray, k) or touches(surface.b[k], ray, k)
    return found


@inlined
def way_along(surface: SurfaceRow, ray: Ray, k: int) -> float:
    """The last way along axis k by which the ray's origin was reached; 0 if rounding cannot tell."""
    error = PLANE_ERROR * (max(abs(surface.a[k]), abs(surface.b[k])) + ray.magnitude)
    approach, before = vector_at(ray.history, APPROACH)[k], vector_at(ray.history, BEFORE)[k]
    if abs(approach) > error:
        return approach
    return before if abs(before) > error else 0.0


@inlined
def contact_interval(surface: SurfaceRow, ray: Ray) -> tuple[float, float]:
    """`slab_interval` for a ray that starts in the plane of a face, on another surface.

    The sign of the distance to that plane is only rounding. The ray crosses it at its start, unless it turns back: the
    direction in which its origin was reached tells from which side it comes. A ray that would both enter and leave
    here leaves.

    A ray that is in a set of solids crosses the face of a solid also if it turns back: whatever the set has been, the
    crossing puts it right.
    """
    enter, leave = -math.inf, math.inf
    settles = ray.settles and surface.solid >= 0
    outside = entered_here = left_here = False
    for k in range(3):
        o, d, came = ray.origin[k], ray.direction[k], way_along(surface, ray, k)
        if d == 0.0:
            low, high = touches(surface.a[k], ray, k), touches(surface.b[k], ray, k)
            from_outside = not settles and ((came > 0.0 and low) or (came < 0.0 and high))
            if from_outside or not (low or high or surface.a[k] <= o <= surface.b[k]):
                return (math.inf, -math.inf)
            continue
        near, far = (surface.a[k], surface.b[k]) if d > 0.0 else (surface.b[k], surface.a[k])
        turns_back = (came > 0.0 and d < 0.0) or (came < 0.0 and d > 0.0)
        first, last = (near - o) / d, (far - o) / d
        enters_here, leaves_here = touches(near, ray, k), touches(far, ray, k)
        if enters_here:
            first = -math.inf if turns_back and not settles else max(first, 0.0)
        if leaves_here:
            outside = outside or (turns_back and not settles)
            last = max(last, 0.0)
        if first > enter:
            enter, entered_here = first, enters_here
        if last < leave:
            leave, left_here = last, leaves_here
    if outside:
        return (math.inf, -math.inf)
    if enter == leave or (enter > leave and entered_here and left_here):
        enter = -math.inf
    return (enter + 0.0, leave + 0.0)


@inlined
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The distance at which the ray enters the box or, from inside, leaves it.

    A ray that only touches an edge hits the box, but enters no solid.
    """
    enter, leave = interval(surface, ray)
    if enter > leave or (enter == leave and surface.solid >= 0):
        return math.inf
    if enter >= 0.0 and enter >= t_min and (enter < leave or enter > 0.0):
        return enter
    if leave >= t_min and (leave > 0.0 or ray.start >= 0):
        return leave
    return math.inf


@inlined
def next_hit(world: ShapeArrays, surface: SurfaceRow, ray: Ray) -> float:
    """A ray that starts on the box and goes inwards meets it once more, where it leaves."""
    return exit_distance(surface, ray) if ray.side < 0.0 else math.inf


@inlined
def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit point, exactly on the face whose plane is crossed at t, and that face's normal twice."""
    entering = False
    if ray.start != surface.coincident:
        enter, leave = interval(surface, ray)
        entering = enter == t and not t == leave == 0.0
    p = add(ray.origin, scale(t, ray.direction))
    for k in range(3):
        if ray.direction[k] != 0.0:
            at_low = (ray.direction[k] > 0.0) == entering
            plane = surface.a[k] if at_low else surface.b[k]
            if (plane - ray.origin[k]) / ray.direction[k] == t or (t == 0.0 and touches(plane, ray, k)):
                n = -1.0 if at_low else 1.0
                if k == 0:
                    return ((plane, p[1], p[2]), (n, 0.0, 0.0), (n, 0.0, 0.0))
                if k == 1:
                    return ((p[0], plane, p[2]), (0.0, n, 0.0), (0.0, n, 0.0))
                return ((p[0], p[1], plane), (0.0, 0.0, n), (0.0, 0.0, n))
    return (p, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


normal_derivative = planar.constant_normal

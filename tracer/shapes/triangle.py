"""Triangle: three corners, counter-clockwise seen from outside. Meshes are made of them.

Packed as in `planar`, with its corners as a, b, c; `smooth` is its index into `world.smooth` (three vertex normals), -1
for none. The inside test is Woop's (JCGT 2(1), 2013): the ray passes on the same side of all three edges. The distance
comes from the plane, since the sheared coordinates would lose digits on large triangles.
"""

import math
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.compile.simd import broadcast, lanes_max, lanes_min, load_lanes, mask_less
from tracer.formulas.double_double import dd_cross, exact_difference
from tracer.formulas.exact import Exact, exact, is_in_outline
from tracer.formulas.vector import (
    LONGEST,
    SHORTEST,
    Vector,
    add,
    as_floats,
    cross,
    dot,
    length,
    near_one,
    scale,
    subtract,
    unit,
    vector,
)
from tracer.rays import Ray, sheared
from tracer.shapes import planar
from tracer.shapes.outline import PLANE_ERROR, is_beside_outline
from tracer.shapes.planar import may_cross, outline_slack, pack_normal, unit_normal
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import BlockRow, ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import flat


@dataclass(frozen=True, slots=True)
class Triangle(Shape):
    name: ClassVar[str] = "triangle"
    curved: ClassVar[bool] = False

    vertices: tuple[Vector, ...] = field(metadata=fields.points(exactly=3))

    @classmethod
    def example(cls) -> "Triangle":
        return cls(((-1.0, -0.5, 0.0), (1.0, -0.5, 0.25), (0.0, 1.0, 0.0)))

    def pack(self, rows: np.ndarray) -> None:
        pack_triangles(rows, np.array(self.vertices)[None])

    def bounds(self) -> np.ndarray:
        return np.stack([np.min(self.vertices, axis=0), np.max(self.vertices, axis=0)])[None]

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        return planar.may_lie_in_plane(points, self.vertices[0], as_floats(unit_normal(np.array(self.vertices, float))))

    def touches(self, p: Exact, row: int) -> bool:
        return is_in_outline(p, [exact(corner) for corner in self.vertices])

    def plane(self) -> tuple[Vector, Vector]:
        x, y, z = unit_normal(np.array(self.vertices, float)).tolist()
        return self.vertices[0], (x, y, z)

    def faults(self) -> list[str]:
        if unit_normal(np.array(self.vertices, float)).any():
            return []
        return ["vertices must enclose an area, got corners on one line"]

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        return flat(np.array(self.vertices)[None])


def pack_triangles(rows: np.ndarray, corners: np.ndarray) -> None:
    """Fill one row for each of the triangles (n, 3, 3), all of which must have an area."""
    rows["a"], rows["b"], rows["c"] = corners[:, 0], corners[:, 1], corners[:, 2]
    a, b, c = (tuple(corners[:, k].T) for k in range(3))
    pack_normal(rows, dd_cross(exact_difference(b, a), exact_difference(c, a)))
    rows["r"] = np.abs(corners[:, 0]).sum(axis=1)
    rows["count"] = 3


@inlined
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The distance to the plane if the ray passes on the same side of all three edges, else inf."""
    if not may_cross(surface, ray, t_max):
        return math.inf
    ax, ay = sheared(ray, surface.a)
    bx, by = sheared(ray, surface.b)
    cx, cy = sheared(ray, surface.c)
    u = cx * by - cy * bx
    v = ax * cy - ay * cx
    w = bx * ay - by * ax
    if (u < 0.0 or v < 0.0 or w < 0.0) and (u > 0.0 or v > 0.0 or w > 0.0):
        slack = outline_slack(world, surface, ray)
        if slack == 0.0 or not is_beside_outline(world, surface, ray, slack):
            return math.inf
    return world.formulas.plane_distance(world, surface, ray, t_min, t_max, exact)


@inlined
def candidate_mask(block: BlockRow, ray: Ray, inverse_unit: float) -> int:
    """Bit mask of the triangles of a BVH block (`tracer.accel.bvh`) that the ray may hit: eight are tested at once.

    Contains every triangle that `intersect` finds: the slack covers the rounding of the block's corners to float32, and
    `outline_slack`.
    """
    anchor, o = block.anchor, scale(inverse_unit, ray.permuted_origin)
    origin = (o[0] - anchor[ray.axis], o[1] - anchor[ray.across], o[2] - anchor[ray.up])
    ax, ay = sheared_lanes(ray, origin, block.corners, 0)
    bx, by = sheared_lanes(ray, origin, block.corners, 3)
    cx, cy = sheared_lanes(ray, origin, block.corners, 6)
    u = cx * by - cy * bx
    v = ax * cy - ay * cx
    w = bx * ay - by * ax
    slack = (block.rounding + 16.0 * PLANE_ERROR * (block.reach + inverse_unit * ray.magnitude)) * block.edge
    least, most = lanes_min(u, lanes_min(v, w)), lanes_max(u, lanes_max(v, w))
    return block.lanes & ~(mask_less(least, broadcast(-slack)) & mask_less(broadcast(slack), most))


@inlined
def sheared_lanes(ray: Ray, origin: Vector, corners: Any, first: int) -> tuple[Any, Any]:
    """`sheared` of eight points, whose x, y and z are the rows `first`, `first` + 1 and `first` + 2 of `corners`."""
    along = load_lanes(corners[first + ray.axis]) - origin[0]
    across = load_lanes(corners[first + ray.across]) - origin[1]
    up = load_lanes(corners[first + ray.up]) - origin[2]
    return (across - along * ray.shear[0], up - along * ray.shear[1])


next_hit = planar.no_next_hit


@inlined
def interaction(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit point, the face's normal, and the interpolated normal where the mesh has vertex normals."""
    p, n, _ = planar.interaction(world, surface, ray, t)
    if surface.smooth < 0:
        return (p, n, n)
    mixed = interpolated_normal(world, surface, p)
    if not dot(mixed, n) > 0.0:
        return (p, n, n)
    if SHORTEST < length(mixed) < LONGEST:
        return (p, n, unit(mixed))
    return (p, n, unit(near_one(mixed)[0]))


@inlined
def length_scale(surface: SurfaceRow) -> float:
    """The power of two by which lengths are multiplied, so that products of them neither overflow nor underflow."""
    a, b, c = vector(surface.a), vector(surface.b), vector(surface.c)
    ab, ac = subtract(b, a), subtract(c, a)
    size = max(max(abs(ab[0]), abs(ab[1])), max(abs(ab[2]), max(abs(ac[0]), max(abs(ac[1]), abs(ac[2])))))
    if 1e-70 < size < 1e70:
        return 1.0
    _, exponent = math.frexp(size)
    return math.ldexp(1.0, -exponent)


@inlined
def interpolated_normal(world: ShapeArrays, surface: SurfaceRow, p: Vector) -> Vector:
    """The vertex normals weighted by p's barycentric coordinates; of any length."""
    n, a, b, c = vector(surface.normal), vector(surface.a), vector(surface.b), vector(surface.c)
    f = length_scale(surface)
    pa, pb, pc = scale(f, subtract(a, p)), scale(f, subtract(b, p)), scale(f, subtract(c, p))
    u, v, w = dot(cross(pb, pc), n), dot(cross(pc, pa), n), dot(cross(pa, pb), n)
    corners = world.smooth[surface.smooth]
    return add(add(scale(u, vector(corners[0])), scale(v, vector(corners[1]))), scale(w, vector(corners[2])))


@inlined
def normal_derivative(world: ShapeArrays, surface: SurfaceRow, p: Vector, v: Vector) -> Vector:
    """The derivative of the interpolated normal, linear in p, without the part that only changes its length."""
    if surface.smooth < 0:
        return (0.0, 0.0, 0.0)
    mixed = interpolated_normal(world, surface, p)
    size = length(mixed)
    if size == 0.0:
        return (0.0, 0.0, 0.0)
    f = length_scale(surface)
    a, b, c = scale(f, vector(surface.a)), scale(f, vector(surface.b)), scale(f, vector(surface.c))
    n, corners, v = vector(surface.normal), world.smooth[surface.smooth], scale(f, v)
    u, w = dot(cross(subtract(c, b), v), n), dot(cross(subtract(b, a), v), n)
    change = scale(u, vector(corners[0]))
    change = add(change, scale(dot(cross(subtract(a, c), v), n), vector(corners[1])))
    change = add(change, scale(w, vector(corners[2])))
    along = scale(1.0 / size, mixed)
    return scale(1.0 / size, subtract(change, scale(dot(change, along), along)))

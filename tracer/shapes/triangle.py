"""Triangle: three corners, counter-clockwise seen from outside; also the piece meshes are made of.

Packed as a, b, c, normal; `smooth` is its row in world.smooth (three vertex normals), -1 for a flat one. The inside
test is Woop's (JCGT 2(1), 2013): the ray passes on the same side of all three edges. The distance comes from the
plane: through the sheared coordinates it would lose digits on large flat triangles.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.compile.simd import broadcast, lanes_max, lanes_min, load_lanes, mask_less
from tracer.formulas.double_double import dd_cross, exact_difference
from tracer.formulas.vector import Vector, add, cross, dot, length, scale, subtract, unit, vector
from tracer.rays import Ray, sheared
from tracer.shapes import planar
from tracer.shapes.planar import (
    PLANE_ERROR,
    is_near_edge,
    may_cross,
    outline_slack,
    pack_normal,
    plane_distance,
    unit_normal,
)

NAME = "triangle"


@dataclass(frozen=True, slots=True)
class Triangle:
    vertices: tuple[Vector, ...] = field(metadata=fields.points(exactly=3))

    def pack(self, rows: Any) -> None:
        pack_triangles(rows, np.array(self.vertices)[None])

    def bounds(self) -> np.ndarray:
        return np.stack([np.min(self.vertices, axis=0), np.max(self.vertices, axis=0)])[None]

    def contains(self, p: np.ndarray) -> bool:
        return False

    def faults(self) -> list[str]:
        if unit_normal(np.array(self.vertices, float)).any():
            return []
        return ["vertices must enclose an area, got corners on one line"]


def pack_triangles(rows: Any, corners: np.ndarray) -> None:
    """Fill one row a triangle from corners (n, 3, 3); none may be without area."""
    rows["a"], rows["b"], rows["c"] = corners[:, 0], corners[:, 1], corners[:, 2]
    a, b, c = (tuple(corners[:, k].T) for k in range(3))
    pack_normal(rows, dd_cross(exact_difference(b, a), exact_difference(c, a)))
    rows["r"] = np.abs(corners[:, 0]).sum(axis=1)
    rows["count"] = 3


@inlined
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    if not may_cross(surface, ray, ceiling):
        return math.inf
    ax, ay = sheared(ray, surface.a)
    bx, by = sheared(ray, surface.b)
    cx, cy = sheared(ray, surface.c)
    u = cx * by - cy * bx
    v = ax * cy - ay * cx
    w = bx * ay - by * ax
    if (u < 0.0 or v < 0.0 or w < 0.0) and (u > 0.0 or v > 0.0 or w > 0.0):
        slack = outline_slack(surface, ray)
        beside = slack > 0.0 and (
            is_near_edge(ax, ay, bx, by, slack)
            or is_near_edge(bx, by, cx, cy, slack)
            or is_near_edge(cx, cy, ax, ay, slack)
        )
        if not beside:
            return math.inf
    return plane_distance(world, surface, ray, floor, ceiling, exactly)


@inlined
def candidate_mask(block: Any, ray: Ray, inverse_unit: float) -> int:
    """Which of a block's triangles (see `bvh`) the ray may pass inside of, bit by bit: the same sums, eight at once.

    None is dropped that `intersect` would find: the slack is that of corners rounded off, and of `outline_slack`.
    """
    anchor, o = block.anchor, scale(inverse_unit, ray.turned)
    origin = (o[0] - anchor[ray.axis], o[1] - anchor[ray.across], o[2] - anchor[ray.up])
    ax, ay = sheared_lanes(ray, origin, block.corners, 0)
    bx, by = sheared_lanes(ray, origin, block.corners, 3)
    cx, cy = sheared_lanes(ray, origin, block.corners, 6)
    u = cx * by - cy * bx
    v = ax * cy - ay * cx
    w = bx * ay - by * ax
    slack = (block.doubt + 16.0 * PLANE_ERROR * (block.reach + inverse_unit * ray.reach)) * block.edge
    least, most = lanes_min(u, lanes_min(v, w)), lanes_max(u, lanes_max(v, w))
    return block.lanes & ~(mask_less(least, broadcast(-slack)) & mask_less(broadcast(slack), most))


@inlined
def sheared_lanes(ray: Ray, origin: Vector, corners: Any, first: int) -> tuple[Any, Any]:
    """`sheared` of eight points whose coordinates stand from row `first` on."""
    along = load_lanes(corners[first + ray.axis]) - origin[0]
    across = load_lanes(corners[first + ray.across]) - origin[1]
    up = load_lanes(corners[first + ray.up]) - origin[2]
    return (across - along * ray.shear[0], up - along * ray.shear[1])


next_hit = planar.no_next_hit


@inlined
def interaction(world: Any, surface: Any, ray: Ray, t: float) -> tuple[Vector, Vector, Vector]:
    """The hit, the face's normal, and the normal interpolated between the corners where the mesh has them."""
    p, n, _ = planar.interaction(world, surface, ray, t)
    if surface.smooth < 0:
        return (p, n, n)
    mixed = interpolated_normal(world, surface, p)
    if dot(mixed, n) > 0.0:
        return (p, n, unit(mixed))
    return (p, n, n)


@inlined
def interpolated_normal(world: Any, surface: Any, p: Vector) -> Vector:
    """The corners' normals, each weighed as the triangle between p and the edge opposite to it; of any length."""
    n, a, b, c = vector(surface.normal), vector(surface.a), vector(surface.b), vector(surface.c)
    pa, pb, pc = subtract(a, p), subtract(b, p), subtract(c, p)
    u, v, w = dot(cross(pb, pc), n), dot(cross(pc, pa), n), dot(cross(pa, pb), n)
    corners = world.smooth[surface.smooth]
    return add(add(scale(u, vector(corners[0])), scale(v, vector(corners[1]))), scale(w, vector(corners[2])))


@inlined
def normal_derivative(world: Any, surface: Any, p: Vector, v: Vector) -> Vector:
    """The mixture is linear in p: how it changes with v, but for what only changes its length."""
    if surface.smooth < 0:
        return (0.0, 0.0, 0.0)
    mixed = interpolated_normal(world, surface, p)
    size = length(mixed)
    if size == 0.0:
        return (0.0, 0.0, 0.0)
    a, b, c = vector(surface.a), vector(surface.b), vector(surface.c)
    n, corners = vector(surface.normal), world.smooth[surface.smooth]
    u, w = dot(cross(subtract(c, b), v), n), dot(cross(subtract(b, a), v), n)
    change = scale(u, vector(corners[0]))
    change = add(change, scale(dot(cross(subtract(a, c), v), n), vector(corners[1])))
    change = add(change, scale(w, vector(corners[2])))
    along = scale(1.0 / size, mixed)
    return scale(1.0 / size, subtract(change, scale(dot(change, along), along)))

"""Polygon: a flat face with any number of corners, convex or not. Packed as a plane, its corners in world.corners.

Inside is where a line from the hit to infinity crosses the outline an odd number of times. The crossings are counted
in the ray's own sheared coordinates, in which an edge shared by two faces is the same two numbers for both.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.formulas.vector import Vector
from tracer.rays import Ray, sheared
from tracer.shapes import planar
from tracer.shapes.planar import (
    is_near_edge,
    may_cross,
    newell_normal,
    outline_slack,
    pack_normal,
    plane_distance,
    unit_normal,
)

NAME = "polygon"

FLATNESS = 1e-5  # of its size: how far a corner may lie off the polygon's plane (format 1)


@dataclass(frozen=True, slots=True)
class Polygon:
    vertices: tuple[Vector, ...] = field(metadata=fields.points(at_least=3))

    def pack(self, rows: Any) -> None:
        rows["a"] = self.vertices[0]
        pack_normal(rows, newell_normal(self.corners()))
        rows["r"] = np.abs(self.vertices[0]).sum()
        rows["count"] = len(self.vertices)

    def corners(self) -> np.ndarray:
        return np.array(self.vertices, float)

    def bounds(self) -> np.ndarray:
        return np.stack([np.min(self.vertices, axis=0), np.max(self.vertices, axis=0)])[None]

    def contains(self, p: np.ndarray) -> bool:
        return False

    def faults(self) -> list[str]:
        corners = self.corners()
        normal = unit_normal(corners)
        if not normal.any():
            return ["vertices must enclose an area, got corners on one line"]
        arms = corners - corners.mean(axis=0)
        size = np.linalg.norm(arms, axis=1).max()
        heights = np.abs(arms @ normal)
        if heights.max() > FLATNESS * size:
            worst = int(heights.argmax())
            return [
                f"vertices must lie in one plane (to {FLATNESS:g} of the polygon's size), "
                f"got vertices[{worst}] off it by {heights[worst] / size:.2g} of that size"
            ]
        return []


@inlined
def intersect(world: Any, surface: Any, ray: Ray, floor: float, ceiling: float, exactly: bool) -> float:
    if not may_cross(surface, ray, ceiling):
        return math.inf
    slack = outline_slack(surface, ray)
    inside = False
    x0, y0 = sheared(ray, world.corners[surface.first + surface.count - 1])
    for k in range(surface.count):
        x1, y1 = sheared(ray, world.corners[surface.first + k])
        if (y0 > 0.0) != (y1 > 0.0):
            # On which side of the ray the edge passes. Rounding never turns this sign over, it can only make it 0:
            # then the edge goes through the ray itself, and that counts as inside, for either neighbour.
            turn = x0 * y1 - x1 * y0
            if turn == 0.0:
                return plane_distance(world, surface, ray, floor, ceiling, exactly)
            if (turn > 0.0) == (y1 > y0):
                inside = not inside
        if slack > 0.0 and is_near_edge(x0, y0, x1, y1, slack):
            return plane_distance(world, surface, ray, floor, ceiling, exactly)
        x0, y0 = x1, y1
    return plane_distance(world, surface, ray, floor, ceiling, exactly) if inside else math.inf


next_hit = planar.no_next_hit
interaction = planar.interaction
normal_derivative = planar.constant_normal

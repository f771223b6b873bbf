"""Polygon: a flat face with any number of corners, convex or not.

Packed as in `planar`, with its corners in `world.corners` from `first` on.

A point is inside if a line from it to infinity crosses the outline an odd number of times. Crossings are counted in the
ray's sheared frame (`tracer.rays`), in which an edge that two faces share has the same coordinates for both.
"""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from tracer import fields
from tracer.compile.jit import inlined
from tracer.formulas.exact import Exact, exact, is_in_outline
from tracer.formulas.vector import Vector, as_floats, unit
from tracer.rays import Ray, sheared
from tracer.shapes import planar
from tracer.shapes.outline import is_beside_outline
from tracer.shapes.planar import may_cross, newell_normal, outline_slack, pack_normal, unit_normal
from tracer.shapes.shape import Shape
from tracer.shapes.surface_row import SURFACE, ShapeArrays, SurfaceRow
from tracer.shapes.tessellation import flat

FLATNESS = 1e-5  # largest distance of a corner from the polygon's plane, relative to the polygon's size (format 1)


@dataclass(frozen=True, slots=True)
class Polygon(Shape):
    name: ClassVar[str] = "polygon"
    curved: ClassVar[bool] = False
    checker_in_plane: ClassVar[bool] = True

    vertices: tuple[Vector, ...] = field(metadata=fields.points(at_least=3))

    @classmethod
    def example(cls) -> "Polygon":
        """An L."""
        corners = ((-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1))
        return cls(tuple((float(x), float(y), 0.0) for x, y in corners))

    def pack(self, rows: np.ndarray) -> None:
        rows["a"] = self.vertices[0]
        pack_normal(rows, newell_normal(self.outline()))
        rows["r"] = np.abs(self.vertices[0]).sum()
        rows["count"] = len(self.vertices)

    def bounds(self) -> np.ndarray:
        return np.stack([np.min(self.vertices, axis=0), np.max(self.vertices, axis=0)])[None]

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        return planar.may_lie_in_plane(points, self.vertices[0], as_floats(unit_normal(self.outline())))

    def touches(self, p: Exact, row: int) -> bool:
        return is_in_outline(p, [exact(corner) for corner in self.vertices])

    def outline(self) -> np.ndarray:
        return np.array(self.vertices, float)

    def plane(self) -> tuple[Vector, Vector]:
        """The normal is that of the packed row."""
        row = np.zeros(1, SURFACE)
        self.pack(row)
        return self.vertices[0], unit(row["normal"][0])

    def faults(self) -> list[str]:
        corners = self.outline()
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

    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """Triangulation by ear clipping in the polygon's plane."""
        import mapbox_earcut

        corners = self.outline()
        n = unit_normal(corners)
        u = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
        u /= np.linalg.norm(u)
        plane = np.stack([(corners - corners[0]) @ u, (corners - corners[0]) @ np.cross(n, u)], axis=1)
        plane /= np.abs(plane).max()  # scaled, since float64 coordinates may be out of the library's range
        cut = mapbox_earcut.triangulate_float64(plane, np.array([len(plane)], np.uint32)).reshape(-1, 3)
        if not len(cut):  # the polygon is so narrow that rounding has left no area
            cut = np.array([(0, k, k + 1) for k in range(1, len(corners) - 1)])
        found = corners[cut]
        turned = (np.cross(found[:, 1] - found[:, 0], found[:, 2] - found[:, 0]) @ n) < 0.0
        found[turned] = found[turned][:, ::-1]
        return flat(found)


@inlined
def intersect(world: ShapeArrays, surface: SurfaceRow, ray: Ray, t_min: float, t_max: float, exact: bool) -> float:
    """The distance to the plane if the ray crosses it inside the outline, else inf."""
    if not may_cross(surface, ray, t_max):
        return math.inf
    inside = False
    x0, y0 = sheared(ray, world.corners[surface.first + surface.count - 1])
    for k in range(surface.count):
        x1, y1 = sheared(ray, world.corners[surface.first + k])
        if (y0 > 0.0) != (y1 > 0.0):
            # The sign says on which side of the ray the edge passes. Rounding never flips it, but it can become 0. Then
            # the edge goes through the ray itself, which counts as inside, for both faces that share the edge.
            turn = x0 * y1 - x1 * y0
            if turn == 0.0:
                return world.formulas.plane_distance(world, surface, ray, t_min, t_max, exact)
            if (turn > 0.0) == (y1 > y0):
                inside = not inside
        x0, y0 = x1, y1
    if not inside:
        slack = outline_slack(world, surface, ray)
        if slack == 0.0 or not is_beside_outline(world, surface, ray, slack):
            return math.inf
    return world.formulas.plane_distance(world, surface, ray, t_min, t_max, exact)


next_hit = planar.no_next_hit
interaction = planar.interaction
normal_derivative = planar.constant_normal

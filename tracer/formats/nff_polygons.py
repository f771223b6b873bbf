"""Polygons of NFF files: triangles that become one mesh, and corners that were printed with few digits."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tracer.formulas.double_double import dd_cross, exact_difference
from tracer.formulas.vector import Vector, as_floats
from tracer.scene import Material
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.planar import unit_normal
from tracer.shapes.polygon import FLATNESS

# Corners that are off their plane by less than this, relative to the polygon's size, are moved into it.
PLANARITY_TOLERANCE = 1e-3


@dataclass
class Patches:
    """Consecutive triangles of one material: their corners, and their normals if they have any."""

    material: Material
    smooth: bool
    corners: list[Any]
    normals: list[Any]

    def mesh(self) -> Mesh | None:
        """The mesh; None if it has no area: generators write degenerate triangles where a patch ends in a point."""
        corners = np.array(self.corners).reshape(-1, 3)
        normals = np.array(self.normals).reshape(-1, 3) if self.smooth else None
        faces = np.arange(len(corners)).reshape(-1, 3)
        a, b, c = (tuple(corners[k::3].T) for k in range(3))
        area = dd_cross(exact_difference(b, a), exact_difference(c, a))
        faces = faces[np.any([high != 0.0 for high, _ in area], axis=0)]
        return Mesh(Geometry(corners, faces, normals)) if len(faces) else None


def flattened(points: list[Vector]) -> list[Vector]:
    """The corners of a polygon, moved into its plane if they are off it only because few digits were printed."""
    corners = np.array(points)
    middle = corners.mean(axis=0)
    normal = unit_normal(corners)
    heights = (corners - middle) @ normal
    size = np.linalg.norm(corners - middle, axis=1).max()
    if not 0.25 * FLATNESS * size < np.abs(heights).max() < PLANARITY_TOLERANCE * size:
        return points
    return [as_floats(corner) for corner in corners - np.outer(heights, normal)]

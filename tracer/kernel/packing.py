"""Packs a scene into the rows that kernels read. Surfaces are in the file's order: their ids decide ties."""

from collections.abc import Sequence
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

from tracer.compile.rows import Rows, as_rows
from tracer.formulas.vector import Vector, cross, rescale, unit
from tracer.kernel.arrays import LIGHT, MATERIAL, OBJECT, LightRow, MaterialRow, ObjectRow
from tracer.scene import Light, Material, Object, Scene, Shape
from tracer.shapes import CODES
from tracer.shapes.mesh import Mesh
from tracer.shapes.surface_row import SURFACE, SurfaceRow

INFINITE = np.array([[[-np.inf] * 3, [np.inf] * 3]])  # stands for the bounds of an infinite shape


class Surfaces(NamedTuple):
    """All surfaces of a scene."""

    rows: Rows[SurfaceRow]
    corners: np.ndarray  # (n, 3) of polygons
    smooth: np.ndarray  # (n, 3, 3) vertex normals
    bounds: np.ndarray  # (n, 2, 3)

    def triangles(self) -> np.ndarray:
        """The corners (n, 3, 3) of triangles, NaN for other surfaces."""
        corners = np.stack([self.rows["a"], self.rows["b"], self.rows["c"]], axis=1)
        corners[self.rows["shape_code"] != CODES["triangle"]] = np.nan
        return corners


def pack_surfaces(objects: Sequence[Object], solid_of: dict[int, np.ndarray | int]) -> Surfaces:
    """One row for a shape, or for each face of a mesh. `solid_of` gives the solids of an object or of its faces."""
    blocks, corners, smooth = [], [np.zeros((0, 3))], [np.zeros((0, 3, 3))]
    bounds: list[np.ndarray] = []
    corner_count = smooth_count = count = 0
    first_such: dict[Shape, int] = {}
    for kind, run in groupby(enumerate(objects), key=lambda pair: type(pair[1].shape)):
        members = list(run)
        shapes = [item.shape for _, item in members]
        rows = np.zeros(len(members), SURFACE)
        boxes = kind.pack_together(shapes, rows)
        if boxes is not None:
            rows["object"] = [k for k, _ in members]
            rows["solid"] = [solid_of.get(k, -1) for k, _ in members]
            rows["first"], rows["smooth"] = -1, -1
            rows["shape_code"] = CODES[kind.name]
            rows["coincident"] = [first_such.setdefault(shape, count + n) for n, shape in enumerate(shapes)]
            blocks.append(rows)
            bounds.append(boxes)
            count += len(rows)
            continue
        for k, item in members:
            shape = item.shape
            boxes = shape.bounds()
            rows = np.zeros(1 if boxes is None else len(boxes), SURFACE)
            rows["object"], rows["first"], rows["smooth"] = k, -1, -1
            rows["solid"] = solid_of.get(k, -1)
            rows["coincident"] = count + np.arange(len(rows))
            if shape.curved:
                rows["coincident"] = first_such.setdefault(shape, count)
            count += len(rows)
            rows["shape_code"] = CODES[shape.packed_as or shape.name]
            shape.pack(rows)
            if (outline := shape.outline()) is not None:
                rows["first"] = corner_count
                corners.append(outline)
                corner_count += len(outline)
            if (normals := shape.smooth()) is not None:
                rows["smooth"] = smooth_count + np.arange(len(normals))
                smooth.append(normals)
                smooth_count += len(normals)
            blocks.append(rows)
            bounds.append(INFINITE if boxes is None else boxes)
    rows = as_rows(np.concatenate(blocks), SurfaceRow)
    return Surfaces(rows, np.concatenate(corners), np.concatenate(smooth), np.concatenate(bounds))


def pack_objects(objects: Sequence[Object], materials: dict[Material, int]) -> Rows[ObjectRow]:
    """One row for each object. `materials` maps a material to its number."""
    rows = np.zeros(len(objects), OBJECT)
    rows["material"] = [materials[item.material] for item in objects]
    rows["sheet"] = [item.thin for item in objects]
    for k, item in enumerate(objects):
        if item.shape.checker_in_plane and (plane := item.shape.plane()):
            rows[k]["tiled"] = True
            rows[k]["u"], rows[k]["v"] = plane_axes(plane[1])
        if isinstance(item.shape, Mesh):
            rows[k]["placed"] = item.shape.is_placed()
    return as_rows(rows, ObjectRow)


def plane_axes(n: Vector) -> tuple[Vector, Vector]:
    """Two unit axes in the plane with normal n, close to the two axes of the world that are farthest from n."""
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    along = max(range(3), key=lambda k: abs(n[k]))
    first, second = (axes[k] for k in range(3) if k != along)
    v = cross(n, first)
    if sum(a * b for a, b in zip(v, second, strict=True)) < 0.0:
        v = (-v[0], -v[1], -v[2])
    v = unit(v)
    u = cross(n, v)
    if sum(a * b for a, b in zip(u, first, strict=True)) < 0.0:
        u = (-u[0], -u[1], -u[2])
    return u, v


def pack_materials(materials: dict[Material, int]) -> Rows[MaterialRow]:
    """One row for each material, by its number."""
    return as_rows(_by_name(list(materials), MATERIAL), MaterialRow)


def pack_lights(scene: Scene) -> Rows[LightRow]:
    """One row for each light, in the file's order."""
    rows = _by_name(scene.lights, LIGHT)
    for row, light in zip(rows, scene.lights, strict=True):
        row["distant"] = light.direction is not None
        if light.direction is not None:
            x, y, z = unit(rescale(light.direction))
            row["towards"] = (-x, -y, -z)
    return as_rows(rows, LightRow)


def _by_name(items: Sequence[Material | Light], dtype: np.dtype) -> np.ndarray:
    """Copy fields to those of the same name; `checker_x` is `checker.x`. A field that is None, or absent, stays 0."""
    rows = np.zeros(len(items), dtype)
    for row, item in zip(rows, items, strict=True):
        for name in dtype.names or ():
            value: Any = item
            for part in (name,) if hasattr(item, name) else name.split("_"):
                value = getattr(value, part, None)
            if value is not None:
                row[name] = value
    return rows

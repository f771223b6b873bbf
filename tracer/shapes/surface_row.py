"""Rows for kernels: of surfaces, which shapes fill in as their files say under "Packed as", and of triangle blocks."""

from typing import Annotated, Any, Protocol

import numpy as np

from tracer.compile.rows import Float, Float3, Int32, Int64, Numbers, Row, Rows, dtype_of
from tracer.compile.simd import WIDTH


class SurfaceRow(Row):
    """One surface: a shape, or one face of a mesh."""

    a: Float3  # the shape's file defines the fields from `a` to `count`
    b: Float3
    c: Float3
    normal: Float3  # unit normal of a flat face
    normal_low: Float3  # the rounding error of `normal`: the low part of a double-double
    r: Float
    first: Int32  # index of a polygon's first corner, -1 for none
    count: Int32  # corners of a flat face, 1 for a sphere, 0 for a shape without corners
    shape_code: Int32  # as CODES numbers the shapes
    object: Int32
    solid: Int32  # rank of the transparent solid that it bounds, -1 for none
    coincident: Int32  # the first surface with an equal curved shape; usually itself
    smooth: Int32  # index into `ShapeArrays.smooth`, -1 for a face without vertex normals


class BlockRow(Row):
    """Up to eight triangles, rounded to float32. They only tell which triangles a ray may hit."""

    corners: Annotated[Numbers, np.float32, (9, WIDTH)]  # x, y, z of the first corners, of the second, of the third
    surface: Annotated[Numbers, np.int32, WIDTH]
    lanes: Int64  # bit mask of the lanes in use
    anchor: Float3  # the origin of `corners`
    reach: Float  # the largest |x| + |y| + |z| of a corner
    edge: Float  # the longest |x| + |y| + |z| of an edge
    rounding: Float  # bound on the rounding error of `corners`


SURFACE, BLOCK = dtype_of(SurfaceRow), dtype_of(BlockRow)


class ShapeArrays(Protocol):
    """The arrays of the world that the functions of a shape read."""

    @property
    def surfaces(self) -> Rows[SurfaceRow]: ...
    @property
    def corners(self) -> Numbers:
        """(n, 3), of polygons."""
        ...

    @property
    def smooth(self) -> Numbers:
        """(n, 3, 3), vertex normals of faces that have them."""
        ...

    @property
    def formulas(self) -> Any:
        """The functions that kernels compute with (`tracer.kernel.formulas`)."""
        ...

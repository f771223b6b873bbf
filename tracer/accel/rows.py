"""Rows of the hierarchy: its nodes, its blocks of triangles, and the stack of a traversal.

Boxes and corners are float32, half the memory to fetch. Their unit of length is a power of two near the scene's
size, so a scene scaled by a power of two has the same boxes.
"""

from typing import Annotated

import numpy as np

from tracer.compile.rows import Float, Float3, Int64, Numbers, Row, dtype_of
from tracer.compile.simd import WIDTH

# `child` is CHILD_KINDS times an index, plus its kind: another node, one surface, or a block of triangles.
CHILD_KINDS = 4
NODE_CHILD, SURFACE_CHILD, BLOCK_CHILD = range(3)


class NodeRow(Row):
    """Eight boxes with what is in them. An unused box is empty: no ray hits it."""

    planes: Annotated[Numbers, np.float32, (6, WIDTH)]  # low x, high x, low y, ... of the eight boxes, rounded outwards
    child: Annotated[Numbers, np.int32, WIDTH]


class BlockRow(Row):
    """Eight triangles, rounded to float32. They only tell which triangles a ray may hit."""

    corners: Annotated[Numbers, np.float32, (9, WIDTH)]  # x, y, z of the first corners, of the second, of the third
    surface: Annotated[Numbers, np.int32, WIDTH]
    lanes: Int64  # bit mask of the lanes in use
    anchor: Float3  # the origin of `corners`
    reach: Float  # the largest |x| + |y| + |z| of a corner
    edge: Float  # the longest |x| + |y| + |z| of an edge
    rounding: Float  # bound on the rounding error of `corners`


class StackRow(Row):
    """A child that a traversal has put off."""

    child: Int64
    near: Float  # distance at which the ray enters its box


NODE, BLOCK, STACK = dtype_of(NodeRow), dtype_of(BlockRow), dtype_of(StackRow)

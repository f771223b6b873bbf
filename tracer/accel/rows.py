"""Rows of the hierarchy: its nodes, and the stack of a traversal.

Boxes are float32, which halves the memory traffic. Their unit of length is a power of two near the scene's size, so
a scene scaled by a power of two has the same boxes.
"""

from typing import Annotated

import numpy as np

from tracer.compile.rows import Float, Int64, Numbers, Row, dtype_of
from tracer.compile.simd import WIDTH

# `child` is CHILD_KINDS times an index, plus its kind: another node, one surface, or a block of triangles.
CHILD_KINDS = 4
NODE_CHILD, SURFACE_CHILD, BLOCK_CHILD = range(3)


class NodeRow(Row):
    """A BVH node: eight boxes and their children. An unused box is empty: no ray hits it."""

    planes: Annotated[Numbers, np.float32, (6, WIDTH)]  # low x, high x, low y, ... of the eight boxes, rounded outwards
    child: Annotated[Numbers, np.int32, WIDTH]


class StackRow(Row):
    """An entry of the traversal stack: a child that is still to be visited."""

    child: Int64
    near: Float  # distance at which the ray enters its box


NODE, STACK = dtype_of(NodeRow), dtype_of(StackRow)

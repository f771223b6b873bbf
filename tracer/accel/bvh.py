"""Builds the bounding volume hierarchy (BVH) over the bounded surfaces.

A node has eight children, whose boxes are tested against a ray at once ("Getting Rid of Packets", Wald, Benthin &
Boulos, IRT 2008). A child is a node, a block of up to eight triangles, or one surface. To fill a node, its surfaces
are split in two by the surface area heuristic (`sah`), and the parts again, until there are eight.
"""

import math
from typing import NamedTuple

import numpy as np

from tracer.accel.rows import BLOCK_CHILD, CHILD_KINDS, NODE, NODE_CHILD, SURFACE_CHILD, NodeRow
from tracer.accel.sah import BuildSpace, add_surface, clear_part, next_part, split_part
from tracer.compile.jit import inlined, kernel
from tracer.compile.rows import Numbers, Rows, as_rows
from tracer.compile.simd import WIDTH
from tracer.shapes.surface_row import BLOCK, BlockRow

MAX_UNBOXED = 3  # up to this number, surfaces are tested one by one, without a BVH: by `python -m benchmarks flat`


class Hierarchy(NamedTuple):
    """A finished hierarchy."""

    nodes: np.ndarray  # of NODE; the root is number 0
    blocks: np.ndarray  # of BLOCK
    unit: float  # unit of length of the boxes, a power of two


def length_unit(bounds: np.ndarray) -> float:
    """The smallest power of two above the absolute value of every coordinate."""
    return math.ldexp(1.0, min(math.frexp(float(np.abs(bounds).max(initial=0.0)))[1], 1023))


def build(bounds: np.ndarray, triangles: np.ndarray | None = None, which: np.ndarray | None = None) -> Hierarchy:
    """Build the hierarchy over the boxes (n, 2, 3) of surfaces, or over those for which `which` (n) is true.

    `triangles` (n, 3, 3) are the corners of the surfaces that are triangles, NaN for the others.
    """
    n = len(bounds)
    order = (np.arange(n) if which is None else np.flatnonzero(which)).astype(np.int32)
    if len(order) == 0:
        return Hierarchy(np.zeros(0, NODE), np.zeros(0, BLOCK), 1.0)
    unit = length_unit(bounds[order])
    is_other = np.ones(n, np.bool_) if triangles is None else np.isnan(triangles[:, 0, 0])
    boxes, centers = np.zeros((n, 8), np.float32), np.zeros((n, 8), np.float32)
    with np.errstate(under="ignore", over="ignore", invalid="ignore"):
        boxes[:, 0:3] = np.nextafter((bounds[:, 0] / unit).astype(np.float32), np.float32(-np.inf))
        boxes[:, 4:7] = np.nextafter((-bounds[:, 1] / unit).astype(np.float32), np.float32(-np.inf))
        centers[:, 0:3] = boxes[:, 0:3] - boxes[:, 4:7]
        centers[:, 4:7] = -centers[:, 0:3]
    nodes, blocks = np.zeros(len(order), NODE), np.zeros(len(order) - np.count_nonzero(is_other[order]), BLOCK)
    corners = np.full((n, 3, 3), np.nan) if triangles is None else triangles
    space = BuildSpace.make()
    with np.errstate(under="ignore"):
        build_nodes(
            boxes, centers, is_other, corners, unit, as_rows(nodes, NodeRow), as_rows(blocks, BlockRow), order, space
        )
    return Hierarchy(nodes[: space.used[0]].copy(), blocks[: space.used[1]].copy(), unit)


@kernel
def build_nodes(
    boxes: Numbers,
    centers: Numbers,
    is_other: Numbers,
    corners: Numbers,
    unit: float,
    nodes: Rows[NodeRow],
    blocks: Rows[BlockRow],
    order: Numbers,
    space: BuildSpace,
) -> None:
    """Fill `nodes` and `blocks`, and sort `order`, the ids of the surfaces, so that each part is a range of it."""
    todo, parts, used = space.todo, space.parts, space.used
    clear_part(todo[0])
    for s in order:
        add_surface(todo[0], boxes, centers, is_other, s)
    todo[0].last = len(order)
    waiting = 1
    used[0] = 1
    while waiting > 0:
        waiting -= 1
        node, level = todo[waiting].node, todo[waiting].level
        parts[0] = todo[waiting]
        count = 1
        while count < WIDTH:
            k = next_part(parts, count)
            if k < 0:
                break
            split_part(boxes, centers, is_other, order, level, parts[k], parts[count], space)
            count += 1
        box = nodes[node]
        for k in range(WIDTH):
            for a in range(3):
                box.planes[2 * a, k] = parts[k].box[a] if k < count else math.inf
                box.planes[2 * a + 1, k] = -parts[k].box[4 + a] if k < count else -math.inf
        for k in range(count):
            first, n = parts[k].first, parts[k].last - parts[k].first
            if n == 1:
                box.child[k] = CHILD_KINDS * order[first] + SURFACE_CHILD
            elif n <= WIDTH and parts[k].others == 0:
                box.child[k] = CHILD_KINDS * used[1] + BLOCK_CHILD
                fill_block(blocks[used[1]], corners, unit, order, first, n)
                used[1] += 1
            else:
                box.child[k] = CHILD_KINDS * used[0] + NODE_CHILD
                parts[k].node, parts[k].level = used[0], level + 1
                todo[waiting] = parts[k]
                waiting += 1
                used[0] += 1


@inlined
def fill_block(block: BlockRow, corners: Numbers, unit: float, order: Numbers, first: int, count: int) -> None:
    """Store `count` triangles in a block. The first triangle also fills the unused lanes, which the block's lane mask
    disables.
    """
    block.lanes = (1 << count) - 1
    size = 0.0
    for a in range(3):
        block.anchor[a] = corners[order[first], 0, a] / unit
    for k in range(WIDTH):
        s = order[first + k] if k < count else order[first]
        block.surface[k] = s
        for i in range(3):
            reach, edge = 0.0, 0.0
            for a in range(3):
                x, before = corners[s, i, a] / unit, corners[s, i - 1, a] / unit
                arm = x - block.anchor[a]
                block.corners[3 * i + a, k] = arm
                size = max(size, abs(arm))
                reach += abs(x)
                edge += abs(x - before)
            block.reach = max(block.reach, reach)
            block.edge = max(block.edge, edge)
    block.rounding = 2.0**-22 * size

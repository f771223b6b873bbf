"""A hierarchy of boxes over the bounded surfaces, so that a ray tests only those near its way.

A node holds eight boxes side by side, tested at once; in each is one surface, a block of eight triangles or a node
("Getting Rid of Packets", Wald, Benthin & Boulos, IRT 2008). A node's surfaces are halved, and the halves again, until
there are eight parts (see `halves`). Boxes are float32, half the memory to fetch, rounded outward, in a unit that is a
power of two near the scene's size: so a scene scaled by another one has the same boxes.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from tracer.accel.sah import BuildSpace, add_surface, clear_part, next_part, split_part
from tracer.compile.jit import inlined, kernel
from tracer.compile.simd import WIDTH

# Of eight boxes in their order: `planes` low x, high x, low y, ...; `child` what is in each: KINDS times its number
# and its kind. An empty box is met by no ray.
NODE = np.dtype([("planes", np.float32, (6, WIDTH)), ("child", np.int32, WIDTH)], align=True)
CHILD_KINDS = 4
NODE_CHILD, SURFACE_CHILD, BLOCK_CHILD = range(3)

# Eight triangles in their order: `corners` x, y and z of the first corners, of the second, of the third, seen from
# `anchor`, in the hierarchy's unit. They only say where the ray may pass inside: at most `doubt` is rounded off them.
BLOCK = np.dtype(
    [
        ("corners", np.float32, (9, WIDTH)),
        ("surface", np.int32, WIDTH),
        ("lanes", np.int64),  # those in use, bit by bit
        ("anchor", np.float64, 3),
        ("reach", np.float64),  # the largest |x| + |y| + |z| of a corner
        ("edge", np.float64),  # the longest |x| + |y| + |z| of an edge
        ("doubt", np.float64),
    ],
    align=True,
)

# What a search has put off, and where the ray enters its box.
STACK_ENTRY = np.dtype([("child", np.int64), ("near", np.float64)])

MAX_UNBOXED = 3  # so few surfaces are tried one by one: measured, `python -m benchmarks flat`


class Hierarchy(NamedTuple):
    nodes: np.ndarray
    blocks: np.ndarray
    unit: float


def length_unit(bounds: np.ndarray) -> float:
    """The power of two above every coordinate."""
    return math.ldexp(1.0, min(math.frexp(float(np.abs(bounds).max(initial=0.0)))[1], 1023))


def build(bounds: np.ndarray, triangles: np.ndarray | None = None, which: np.ndarray | None = None) -> Hierarchy:
    """Over the surfaces' boxes (n, 2, 3), or over those `which` (n) holds for; `triangles` (n, 3, 3): their corners,
    nan for what is no triangle."""
    n = len(bounds)
    order = (np.arange(n) if which is None else np.flatnonzero(which)).astype(np.int32)
    if len(order) == 0:
        return Hierarchy(np.zeros(0, NODE), np.zeros(0, BLOCK), 1.0)
    unit = length_unit(bounds[order])
    other = np.ones(n, np.bool_) if triangles is None else np.isnan(triangles[:, 0, 0])
    reach, middles = np.zeros((n, 8), np.float32), np.zeros((n, 8), np.float32)
    with np.errstate(under="ignore", over="ignore", invalid="ignore"):
        reach[:, 0:3] = np.nextafter((bounds[:, 0] / unit).astype(np.float32), np.float32(-np.inf))
        reach[:, 4:7] = np.nextafter((-bounds[:, 1] / unit).astype(np.float32), np.float32(-np.inf))
        middles[:, 0:3] = reach[:, 0:3] - reach[:, 4:7]
        middles[:, 4:7] = -middles[:, 0:3]
    nodes, blocks = np.zeros(len(order), NODE), np.zeros(len(order) - np.count_nonzero(other[order]), BLOCK)
    corners = np.full((n, 3, 3), np.nan) if triangles is None else triangles
    room = BuildSpace.make()
    with np.errstate(under="ignore"):
        build_nodes(
            reach, middles, other, corners, unit, nodes.view(np.recarray), blocks.view(np.recarray), order, room
        )
    return Hierarchy(nodes[: room.used[0]].copy(), blocks[: room.used[1]].copy(), unit)


@kernel
def build_nodes(
    reach: Any,
    middles: Any,
    other: Any,
    corners: Any,
    unit: float,
    nodes: Any,
    blocks: Any,
    order: Any,
    room: BuildSpace,
) -> None:
    """Fill `nodes` and `blocks`, permute `order`."""
    todo, parts, used = room.todo, room.parts, room.used
    clear_part(todo[0])
    for s in order:
        add_surface(todo[0], reach, middles, other, s)
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
            split_part(reach, middles, other, order, level, parts[k], parts[count], room)
            count += 1
        box = nodes[node]
        for k in range(WIDTH):
            for a in range(3):
                box.planes[2 * a, k] = parts[k].reach[a] if k < count else math.inf
                box.planes[2 * a + 1, k] = -parts[k].reach[4 + a] if k < count else -math.inf
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
def fill_block(block: Any, corners: Any, unit: float, order: Any, first: int, count: int) -> None:
    """Put `count` triangles into a block; the first of them stands in the lanes left, too, but is not asked there."""
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
    block.doubt = 2.0**-22 * size

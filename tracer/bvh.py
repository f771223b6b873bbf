"""A hierarchy of boxes over the bounded surfaces, so that a ray tests only those near its way.

A node holds eight boxes side by side, tested at once; in each is one surface or a node. A node's surfaces are parted,
the widest part again and again, where the surface area heuristic expects the least work, tried at the borders of equal
bins (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IRT 2007; eight wide: Wald, Benthin &
Boulos, "Getting Rid of Packets", IRT 2008). Boxes are float32, half the memory to fetch, rounded outward; their unit is
a power of two near the scene's size, so that a scene scaled by another one has the same boxes.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from tracer.jit import compiled, kernel
from tracer.lanes import WIDTH

# Of eight boxes in their order: `planes` low x, high x, low y, ...; `child` what is in each: KINDS times its number
# and its kind. An empty box is met by no ray.
NODE = np.dtype([("planes", np.float32, (6, WIDTH)), ("child", np.int32, WIDTH)], align=True)
KINDS = 4
BOXES, SURFACE, TRIANGLES = range(3)

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
WAITING = np.dtype([("child", np.int64), ("near", np.float64)])

FLAT = 3  # so few surfaces are tried one by one: measured, `python -m benchmarks flat`
BINS = 16
FILL = 6  # triangles that a block will hardly have fewer of
HALVING = 24  # the level from which on surfaces are parted by their number: so no hierarchy is deeper than
DEEPEST = 48  # levels
MOST_WAITING = DEEPEST * (WIDTH - 1) + 1

# Some surfaces: they stand in the order from `first` to before `last`. `reach` is the box about them, `middles` that
# about their boxes' middles, twofold; both as low x y z, 0, -high x y z, 0, so that joining takes eight minima.
PART = np.dtype(
    [
        ("reach", np.float32, 8),
        ("middles", np.float32, 8),
        ("first", np.int64),
        ("last", np.int64),
        ("others", np.int64),  # that are no triangles
        ("node", np.int64),  # that it is to become
        ("level", np.int64),
    ],
    align=True,
)


class Hierarchy(NamedTuple):
    nodes: np.ndarray
    blocks: np.ndarray
    unit: float


class Room(NamedTuple):
    """Room to work in, since kernels make no arrays of their own."""

    todo: np.ndarray
    parts: np.ndarray  # of one node
    bins: np.ndarray
    above: np.ndarray  # the cost of the second half that begins with this bin
    used: np.ndarray  # nodes and blocks made so far

    @staticmethod
    def make() -> "Room":
        return Room(
            np.zeros(MOST_WAITING, PART).view(np.recarray),
            np.zeros(WIDTH, PART).view(np.recarray),
            np.zeros(BINS + 1, PART).view(np.recarray),
            np.zeros(BINS),
            np.zeros(2, np.int64),
        )


def unit_of(bounds: np.ndarray) -> float:
    """The power of two above every coordinate."""
    return math.ldexp(1.0, min(math.frexp(float(np.abs(bounds).max(initial=0.0)))[1], 1023))


def build(bounds: np.ndarray, triangles: np.ndarray | None = None, which: np.ndarray | None = None) -> Hierarchy:
    """Over the surfaces' boxes (n, 2, 3), or over those `which` (n) holds for; `triangles` (n, 3, 3): their corners,
    nan for what is no triangle."""
    n = len(bounds)
    order = (np.arange(n) if which is None else np.flatnonzero(which)).astype(np.int32)
    if len(order) == 0:
        return Hierarchy(np.zeros(0, NODE), np.zeros(0, BLOCK), 1.0)
    unit = unit_of(bounds[order])
    other = np.ones(n, np.bool_) if triangles is None else np.isnan(triangles[:, 0, 0])
    reach, middles = np.zeros((n, 8), np.float32), np.zeros((n, 8), np.float32)
    with np.errstate(under="ignore", over="ignore", invalid="ignore"):
        reach[:, 0:3] = np.nextafter((bounds[:, 0] / unit).astype(np.float32), np.float32(-np.inf))
        reach[:, 4:7] = np.nextafter((-bounds[:, 1] / unit).astype(np.float32), np.float32(-np.inf))
        middles[:, 0:3] = reach[:, 0:3] - reach[:, 4:7]
        middles[:, 4:7] = -middles[:, 0:3]
    nodes, blocks = np.zeros(len(order), NODE), np.zeros(len(order) - np.count_nonzero(other[order]), BLOCK)
    corners = np.full((n, 3, 3), np.nan) if triangles is None else triangles
    room = Room.make()
    with np.errstate(under="ignore"):
        part_all(reach, middles, other, corners, unit, nodes.view(np.recarray), blocks.view(np.recarray), order, room)
    return Hierarchy(nodes[: room.used[0]].copy(), blocks[: room.used[1]].copy(), unit)


@kernel
def part_all(
    reach: Any, middles: Any, other: Any, corners: Any, unit: float, nodes: Any, blocks: Any, order: Any, room: Room
) -> None:
    """Fill `nodes` and `blocks`, permute `order`."""
    todo, parts, used = room.todo, room.parts, room.used
    clear(todo[0])
    for s in order:
        add(todo[0], reach, middles, other, s)
    todo[0].last = len(order)
    waiting = 1
    used[0] = 1
    while waiting > 0:
        waiting -= 1
        node, level = todo[waiting].node, todo[waiting].level
        parts[0] = todo[waiting]
        count = 1
        while count < WIDTH:
            k = next_of(parts, count)
            if k < 0:
                break
            halve(reach, middles, other, order, level, parts[k], parts[count], room)
            count += 1
        box = nodes[node]
        for k in range(WIDTH):
            for a in range(3):
                box.planes[2 * a, k] = parts[k].reach[a] if k < count else math.inf
                box.planes[2 * a + 1, k] = -parts[k].reach[4 + a] if k < count else -math.inf
        for k in range(count):
            first, n = parts[k].first, parts[k].last - parts[k].first
            if n == 1:
                box.child[k] = KINDS * order[first] + SURFACE
            elif n <= WIDTH and parts[k].others == 0:
                box.child[k] = KINDS * used[1] + TRIANGLES
                fill(blocks[used[1]], corners, unit, order, first, n)
                used[1] += 1
            else:
                box.child[k] = KINDS * used[0] + BOXES
                parts[k].node, parts[k].level = used[0], level + 1
                todo[waiting] = parts[k]
                waiting += 1
                used[0] += 1


@compiled
def fill(block: Any, corners: Any, unit: float, order: Any, first: int, count: int) -> None:
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


@compiled
def clear(this: Any) -> None:
    for k in range(8):
        this.reach[k] = math.inf
        this.middles[k] = math.inf
    this.first = 0
    this.last = 0
    this.others = 0


@compiled
def join(box: Any, another: Any) -> None:
    """Make a box cover another one, too."""
    for k in range(8):
        box[k] = min(box[k], another[k])


@compiled
def add(this: Any, reach: Any, middles: Any, other: Any, s: int) -> None:
    join(this.reach, reach[s])
    join(this.middles, middles[s])
    this.others += other[s]


@compiled
def merge(this: Any, bins: Any, start: int, stop: int) -> None:
    clear(this)
    for b in range(start, stop):
        join(this.reach, bins[b].reach)
        join(this.middles, bins[b].middles)
        this.others += bins[b].others


@compiled
def half_area(reach: Any) -> float:
    x = -(float(reach[0]) + float(reach[4]))
    y = -(float(reach[1]) + float(reach[5]))
    z = -(float(reach[2]) + float(reach[6]))
    return x * y + y * z + z * x


@compiled
def next_of(parts: Any, count: int) -> int:
    """The part to be halved next; -1 for none.

    First those that can be dissolved into the lanes left, for that saves a node: the most area for the lanes it takes.
    Then the largest box.
    """
    best, most = -1, -1.0
    dissolving = False
    for k in range(count):
        n = parts[k].last - parts[k].first
        lanes = n if parts[k].others > 0 else (n + FILL - 1) // FILL
        if (n > WIDTH or parts[k].others > 0) and lanes > 1:
            fits = lanes - 1 <= WIDTH - count
            size = half_area(parts[k].reach) / (lanes - 1 if fits else 1)
            if (fits and not dissolving) or (fits == dissolving and size > most):
                best, most, dissolving = k, size, fits
    return best


@compiled
def halve(reach: Any, middles: Any, other: Any, order: Any, level: int, this: Any, second: Any, room: Room) -> None:
    """Leave some of the surfaces in `this`, and put the others into `second`."""
    first, last = this.first, this.last
    axis, extent = 0, -1.0
    for a in range(3):
        side = -(float(this.middles[a]) + float(this.middles[4 + a]))
        if side > extent:
            axis, extent = a, side
    if extent > 0.0 and level < HALVING:
        bins, count = room.bins, min(BINS, last - first + 2)
        start, rate = float(this.middles[axis]), count / extent
        for b in range(count):
            clear(bins[b])
        for k in range(first, last):
            s = order[k]
            b = min(count - 1, int(rate * (middles[s, axis] - start)))
            add(bins[b], reach, middles, other, s)
            bins[b].last += 1
        split = best_split(bins, room.above, count, WIDTH if this.others == 0 else 1)
        cut = first
        for k in range(first, last):
            s = order[k]
            if min(count - 1, int(rate * (middles[s, axis] - start))) < split:
                order[k], order[cut] = order[cut], s
                cut += 1
        merge(this, bins, 0, split)
        merge(second, bins, split, count)
    else:
        cut = (first + last) // 2
        clear(this)
        clear(second)
        for k in range(first, cut):
            add(this, reach, middles, other, order[k])
        for k in range(cut, last):
            add(second, reach, middles, other, order[k])
    this.first, this.last = first, cut
    second.first, second.last = cut, last


@compiled
def best_split(bins: Any, above: Any, count: int, grain: int) -> int:
    """The first bin of the second half where area times work, summed over both halves, is least; both hold some.

    The work is the number of surfaces, `grain` of them being as much work as one.
    """
    half = bins[BINS]
    clear(half)
    n = 0
    for b in range(count - 1, 0, -1):
        n += bins[b].last
        join(half.reach, bins[b].reach)
        above[b] = (n + grain - 1) // grain * half_area(half.reach) if n > 0 else math.inf
    clear(half)
    n, best, split = 0, math.inf, 1
    for b in range(1, count):
        n += bins[b - 1].last
        join(half.reach, bins[b - 1].reach)
        if n > 0 and above[b] < math.inf:
            cost = (n + grain - 1) // grain * half_area(half.reach) + above[b]
            if cost < best:
                best, split = cost, b
    return split

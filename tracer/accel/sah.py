"""How a hierarchy parts surfaces: into halves along an axis, where the surface area heuristic expects the least work.

The expected work of a box is its area times what is in it (Goldsmith & Salmon, IEEE CG&A 7(5), 1987); splits are tried
at the borders of equal bins along each axis (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IRT
2007).
"""

import math
from typing import Any, NamedTuple

import numpy as np

from tracer.compile.jit import inlined
from tracer.compile.simd import WIDTH

BINS = 16
BLOCK_FILL = 6  # triangles that a block will hardly have fewer of
MEDIAN_LEVEL = 24  # the level from which on surfaces are parted by their number: so no hierarchy is deeper than
MAX_LEVELS = 48  # levels
MAX_STACK = MAX_LEVELS * (WIDTH - 1) + 1

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


class BuildSpace(NamedTuple):
    """Room to work in, since kernels make no arrays of their own."""

    todo: np.ndarray
    parts: np.ndarray  # of one node
    bins: np.ndarray  # (3, BINS), along each axis
    rates: np.ndarray  # bins a length, 0 along an axis on which all middles are one
    half: np.ndarray
    above: np.ndarray  # the cost of the second half that begins with this bin
    used: np.ndarray  # nodes and blocks made so far

    @staticmethod
    def make() -> "BuildSpace":
        return BuildSpace(
            np.zeros(MAX_STACK, PART).view(np.recarray),
            np.zeros(WIDTH, PART).view(np.recarray),
            np.zeros((3, BINS), PART).view(np.recarray),
            np.zeros(3),
            np.zeros(1, PART).view(np.recarray),
            np.zeros(BINS),
            np.zeros(2, np.int64),
        )


@inlined
def clear_part(this: Any) -> None:
    for k in range(8):
        this.reach[k] = math.inf
        this.middles[k] = math.inf
    this.first = 0
    this.last = 0
    this.others = 0


@inlined
def grow_box(box: Any, another: Any) -> None:
    """Make a box cover another one, too."""
    for k in range(8):
        box[k] = min(box[k], another[k])


@inlined
def add_surface(this: Any, reach: Any, middles: Any, other: Any, s: int) -> None:
    grow_box(this.reach, reach[s])
    grow_box(this.middles, middles[s])
    this.others += other[s]


@inlined
def merge_bins(this: Any, bins: Any, start: int, stop: int) -> None:
    clear_part(this)
    for b in range(start, stop):
        grow_box(this.reach, bins[b].reach)
        grow_box(this.middles, bins[b].middles)
        this.others += bins[b].others


@inlined
def half_area(reach: Any) -> float:
    x = -(float(reach[0]) + float(reach[4]))
    y = -(float(reach[1]) + float(reach[5]))
    z = -(float(reach[2]) + float(reach[6]))
    return x * y + y * z + z * x


@inlined
def next_part(parts: Any, count: int) -> int:
    """The part to be halved next; -1 for none.

    First those that can be dissolved into the lanes left, for that saves a node: the most area for the lanes it takes.
    Then the largest box.
    """
    best, most = -1, -1.0
    dissolving = False
    for k in range(count):
        n = parts[k].last - parts[k].first
        lanes = n if parts[k].others > 0 else (n + BLOCK_FILL - 1) // BLOCK_FILL
        if (n > WIDTH or parts[k].others > 0) and lanes > 1:
            fits = lanes - 1 <= WIDTH - count
            size = half_area(parts[k].reach) / (lanes - 1 if fits else 1)
            if (fits and not dissolving) or (fits == dissolving and size > most):
                best, most, dissolving = k, size, fits
    return best


@inlined
def split_part(
    reach: Any, middles: Any, other: Any, order: Any, level: int, this: Any, second: Any, room: BuildSpace
) -> None:
    """Leave some of the surfaces in `this`, and put the others into `second`."""
    first, last = this.first, this.last
    count = min(BINS, last - first + 2)
    axis, split = -1, 0
    if level < MEDIAN_LEVEL:
        fill_bins(reach, middles, other, order, this, count, room)
        axis, split = best_split(room, count, WIDTH if this.others == 0 else 1)
    if axis >= 0:
        start, rate = float(this.middles[axis]), room.rates[axis]
        cut = first
        for k in range(first, last):
            s = order[k]
            if bin_of(middles[s, axis], start, rate, count) < split:
                order[k], order[cut] = order[cut], s
                cut += 1
        merge_bins(this, room.bins[axis], 0, split)
        merge_bins(second, room.bins[axis], split, count)
    else:
        cut = (first + last) // 2
        clear_part(this)
        clear_part(second)
        for k in range(first, cut):
            add_surface(this, reach, middles, other, order[k])
        for k in range(cut, last):
            add_surface(second, reach, middles, other, order[k])
    this.first, this.last = first, cut
    second.first, second.last = cut, last


@inlined
def bin_of(middle: float, start: float, rate: float, count: int) -> int:
    return min(count - 1, int(rate * (middle - start)))


@inlined
def fill_bins(reach: Any, middles: Any, other: Any, order: Any, this: Any, count: int, room: BuildSpace) -> None:
    """Sort a part's surfaces into equal bins along each axis, by the middles of their boxes."""
    bins, rates = room.bins, room.rates
    for axis in range(3):
        extent = -(float(this.middles[axis]) + float(this.middles[4 + axis]))
        rates[axis] = count / extent if extent > 0.0 else 0.0
        for b in range(count):
            clear_part(bins[axis, b])
    for k in range(this.first, this.last):
        s = order[k]
        for axis in range(3):
            if rates[axis] > 0.0:
                b = bin_of(middles[s, axis], float(this.middles[axis]), rates[axis], count)
                add_surface(bins[axis, b], reach, middles, other, s)
                bins[axis, b].last += 1


@inlined
def best_split(room: BuildSpace, count: int, grain: int) -> tuple[int, int]:
    """(axis, first bin of the second half) where area times work, summed over both halves, is least; axis -1 where all
    middles are one. Both halves hold some.

    The work is the number of surfaces, `grain` of them being as much work as one.
    """
    half, above = room.half[0], room.above
    best, axis, split = math.inf, -1, 1
    for a in range(3):
        if room.rates[a] > 0.0:
            bins = room.bins[a]
            clear_part(half)
            n = 0
            for b in range(count - 1, 0, -1):
                n += bins[b].last
                grow_box(half.reach, bins[b].reach)
                above[b] = (n + grain - 1) // grain * half_area(half.reach) if n > 0 else math.inf
            clear_part(half)
            n = 0
            for b in range(1, count):
                n += bins[b - 1].last
                grow_box(half.reach, bins[b - 1].reach)
                if n > 0 and above[b] < math.inf:
                    cost = (n + grain - 1) // grain * half_area(half.reach) + above[b]
                    if cost < best:
                        best, axis, split = cost, a, b
    return (axis, split)

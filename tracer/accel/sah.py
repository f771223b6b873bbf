"""Splits a part of the surfaces in two, where the surface area heuristic (SAH) expects the least work.

The expected work of a box is its area times the number of surfaces in it (Goldsmith & Salmon, IEEE CG&A 7(5), 1987).
Splits are tried at the borders of equal bins along each axis (Wald, "On fast Construction of SAH-based Bounding Volume
Hierarchies", IRT 2007).
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from tracer.compile.jit import inlined
from tracer.compile.rows import Int64, Numbers, Row, Rows, as_rows, dtype_of
from tracer.compile.simd import WIDTH

BINS = 16
BLOCK_FILL = 6  # expected number of triangles in a block
MEDIAN_LEVEL = 24  # from this level on, parts are split by count, so that the BVH has at most MAX_LEVELS levels
MAX_LEVELS = 48
MAX_STACK = MAX_LEVELS * (WIDTH - 1) + 1


class PartRow(Row):
    """A part of the surfaces: those from `first` to before `last` of the order.

    Boxes are stored as low x, y, z, 0, -high x, y, z, 0, so that joining two takes eight minima.
    """

    box: Annotated[Numbers, np.float32, 8]  # bounds of the surfaces
    centers: Annotated[Numbers, np.float32, 8]  # bounds of twice the centres of their boxes
    first: Int64
    last: Int64
    others: Int64  # number of surfaces that are not triangles
    node: Int64  # index of the node that the part becomes
    level: Int64


PART = dtype_of(PartRow)


class BuildSpace(NamedTuple):
    """Scratch memory for building a BVH, since kernels allocate none."""

    todo: Rows[PartRow]  # stack of parts that become nodes
    parts: Rows[PartRow]  # the parts of the node in progress
    bins: np.ndarray  # (3, BINS), along each axis
    rates: np.ndarray  # bins per length along each axis; 0 where all centres coincide
    half: Rows[PartRow]
    cost_above: np.ndarray  # cost of the second half that begins with this bin
    used: np.ndarray  # nodes and blocks made so far

    @staticmethod
    def make() -> "BuildSpace":
        return BuildSpace(
            as_rows(np.zeros(MAX_STACK, PART), PartRow),
            as_rows(np.zeros(WIDTH, PART), PartRow),
            as_rows(np.zeros((3, BINS), PART), PartRow),
            np.zeros(3),
            as_rows(np.zeros(1, PART), PartRow),
            np.zeros(BINS),
            np.zeros(2, np.int64),
        )


@inlined
def clear_part(this: PartRow) -> None:
    """Make a part empty."""
    for k in range(8):
        this.box[k] = math.inf
        this.centers[k] = math.inf
    this.first = 0
    this.last = 0
    this.others = 0


@inlined
def grow_box(box: Numbers, other: Numbers) -> None:
    """Grow a box so that it covers the other one."""
    for k in range(8):
        box[k] = min(box[k], other[k])


@inlined
def add_surface(this: PartRow, boxes: Numbers, centers: Numbers, is_other: Numbers, s: int) -> None:
    """Add surface s to a part."""
    grow_box(this.box, boxes[s])
    grow_box(this.centers, centers[s])
    this.others += is_other[s]


@inlined
def merge_bins(this: PartRow, bins: Rows[PartRow], start: int, stop: int) -> None:
    """Make a part of the bins from `start` to before `stop`."""
    clear_part(this)
    for b in range(start, stop):
        grow_box(this.box, bins[b].box)
        grow_box(this.centers, bins[b].centers)
        this.others += bins[b].others


@inlined
def half_area(box: Numbers) -> float:
    """Half the surface area of a box."""
    x = -(float(box[0]) + float(box[4]))
    y = -(float(box[1]) + float(box[5]))
    z = -(float(box[2]) + float(box[6]))
    return x * y + y * z + z * x


@inlined
def next_part(parts: Rows[PartRow], count: int) -> int:
    """The part to split next; -1 for none.

    A part that can be split completely into the free lanes comes first, since that saves a node; of several, the one
    with the largest area per lane. Otherwise it is the part with the largest box.
    """
    best, most = -1, -1.0
    dissolving = False
    for k in range(count):
        n = parts[k].last - parts[k].first
        lanes = n if parts[k].others > 0 else (n + BLOCK_FILL - 1) // BLOCK_FILL
        if (n > WIDTH or parts[k].others > 0) and lanes > 1:
            fits = lanes - 1 <= WIDTH - count
            size = half_area(parts[k].box) / (lanes - 1 if fits else 1)
            if (fits and not dissolving) or (fits == dissolving and size > most):
                best, most, dissolving = k, size, fits
    return best


@inlined
def split_part(
    boxes: Numbers,
    centers: Numbers,
    is_other: Numbers,
    order: Numbers,
    level: int,
    this: PartRow,
    second: PartRow,
    space: BuildSpace,
) -> None:
    """Split the part `this`: its second half becomes `second`.

    The surface area heuristic chooses the split. If all centres coincide or the level is deep, the part is halved by
    count.
    """
    first, last = this.first, this.last
    count = min(BINS, last - first + 2)
    axis, split = -1, 0
    if level < MEDIAN_LEVEL:
        fill_bins(boxes, centers, is_other, order, this, count, space)
        axis, split = best_split(space, count, WIDTH if this.others == 0 else 1)
    if axis >= 0:
        start, rate = float(this.centers[axis]), space.rates[axis]
        cut = first
        for k in range(first, last):
            s = order[k]
            if bin_of(centers[s, axis], start, rate, count) < split:
                order[k], order[cut] = order[cut], s
                cut += 1
        merge_bins(this, space.bins[axis], 0, split)
        merge_bins(second, space.bins[axis], split, count)
    else:
        cut = (first + last) // 2
        clear_part(this)
        clear_part(second)
        for k in range(first, cut):
            add_surface(this, boxes, centers, is_other, order[k])
        for k in range(cut, last):
            add_surface(second, boxes, centers, is_other, order[k])
    this.first, this.last = first, cut
    second.first, second.last = cut, last


@inlined
def bin_of(center: float, start: float, rate: float, count: int) -> int:
    """The bin of a surface, by the centre of its box."""
    return min(count - 1, int(rate * (center - start)))


@inlined
def fill_bins(
    boxes: Numbers, centers: Numbers, is_other: Numbers, order: Numbers, this: PartRow, count: int, space: BuildSpace
) -> None:
    """Sort a part's surfaces into equal bins along each axis, by the centres of their boxes."""
    bins, rates = space.bins, space.rates
    for axis in range(3):
        extent = -(float(this.centers[axis]) + float(this.centers[4 + axis]))
        rates[axis] = count / extent if extent > 0.0 else 0.0
        for b in range(count):
            clear_part(bins[axis, b])
    for k in range(this.first, this.last):
        s = order[k]
        for axis in range(3):
            if rates[axis] > 0.0:
                b = bin_of(centers[s, axis], float(this.centers[axis]), rates[axis], count)
                add_surface(bins[axis, b], boxes, centers, is_other, s)
                bins[axis, b].last += 1


@inlined
def best_split(space: BuildSpace, count: int, grain: int) -> tuple[int, int]:
    """(axis, first bin of the second half) of the split with the least sum of area times work, both halves not empty.

    The axis is -1 where all centres coincide. The work of a half is its number of surfaces, divided by `grain` and
    rounded up.
    """
    half, cost_above = space.half[0], space.cost_above
    best, axis, split = math.inf, -1, 1
    for a in range(3):
        if space.rates[a] > 0.0:
            bins = space.bins[a]
            clear_part(half)
            n = 0
            for b in range(count - 1, 0, -1):
                n += bins[b].last
                grow_box(half.box, bins[b].box)
                cost_above[b] = (n + grain - 1) // grain * half_area(half.box) if n > 0 else math.inf
            clear_part(half)
            n = 0
            for b in range(1, count):
                n += bins[b - 1].last
                grow_box(half.box, bins[b - 1].box)
                if n > 0 and cost_above[b] < math.inf:
                    cost = (n + grain - 1) // grain * half_area(half.box) + cost_above[b]
                    if cost < best:
                        best, axis, split = cost, a, b
    return (axis, split)

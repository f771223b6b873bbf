"""A hierarchy of boxes over the bounded surfaces, so that a ray tests only those near its way.

Binary, split where the surface area heuristic expects the least work, tried at the borders of equal bins (Wald, "On
fast Construction of SAH-based Bounding Volume Hierarchies", IRT 2007). Nodes are laid out depth first: a box's first
half follows it, `second` says where the other half stands. Few surfaces are one leaf: the flat loop is then the
fastest.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from tracer.jit import compiled, kernel

BOX = np.dtype(
    [
        ("low", np.float64, 3),
        ("high", np.float64, 3),
        ("second", np.int32),  # of an inner box: its second half; of a leaf: the first of its surfaces in the order
        ("count", np.int32),  # surfaces of a leaf, 0 for an inner box
        ("axis", np.int32),  # along which the halves lie
    ],
    align=True,
)

# A box that a search has put off, and where the ray enters it.
WAITING = np.dtype([("node", np.int64), ("near", np.float64)])

FLAT = 8  # up to so many surfaces a leaf is cheaper than two more boxes
BINS = 16
HALVING = 40  # the level from which on a box is simply halved: so no hierarchy is deeper than
DEEPEST = 64  # levels


class Scratch(NamedTuple):
    """Room to work in, since kernels make no arrays of their own."""

    todo: np.ndarray  # stack of: first, one past the last, box waiting for its second half, level
    bins: np.ndarray  # (BINS, 2, 3) box about the surfaces of each bin
    counts: np.ndarray
    cost_above: np.ndarray  # of the second half that begins with this bin
    half: np.ndarray  # (2, 3)

    @staticmethod
    def make() -> "Scratch":
        return Scratch(
            np.zeros((DEEPEST + 1, 4), np.int64),
            np.zeros((BINS, 2, 3)),
            np.zeros(BINS, np.int64),
            np.zeros(BINS),
            np.zeros((2, 3)),
        )


def build(bounds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(boxes, order) over the surfaces' boxes (n, 2, 3): leaves hold runs of `order`; no box for no surface."""
    n = len(bounds)
    if n <= FLAT:
        box = np.zeros(min(n, 1), BOX)
        if n == 0:
            return box, np.zeros(0, np.int32)
        box["low"], box["high"], box["count"] = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0), n
        return box, np.arange(n, dtype=np.int32)
    boxes = np.zeros(2 * n, BOX).view(np.recarray)
    order = np.arange(n, dtype=np.int32)
    used = split_all(np.ascontiguousarray(bounds), boxes, order, Scratch.make())
    return boxes[:used].view(np.ndarray).copy(), order


@kernel
def split_all(bounds: Any, boxes: Any, order: Any, scratch: Scratch) -> int:
    """Fill `boxes` and permute `order`; the number of boxes."""
    todo = scratch.todo
    todo[0] = (0, len(order), -1, 0)
    waiting, used = 1, 0
    while waiting > 0:
        waiting -= 1
        first, last, parent, level = todo[waiting]
        here = used
        used += 1
        if parent >= 0:
            boxes[parent].second = here
        box = boxes[here]
        axis, start, extent = enclose(bounds, order, first, last, box)
        cut = first
        if last - first > 2 and extent > 0.0 and level < HALVING:
            fill_bins(bounds, order, first, last, axis, start, extent, scratch)
            split, cost = best_split(scratch)
            whole = half_area(box.low, box.high)
            if last - first > FLAT or whole + cost < (last - first) * whole:
                cut = partition(bounds, order, first, last, axis, start, extent, split)
        elif last - first > FLAT:
            cut = (first + last) // 2
        if cut == first:
            box.second, box.count, box.axis = first, last - first, 0
        else:
            box.count, box.axis = 0, axis
            todo[waiting] = (cut, last, here, level + 1)
            todo[waiting + 1] = (first, cut, -1, level + 1)
            waiting += 2
    return used


@compiled
def middle(bounds: Any, s: int, axis: int) -> float:
    return 0.5 * bounds[s, 0, axis] + 0.5 * bounds[s, 1, axis]


@compiled
def enclose(bounds: Any, order: Any, first: int, last: int, box: Any) -> tuple[int, float, float]:
    """Set the box's corners; (axis, start, extent) of the longest side of the box about the surfaces' middles."""
    axis, start, extent = 0, 0.0, -1.0
    for a in range(3):
        low, high, from_middle, to_middle = math.inf, -math.inf, math.inf, -math.inf
        for k in range(first, last):
            s = order[k]
            low, high = min(low, bounds[s, 0, a]), max(high, bounds[s, 1, a])
            m = middle(bounds, s, a)
            from_middle, to_middle = min(from_middle, m), max(to_middle, m)
        box.low[a], box.high[a] = low, high
        if to_middle - from_middle > extent:
            axis, start, extent = a, from_middle, to_middle - from_middle
    return (axis, start, extent)


@compiled
def bin_of(bounds: Any, s: int, axis: int, start: float, extent: float) -> int:
    return min(BINS - 1, int(BINS * ((middle(bounds, s, axis) - start) / extent)))


@compiled
def half_area(low: Any, high: Any) -> float:
    x, y, z = high[0] - low[0], high[1] - low[1], high[2] - low[2]
    return x * y + y * z + z * x


@compiled
def fill_bins(
    bounds: Any, order: Any, first: int, last: int, axis: int, start: float, extent: float, scratch: Scratch
) -> None:
    bins, counts = scratch.bins, scratch.counts
    counts[:] = 0
    bins[:, 0] = math.inf
    bins[:, 1] = -math.inf
    for k in range(first, last):
        s = order[k]
        b = bin_of(bounds, s, axis, start, extent)
        counts[b] += 1
        for a in range(3):
            bins[b, 0, a] = min(bins[b, 0, a], bounds[s, 0, a])
            bins[b, 1, a] = max(bins[b, 1, a], bounds[s, 1, a])


@compiled
def widen(box: Any, other: Any) -> float:
    """Make a box (2, 3) cover another one too; half the area of its surface."""
    for a in range(3):
        box[0, a], box[1, a] = min(box[0, a], other[0, a]), max(box[1, a], other[1, a])
    return half_area(box[0], box[1])


@compiled
def best_split(scratch: Scratch) -> tuple[int, float]:
    """(bin, cost): the first bin of the second half where area times number, summed over both halves, is least."""
    bins, counts, cost_above, half = scratch.bins, scratch.counts, scratch.cost_above, scratch.half
    half[0], half[1] = math.inf, -math.inf
    n = 0
    for b in range(BINS - 1, 0, -1):
        n += counts[b]
        size = widen(half, bins[b])
        cost_above[b] = n * size if n > 0 else math.inf
    half[0], half[1] = math.inf, -math.inf
    n, best, split = 0, math.inf, 1
    for b in range(1, BINS):
        n += counts[b - 1]
        size = widen(half, bins[b - 1])
        cost = n * size + cost_above[b] if n > 0 else math.inf
        if cost < best:
            best, split = cost, b
    return (split, best)


@compiled
def partition(
    bounds: Any, order: Any, first: int, last: int, axis: int, start: float, extent: float, split: int
) -> int:
    """Bring the surfaces of bins below `split` to the front; where the others begin."""
    cut = first
    for k in range(first, last):
        s = order[k]
        if bin_of(bounds, s, axis, start, extent) < split:
            order[k], order[cut] = order[cut], s
            cut += 1
    return cut

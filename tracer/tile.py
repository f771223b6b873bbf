"""The kernel's one entry point: the trees behind a tile of pixels.

An image is all its tiles; a click is the tile of one pixel, whose table is then kept; a ray given by hand is the one pixel
of a view that sees nothing else.
"""

from typing import Any, NamedTuple

import numpy as np

from tracer.bundle import Bundle
from tracer.camera import View, pixel_direction
from tracer.jit import kernel
from tracer.kernel import Limits, start_row, trace_tree
from tracer.nodes import CAMERA, KINDS, NODE
from tracer.sampler import sample_offset
from tracer.vector import Vector, add, store, vector

DEEPEST_STACK = 64  # as deep as a hierarchy can be


class Area(NamedTuple):
    """Which pixels of an image: from (left, top) to before (right, bottom), every `step`-th.

    A pixel's colour fills the square of `step` pixels to its right and below. Those on the coarser grid of `traced`
    pixels have been traced in an earlier pass (0: there was none).
    """

    left: int
    top: int
    right: int
    bottom: int
    step: int
    traced: int


class Samples(NamedTuple):
    """Points inside each pixel: `count` from number `first` on; first = -1 is the pixel's centre alone."""

    first: int
    count: int


CENTER = Samples(-1, 1)


class Workspace:
    """What one thread needs to trace: room for one tree. It grows when a tree asks for more."""

    def __init__(self, words: int, rows: int = 256) -> None:
        self.words = words
        self.stack = np.zeros(DEEPEST_STACK, np.int64)
        self.rays = np.zeros(len(KINDS), np.int64)  # traced so far, by kind
        self.tree = np.zeros(2, np.float64)  # rows and residual of the last tree
        self.residual = np.zeros(2, np.float64)  # largest and sum over the pixels
        self.table = np.zeros(rows, NODE)
        self.solids = np.zeros((rows, 2, words), np.int64)

    def grow(self) -> None:
        rows = 4 * len(self.table)
        self.table = np.zeros(rows, NODE)
        self.solids = np.zeros((rows, 2, self.words), np.int64)


@kernel
def trace_area(
    world: Bundle,
    view: View,
    limits: Limits,
    samples: Samples,
    area: Area,
    resume: int,
    eye_solids: Any,
    pixels: Any,
    table: Any,
    solids: Any,
    stack: Any,
    rays: Any,
    tree: Any,
    residuals: Any,
) -> int:
    """Trace the area's pixels in reading order, from number `resume` on, into `pixels` (height, width, 3).

    Returns the number of the pixel whose tree the table was too short for, or how many there are.
    """
    columns = (area.right - area.left + area.step - 1) // area.step
    lines = (area.bottom - area.top + area.step - 1) // area.step
    for number in range(resume, columns * lines):
        x = area.left + (number % columns) * area.step
        y = area.top + (number // columns) * area.step
        if area.traced > 0 and x % area.traced == 0 and y % area.traced == 0:
            continue
        total = (0.0, 0.0, 0.0)
        lost = 0.0
        for k in range(samples.count):
            dx, dy = 0.5, 0.5
            if samples.first >= 0:
                dx, dy = sample_offset(x, y, samples.first + k)
            row = start_row(table, 0, -1, CAMERA, 0, (1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
            store(row.origin, view.eye)
            store(row.direction, pixel_direction(view, x + dx, y + dy))
            row.start = -1
            row.side = 0.0
            for word in range(solids.shape[2]):
                solids[0, 0, word] = eye_solids[word]
                solids[0, 1, word] = eye_solids[word]
            count, residual = trace_tree(world, limits, table, solids, stack)
            if count < 0:
                return number
            for i in range(count):
                rays[table[i].kind] += 1
            tree[0] = count
            tree[1] = residual
            lost += residual
            total = add(total, vector(table[0].radiance))
        color = total
        if samples.count > 1:
            color = (total[0] / samples.count, total[1] / samples.count, total[2] / samples.count)
        residuals[0] = max(residuals[0], lost / samples.count)
        residuals[1] += lost / samples.count
        for j in range(y, min(y + area.step, pixels.shape[0])):
            for i in range(x, min(x + area.step, pixels.shape[1])):
                store(pixels[j, i], color)
    return columns * lines


def run(
    world: Bundle,
    view: View,
    limits: Limits,
    samples: Samples,
    area: Area,
    eye_solids: np.ndarray,
    pixels: np.ndarray,
    space: Workspace,
) -> None:
    """`trace_area` until it is through, with as much room as its trees need."""
    number = 0
    while True:
        columns = -(-(area.right - area.left) // area.step)
        lines = -(-(area.bottom - area.top) // area.step)
        number = trace_area(
            world, view, limits, samples, area, number, eye_solids, pixels,
            space.table, space.solids, space.stack, space.rays, space.tree, space.residual,
        )  # fmt: skip
        if number == columns * lines:
            return
        space.grow()


def eye_view(eye: Vector, direction: Vector) -> View:
    """A view of one pixel whose ray is this one."""
    nowhere = (0.0, 0.0, 0.0)
    return View(eye, direction, nowhere, nowhere, 1, 1)

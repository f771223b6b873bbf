"""The kernel's one entry point: the trees behind a tile of pixels.

An image is all its tiles; a click is the tile of one pixel, whose table is then kept; a ray given by hand is the one
pixel of a view that sees nothing else.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tracer.accel.bvh import STACK_ENTRY
from tracer.accel.sah import MAX_STACK
from tracer.compile.bundle import Bundle
from tracer.compile.jit import inlined, kernel
from tracer.compile.simd import WIDTH
from tracer.formulas.camera import BATCH, View, pixel_direction, pixel_directions
from tracer.formulas.double_double import dd_add
from tracer.formulas.sampler import Samples, sample_offset
from tracer.formulas.vector import Vector, add, store, vector
from tracer.kernel.best_first import OPEN_RAY, trace_best_first
from tracer.kernel.limits import Limits
from tracer.kernel.node_rows import start_row
from tracer.kernel.nodes import CAMERA, KINDS, NODE, SHADOW
from tracer.kernel.shadows import CROSSING, MAX_CROSSINGS
from tracer.kernel.trace import trace_tree


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


class Begun(NamedTuple):
    """Pixels that have some samples already and are to have more."""

    sums: np.ndarray  # (height, width, 4): over the samples so far, of red, green, blue and the weight that was cut
    plan: np.ndarray  # (height, width, 2) int32: how many these are, how many they are to be


NOTHING = Begun(np.zeros((0, 0, 4)), np.zeros((0, 0, 2), np.int32))

# Rays of a kind, after which the kernel comes back within a tile, so that it can be stopped: some tenths of a second.
ENOUGH = 2**20


class Space(NamedTuple):
    """What a thread writes while it traces: room for one tree, and what is counted."""

    table: np.ndarray
    solids: np.ndarray  # (rows, 2, words)
    open: np.ndarray  # rays that wait to be followed, the heaviest first
    stack: np.ndarray  # of nodes still to be entered
    near: np.ndarray  # where the boxes of one node are entered
    crossed: np.ndarray  # glass on the way to a light
    ahead: np.ndarray  # directions through the next pixels of a line
    rays: np.ndarray  # traced in this call, by kind
    tests: np.ndarray  # of a ray against a surface, in this call; the eight triangles of a block count as eight
    tree: np.ndarray  # rows and residual of the last tree; -1 rows where the table was too short for it
    residuals: np.ndarray  # largest and sum over the pixels of this call


class Workspace:
    """One thread's Space. It grows when a tree asks for more."""

    def __init__(self, words: int, rows: int = 256) -> None:
        self.arrays = Space(
            np.zeros(rows, NODE),
            np.zeros((rows, 2, words), np.int64),
            np.zeros(2 * rows, OPEN_RAY),
            np.zeros(MAX_STACK, STACK_ENTRY),
            np.zeros(WIDTH),
            np.zeros(MAX_CROSSINGS, CROSSING),
            np.zeros((3, BATCH)),
            np.zeros(len(KINDS), np.int64),
            np.zeros(1, np.int64),
            np.zeros(2),
            np.zeros(2),
        )
        self.bundle = Bundle(self.arrays, writable=True, ragged=("solids",))

    def grow(self) -> None:
        rows, words = 4 * len(self.arrays.table), self.arrays.solids.shape[2]
        self.arrays = self.arrays._replace(
            table=np.zeros(rows, NODE), solids=np.zeros((rows, 2, words), np.int64), open=np.zeros(2 * rows, OPEN_RAY)
        )
        self.bundle = Bundle(self.arrays, writable=True, ragged=("solids",))


class Counts(NamedTuple):
    """What tracing an area took."""

    rays: np.ndarray  # by kind
    tests: np.ndarray  # of a ray against a surface
    residuals: np.ndarray  # largest and sum over the pixels

    def take_in(self, space: Space) -> None:
        """Add one call's."""
        self.rays[:] += space.rays
        self.tests[:] += space.tests
        self.residuals[:] = (max(self.residuals[0], space.residuals[0]), self.residuals[1] + space.residuals[1])


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
    begun: Begun,
    corner: tuple[int, int],
    space: Bundle,
) -> int:
    """Trace the area's pixels in reading order, from number `resume` on, into `pixels` (height, width, 3).

    Of pixels that are `begun`, those that are to have more samples: `pixels` (height, width, 4) then gets the new sums.
    `corner` is the pixel of the image, (x, y), that stands first in both. Returns how many pixels are done: all, or
    fewer after ENOUGH rays; -1 where a tree is too large for the table, and nothing of this call counts.
    """
    number = 0
    rays, residuals, ahead = space.rays, space.residuals, space.ahead
    rays[:] = 0
    space.tests[:] = 0
    residuals[:] = 0.0
    left, top = corner
    goes_on = len(begun.plan) > 0
    k0 = max(samples.first, 0)
    k1 = k0 + samples.count
    for y in range(area.top, area.bottom, area.step):
        column = -1
        for x in range(area.left, area.right, area.step):
            column += 1
            if samples.first < 0 and column % BATCH == 0:
                pixel_directions(view, x, y, area.step, area.right, ahead)
            number += 1
            if number <= resume:
                continue
            if area.traced > 0 and x % area.traced == 0 and y % area.traced == 0:
                continue
            total, residual = (0.0, 0.0, 0.0), 0.0
            if goes_on:
                k0, k1 = begun.plan[y - top, x - left, 0], begun.plan[y - top, x - left, 1]
                if k1 <= k0:
                    continue
                before = begun.sums[y - top, x - left]
                total, residual = vector(before), before[3]
            if is_enough(rays):
                return number - 1
            k = column % BATCH
            gaze = (ahead[0, k], ahead[1, k], ahead[2, k])
            total, residual = trace_pixel(
                world, view, limits, samples, x, y, gaze, k0, k1, total, residual, eye_solids, space
            )
            if residual < 0.0:
                return -1
            if goes_on:
                store(pixels[y - top, x - left], total)
                pixels[y - top, x - left, 3] = residual
                continue
            color = total
            if samples.count > 1:
                color = (total[0] / samples.count, total[1] / samples.count, total[2] / samples.count)
                residual /= samples.count
            if residual > 0.0:
                residuals[0] = max(residuals[0], residual)
                residuals[1] += residual
            for j in range(y - top, min(y - top + area.step, pixels.shape[0])):
                for i in range(x - left, min(x - left + area.step, pixels.shape[1])):
                    store(pixels[j, i], color)
    return number


@inlined
def is_enough(rays: Any) -> bool:
    """Asked kind by kind: all at once would have to wait until what was just counted is in memory."""
    kind = 0
    while kind < len(rays) and rays[kind] < ENOUGH:
        kind += 1
    return kind < len(rays)


@inlined
def trace_pixel(
    world: Bundle,
    view: View,
    limits: Limits,
    samples: Samples,
    x: int,
    y: int,
    gaze: Vector,
    first: int,
    end: int,
    total: Vector,
    lost: float,
    eye_solids: Any,
    space: Bundle,
) -> tuple[Vector, float]:
    """(colour, residual): summed over the samples from number `first` to before `end`, onto what is there.

    A residual of -1 says that the table was too short for a tree. `gaze` is the direction through the pixel's centre;
    samples have their own.
    """
    table, solids = space.table, space.solids
    for k in range(first, end):
        direction = gaze
        if samples.first >= 0:
            dx, dy = sample_offset(x, y, k, samples.sampler, samples.side)
            direction = pixel_direction(view, x + dx, y + dy)
        row = start_row(limits, table, 0, -1, CAMERA, 0, (1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
        store(row.origin, view.eye)
        store(row.direction, direction)
        row.start = -1
        row.side = 0.0
        row.reach = abs(view.eye[0]) + abs(view.eye[1]) + abs(view.eye[2])
        for word in range(solids.shape[2]):
            solids[0, 0, word] = eye_solids[word]
            solids[0, 1, word] = eye_solids[word]
        is_best_first = limits.tolerance >= 0.0
        count = trace_best_first(world, limits, space) if is_best_first else trace_tree(world, limits, space)
        if count < 0:
            space.tree[0] = -1
            return (total, -1.0)
        residual = count_rays(space, count)
        space.tree[0] = count
        space.tree[1] = residual
        lost += residual
        total = add(total, vector(table[0].radiance))
    return (total, lost)


@inlined
def count_rays(space: Bundle, count: int) -> float:
    """Count the rays that have a row. The sum of the weights that were cut, rounded once."""
    cut = (0.0, 0.0)
    for i in range(count):
        row = space.table[i]
        space.rays[row.kind] += 1
        if row.kind != SHADOW and row.cut > 0.0:
            cut = dd_add(cut, (row.cut, 0.0))
    return cut[0] + cut[1]


def run(
    world: Bundle,
    view: View,
    limits: Limits,
    samples: Samples,
    area: Area,
    eye_solids: np.ndarray,
    pixels: np.ndarray,
    workspace: Workspace,
    corner: tuple[int, int] = (0, 0),
    begun: Begun = NOTHING,
    cancelled: Callable[[], bool] = lambda: False,
) -> Counts | None:
    """`trace_area` until it is through, with as much room as its trees need; None where it was cancelled."""
    columns = -(-(area.right - area.left) // area.step)
    lines = -(-(area.bottom - area.top) // area.step)
    counts = Counts(np.zeros(len(KINDS), np.int64), np.zeros(1, np.int64), np.zeros(2))
    number = 0
    while True:
        reached = trace_area(
            world, view, limits, samples, area, number, eye_solids, pixels, begun, corner, workspace.bundle
        )
        if reached < 0:
            workspace.grow()
            continue
        counts.take_in(workspace.arrays)
        number = reached
        if number == columns * lines:
            return counts
        if cancelled():
            return None


def eye_view(eye: Vector, direction: Vector) -> View:
    """A view of one pixel whose ray is this one."""
    nowhere = (0.0, 0.0, 0.0)
    return View(eye, direction, nowhere, nowhere, 1, 1)

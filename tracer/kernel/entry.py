"""The kernel's entry point: it traces a list of pixels.

An image is traced as many lists, a click as a list of one pixel, whose table is then kept. A single given ray is
traced as a view of one pixel.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tracer.compile.intrinsics import noinline, reference
from tracer.compile.jit import compiled, inlined, kernel
from tracer.compile.rows import Int32, Numbers, Row, Rows, as_rows, dtype_of
from tracer.formulas.camera import BATCH, View, center_directions
from tracer.formulas.double_double import dd_add
from tracer.formulas.sampler import CENTER, Sampler, sample_offset
from tracer.formulas.vector import Vector, add, scale, store, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.best_first import trace_best_first
from tracer.kernel.closest_hit import transmit
from tracer.kernel.coincident_surfaces import change_medium, is_concave, is_entering
from tracer.kernel.limits import Limits
from tracer.kernel.node_rows import start_row
from tracer.kernel.nodes import CAMERA, KINDS, SHADOW, NodeRow
from tracer.kernel.trace import trace_tree
from tracer.kernel.workspace import Eyes, Space, Workspace
from tracer.rays import make_ray

# After so many rays of one kind, about a tenth of a second, a call returns before its list is done, even between two
# samples of a pixel, so that it can be cancelled.
ENOUGH = 2**18


class PixelRow(Row):
    """A pixel, and which of its samples to trace: from number `first` to before `end`."""

    x: Int32
    y: Int32
    first: Int32
    end: Int32


PIXEL = dtype_of(PixelRow)


class Batch(NamedTuple):
    """The notes of `trace_rays_in_turn` about n rays."""

    starts: np.ndarray  # (n + 1,) the first row of each tree, and the end of the last
    residuals: np.ndarray  # (n,)
    done: np.ndarray  # (1,) number of rays that are traced


class Counts(NamedTuple):
    """Numbers of rays, of intersection tests, and of trees that the limit of rows ended."""

    rays: np.ndarray  # by kind, as KINDS numbers them
    tests: np.ndarray  # (1,): ray-surface intersection tests
    limited: np.ndarray  # (1,): trees


@kernel
def trace_pixels(
    world: Arrays,
    view: View,
    limits: Limits,
    sampler: Sampler,
    pixels: Rows[PixelRow],
    before: Numbers,
    sums: Numbers,
    space: Space,
) -> int:
    """Trace the samples of each pixel, and add them up.

    `before` (n, 4) are the sums over the samples so far: red, green, blue, and the weight that was cut. `sums` (n,
    4) become the new sums. Returns the number of finished pixels: all, or fewer after ENOUGH rays. Of the next pixel,
    `sums` are then those over its samples before number `space.resume`. Returns -1 if a tree needs a longer table; the
    call must then be repeated.
    """
    rays = space.rays
    rays[:] = 0
    space.tests[:] = 0
    space.limited[:] = 0
    for k in range(len(pixels)):
        if sampler.kind == CENTER and k % BATCH == 0:
            center_directions(world.formulas.pixel_direction, view, pixels, k, space.directions)
        total, residual = vector(before[k]), before[k, 3]
        for sample in range(pixels[k].first, pixels[k].end):
            if is_enough(rays):
                store(sums[k], total)
                sums[k, 3] = residual
                space.resume[0] = sample
                return k
            direction = camera_direction(world, view, sampler, pixels, k, sample, space)
            start_camera_ray(world, view.eye, space.eye_solids, space.eye_surfaces, limits, direction, space)
            if not trace_one(world, limits, space):
                return -1
            total = add(total, vector(space.table[0].radiance))
            residual += space.tree[1]
            space.limited[0] += int(space.tree[2])
        store(sums[k], total)
        sums[k, 3] = residual
    return len(pixels)


@inlined
def trace_one(world: Arrays, limits: Limits, space: Space) -> bool:
    """Trace the tree whose camera ray is row 0, and note its size in `space.tree`. False if the table is too short."""
    is_best_first = limits.tolerance >= 0.0
    space.tree[2] = 0.0
    count = trace_best_first(world, limits, space) if is_best_first else trace_tree(world, limits, space)
    space.tree[0] = count
    if count < 0:
        return False
    space.tree[1] = count_rays(space, count)
    return True


@kernel
def trace_rays_in_turn(
    world: Arrays, limits: Limits, rays: Numbers, eyes: Eyes, into: Rows[NodeRow], batch: Batch, space: Space
) -> int:
    """Trace the trees of given rays (n, 6), origins and unit directions.

    Their rows go to `into`, one tree after another, beginning with ray number `batch.done[0]`. Returns 0 when all are
    done, 1 if `into` is too short for the next tree, -1 if the workspace is. Then the call must be repeated with more.
    """
    for k in range(batch.done[0], len(rays)):
        origin, nowhere = (rays[k, 0], rays[k, 1], rays[k, 2]), (0.0, 0.0, 0.0)
        view = View(origin, (rays[k, 3], rays[k, 4], rays[k, 5]), nowhere, nowhere, 1, 1)
        direction = world.formulas.pixel_direction(view, 0.5, 0.5)
        m = eyes.point[k]
        touched = eyes.surfaces[eyes.starts[m] : eyes.starts[m + 1]]
        start_camera_ray(world, origin, eyes.solids[m], touched, limits, direction, space)
        if not trace_one(world, limits, space):
            return -1
        first, count = batch.starts[k], int(space.tree[0])
        if first + count > len(into):
            return 1
        for i in range(count):
            into[first + i] = space.table[i]
            row = into[first + i]
            row.id += first
            row.parent = row.parent + first if row.parent >= 0 else row.parent
        batch.starts[k + 1] = first + count
        batch.residuals[k] = space.tree[1]
        batch.done[0] = k + 1
    return 0


@inlined
def is_enough(rays: Numbers) -> bool:
    """Whether ENOUGH rays of one kind have been traced.

    Compares the counters one by one: a vector load would stall on the store of the counter that was just incremented
    (store-to-load forwarding).
    """
    kind = 0
    while kind < len(rays) and rays[kind] < ENOUGH:
        kind += 1
    return kind < len(rays)


@inlined
def camera_direction(
    world: Arrays, view: View, sampler: Sampler, pixels: Rows[PixelRow], k: int, sample: int, space: Space
) -> Vector:
    """The direction of a camera ray through a sample point of pixel k."""
    if sampler.kind == CENTER:
        column = k % BATCH
        return (space.directions[0, column], space.directions[1, column], space.directions[2, column])
    x, y = pixels[k].x, pixels[k].y
    dx, dy = sample_offset(x, y, sample, sampler)
    return world.formulas.pixel_direction(view, x + dx, y + dy)


@inlined
def start_camera_ray(
    world: Arrays, eye: Vector, around: Numbers, touched: Numbers, limits: Limits, direction: Vector, space: Space
) -> None:
    """Write row 0 of the table: the camera ray, before it is traced. `around` and `touched` are those of `Eye`."""
    row = start_row(limits, space.table, 0, -1, CAMERA, 0, (1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
    store(row.origin, eye)
    store(row.direction, direction)
    row.start = -1
    row.side = 0.0
    store(row.history.approach, (0.0, 0.0, 0.0))
    store(row.history.before, (0.0, 0.0, 0.0))
    row.magnitude = abs(eye[0]) + abs(eye[1]) + abs(eye[2])
    for word in range(len(around)):
        space.solids[0, 0, word] = around[word]
        space.solids[0, 1, word] = around[word]
    if len(touched) > 0:
        start_on_surfaces(world, touched, space)


@compiled
def start_on_surfaces(world: Arrays, touched: Numbers, space: Space) -> None:
    """Start the camera ray of an eye that lies exactly on surfaces.

    If it points into a transparent solid, it starts inside; if it points out, outside. Neither makes a row. If it
    points into an opaque one, it hits it at distance 0.
    """
    noinline()
    row = space.table[0]
    ray = make_ray(vector(row.origin), vector(row.direction), -1, 0.0, row.magnitude, reference(row.history))
    for k in range(len(touched)):
        group = eye_group(world, touched[k])
        enters, leaves = -1, -1
        for s in touched:
            if eye_group(world, s) == group and is_entering(world, s, ray, 0.0):
                enters = s
            elif eye_group(world, s) == group:
                leaves = s
        if world.surfaces[touched[k]].solid >= 0:
            change_medium(world, group, enters, leaves, space.solids[0, 0], space.solids[0, 1])
        elif transmit(world, touched[k]) == 0.0 and enters >= 0 and (leaves < 0 or is_concave(world, enters, leaves)):
            row.surface = enters
    for word in range(space.solids.shape[2]):
        space.solids[0, 0, word] = space.solids[0, 1, word]
    if row.surface >= 0:
        return
    row.start = world.surfaces[touched[0]].coincident
    row.side = -1.0 if is_entering(world, touched[0], ray, 0.0) else 1.0
    # As if it had come from ahead, so that it turns back from all other surfaces there.
    store(row.history.approach, scale(-1.0 - row.magnitude, vector(row.direction)))


@inlined
def eye_group(world: Arrays, s: int) -> int:
    """A number that the surfaces of one solid have in common, or those of one object that bounds none."""
    surface = world.surfaces[s]
    return surface.solid if surface.solid >= 0 else -1 - surface.object


@inlined
def count_rays(space: Space, count: int) -> float:
    """Count the rays in the table. Returns the sum of the weights that were cut, rounded once."""
    cut = (0.0, 0.0)
    for i in range(count):
        row = space.table[i]
        space.rays[row.kind] += 1
        if row.kind != SHADOW and row.cut > 0.0:
            cut = dd_add(cut, (row.cut, 0.0))
    return cut[0] + cut[1]


def trace_list(
    world: Arrays,
    view: View,
    limits: Limits,
    sampler: Sampler,
    pixels: Rows[PixelRow],
    workspace: Workspace,
    before: np.ndarray | None = None,
    cancelled: Callable[[], bool] = lambda: False,
) -> tuple[np.ndarray, Counts] | None:
    """Trace all pixels of a list, with as much memory as their trees need.

    Returns the sums (n, 4) over the samples, including those in `before`, and the counts; None if cancelled.
    """
    before = _no_sums(len(pixels)) if before is None else before
    sums = np.zeros((len(pixels), 4))
    counts = Counts(np.zeros(len(KINDS), np.int64), np.zeros(1, np.int64), np.zeros(1, np.int64))
    done = 0
    while True:
        reached = trace_pixels(world, view, limits, sampler, pixels[done:], before[done:], sums[done:], workspace.space)
        if reached < 0:
            workspace.grow()
            continue
        counts.rays[:] += workspace.arrays.rays
        counts.tests[:] += workspace.arrays.tests
        counts.limited[:] += workspace.arrays.limited
        done += reached
        if done == len(pixels):
            return sums, counts
        if cancelled():
            return None
        pixels, before = pixels.copy(), before.copy()  # the caller's stay as they are
        pixels["first"][done] = workspace.arrays.resume[0]
        before[done] = sums[done]


def one_pixel(x: int, y: int, first: int = 0, end: int = 1) -> Rows[PixelRow]:
    """A list of one pixel."""
    return as_rows(np.array([(x, y, first, end)], PIXEL), PixelRow)


def ray_view(origin: Vector, direction: Vector) -> View:
    """A view of one pixel, whose ray is this one. `direction` is a unit vector."""
    nowhere = (0.0, 0.0, 0.0)
    return View(origin, direction, nowhere, nowhere, 1, 1)


@lru_cache(maxsize=16)
def _no_sums(count: int) -> np.ndarray:
    """Sums of no samples. Lists of whole tiles have few different lengths."""
    return np.zeros((count, 4))

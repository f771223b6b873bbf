"""Traces the tree behind one pixel, or behind a ray given by hand."""

import math
import operator
from collections.abc import Sequence

import numpy as np

from tracer.choices import MODELS, SAMPLERS, SOBOL
from tracer.compile.rows import as_rows, dtype_of
from tracer.fields import LARGEST
from tracer.formulas.camera import View, direction_error
from tracer.formulas.sampler import PIXEL_CENTER, image_point, make_sampler
from tracer.formulas.vector import as_floats, rescale, unit, vector
from tracer.kernel.entry import one_pixel, ray_view, trace_list
from tracer.kernel.limits import BREADTH_FIRST, image_max_nodes, make_limits
from tracer.kernel.nodes import PUBLIC, NodeRow, PublicRow, RecordedRow
from tracer.kernel.workspace import Workspace
from tracer.kernel.world import World
from tracer.tree.error_propagation import propagate_errors
from tracer.tree.light_errors import propagate_light_errors
from tracer.tree.margins.margins import Details
from tracer.tree.raytree import RayTree

RECORDED = dtype_of(RecordedRow).names or ()  # the columns that the kernel fills


def trace(
    world: World,
    pixel: tuple[int, int] | None = None,
    ray: tuple[Sequence[float], Sequence[float]] | None = None,
    *,
    depth: int | None = None,
    size: tuple[int, int] | None = None,
    sample: int | None = None,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    missing: float | None = None,
    max_rays: int | None = None,
    max_nodes: int | None = None,
    model: str | None = None,
    sampler: str = SAMPLERS[SOBOL],
    samples: int | None = None,
) -> RayTree:
    """The tree behind a pixel (x, y) of the image, counted from the top left, or behind a ray (origin, direction).

    `size` (width, height), `depth` and `model` are the scene's by default. `sample` is the number of one of the pixel's
    sample points, from 0, by default its centre. The number of `samples`, the scene's by default, says where jittered
    points lie; a Sobol point is the same for any number. `min_weight` cuts rays whose largest weight is below it. With
    a `tolerance`, the heaviest rays are traced first, to any depth unless one is given, until the weights of the rest
    sum up to no more than that. With `missing` in its place, until the rest can add no more light than that to any
    channel: `bound` is at most `missing`. In a scene without light, that is so after the first ray.

    The tree has at most `max_nodes` rows, each ray counted with all shadow rays that its hit could have. By default it
    is the limit that `tracer.render` gives to the trees of an image of this size with this number of `samples` and of
    `max_rays`, so that the tree ends where that of the image ends. A ray counts as an image of one pixel.

    ValueError for a pixel outside the image, a ray without a direction, or another value that is not allowed;
    MissingBoundError, a ValueError, for `missing` where the light of a ray has no bound.
    """
    if (pixel is None) == (ray is None):
        raise ValueError("either a pixel or a ray is traced: give one of them")
    camera = world.view(size)
    pixels = camera.width * camera.height if ray is None else 1
    count = _number_of_samples(world, ray is not None, sample, samples)
    max_nodes = image_max_nodes(world, pixels, count, max_rays, max_nodes)
    limits = make_limits(world, depth, min_weight, tolerance, max_nodes, model, missing=missing, records=True)
    if pixel is not None:
        x, y = (operator.index(value) for value in pixel)
        if not (0 <= x < camera.width and 0 <= y < camera.height):
            raise ValueError(f"pixel must be within 0,0 .. {camera.width - 1},{camera.height - 1}, got {x},{y}")
        view = camera
    else:
        assert ray is not None
        x, y = 0, 0
        view = _ray_view(*ray)
    points = PIXEL_CENTER.sampler if sample is None else make_sampler(sampler, max(count, sample + 1))
    first = sample or 0
    workspace = Workspace(world.eye(view.eye))
    trace_list(world.arrays, view, limits, points, one_pixel(x, y, first, first + 1), workspace)
    space = workspace.arrays
    rows = int(space.tree[0])
    turn = 0.0 if pixel is None else direction_error(camera, world.scene.camera.up, vector(space.table["direction"][0]))
    nodes, details = public_rows(world, space.table, rows, limits.model, turn)
    residual = float(space.tree[1])
    best_first = limits.tolerance != BREADTH_FIRST
    return RayTree(
        world,
        nodes,
        details,
        residual,
        depth=int(nodes["depth"].max()) if best_first and depth is None else limits.depth,
        model=MODELS[limits.model],
        pixel=pixel and (x, y),
        size=(camera.width, camera.height),
        tolerance=limits.tolerance if best_first else None,
        missing_allowed=missing,
        max_nodes=limits.max_nodes,
        image_point=image_point(x, y, first, points),
        sample=sample,
        samples=count,
        ray=None if ray is None else (as_floats(ray[0]), as_floats(ray[1])),
    )


def _number_of_samples(world: World, is_by_hand: bool, sample: int | None, samples: int | None) -> int:
    """The number of samples of a pixel. ValueError if there is no such sample."""
    if samples is not None and samples < 1:
        raise ValueError(f"samples must be >= 1, got {samples}")
    if sample is not None and is_by_hand:
        raise ValueError(f"a ray that is given by hand has no samples, got sample {sample}")
    if sample is not None and not 0 <= sample < (samples or math.inf):
        allowed = f"within 0 .. {samples - 1}" if samples else ">= 0"
        raise ValueError(f"sample must be {allowed}, got {sample}")
    return samples or world.scene.image.samples


def _ray_view(origin: Sequence[float], direction: Sequence[float]) -> View:
    numbers = [*map(float, origin), *map(float, direction)]
    if len(numbers) != 6 or not all(map(math.isfinite, numbers)):
        raise ValueError(f"a ray must be six finite numbers, got {numbers}")
    if max(map(abs, numbers[:3])) > LARGEST:
        raise ValueError(f"a ray's origin must be within {LARGEST:g}, got {numbers[:3]}")
    if not any(numbers[3:]):
        raise ValueError("a ray's direction must not be 0,0,0")
    return ray_view((numbers[0], numbers[1], numbers[2]), unit(rescale(numbers[3:])))


def public_rows(
    world: World, table: np.ndarray, count: int, model: int, first_turn: float = 0.0
) -> tuple[np.ndarray, Details]:
    """The first `count` rows of a node table as readers get them, with errors and angles, and what they do not see.

    The camera rays are off by `first_turn`, besides their rounding.
    """
    nodes = np.zeros(count, PUBLIC)
    for name in RECORDED:
        nodes[name] = table[name][:count]
    rows, told = as_rows(table, NodeRow), as_rows(nodes, PublicRow)
    bends = propagate_errors(world.arrays, rows, told, count, first_turn)
    propagate_light_errors(world.arrays, rows, told, count, model, bends)
    _fill_angles(nodes)
    nodes.flags.writeable = False
    start, surface, magnitude, face_normal, hit_side = (
        table[name][:count].copy() for name in ("start", "surface", "magnitude", "face_normal", "hit_side")
    )
    hit_side[np.isnan(nodes["normal"][:, 0])] = 0.0  # the kernel leaves it as it was
    return nodes, Details(start, surface, magnitude, face_normal, bends, hit_side)


def _fill_angles(nodes: np.ndarray) -> None:
    """Compute theta1 and theta2 from the recorded vectors. Readers need them, images do not."""
    hit = np.flatnonzero(np.isfinite(nodes["normal"][:, 0]))
    d, n = nodes["direction"][hit], nodes["normal"][hit]
    across = np.cross(d, n)
    s1 = np.sqrt((across * across).sum(axis=1))
    theta1 = np.arctan2(s1, -(d * n).sum(axis=1))
    nodes["theta1"][hit] = theta1
    n1, n2, radicand = nodes["n1"][hit], nodes["n2"][hit], nodes["radicand"][hit]
    bent = radicand > 0.0  # false where it is NaN
    s2 = n1[bent] / n2[bent] * s1[bent]
    theta2 = np.where(n1[bent] == n2[bent], theta1[bent], np.arctan2(s2, np.sqrt(radicand[bent])))
    nodes["theta2"][hit[bent]] = theta2

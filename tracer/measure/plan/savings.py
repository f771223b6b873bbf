"""The rays and seconds that a left-out capability saves a scene, and those that a needed one costs.

For each capability the scene is rendered with and without it, in turn. The image is small and traced by one thread,
so that a whole plan takes seconds. Rays are counted, not estimated.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from tracer.formulas.sampler import PIXEL_CENTER
from tracer.image.film import Film
from tracer.image.passes import trace_passes
from tracer.image.render import Image, render
from tracer.image.task import Task, Work
from tracer.image.tiles import make_tiles
from tracer.image.warmup import warm_up
from tracer.kernel.capabilities import Capability, Need
from tracer.kernel.limits import make_limits
from tracer.kernel.nodes import KINDS
from tracer.kernel.world import World, prepare
from tracer.measure.plan.paired_timing import PairedTimes, cpu_seconds, paired
from tracer.measure.plan.variants import Variant
from tracer.measure.plan.with_capability import WITH, depth_of, everything
from tracer.measure.plan.without_capability import WITHOUT

MAX_PIXELS = 80_000
FAST, SLOW = 0.015, 0.5  # seconds that the scene's own image may take, and any other image
PROBE = 64  # pixels of the first image that is tried
MEASURABLE = 0.02  # smallest duration from which the time per pixel is estimated
BUDGET = 0.7  # seconds per capability
UNNOTICED = 2.0**-200  # pictures that differ by less are the same

Size = tuple[int, int]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Saving:
    """The measured cost of a capability."""

    need: Need
    how: str  # what was compared, or why nothing was
    times: PairedTimes | None = None
    rays: tuple[int, int] | None = None  # without it, with it
    size: Size | None = None  # of the image
    changed: int = 0  # number of pixels whose colour differs
    estimated: bool = False  # whether the time is a number of rays times the time per ray


@dataclass(frozen=True)
class Measured:
    """A measured plan, and the image that it is about."""

    size: Size
    depth: int
    rays: dict[str, int]
    savings: list[Saving]
    together: Saving  # everything at once that the kernel leaves out


@dataclass(frozen=True)
class Shot:
    """A variant, ready to be rendered at any size."""

    world: World
    variant: Variant
    depth: int

    def __call__(self, size: Size) -> Image:
        return render(self.world, size, **{"depth": self.depth, "threads": 1, **self.variant.options})

    def seconds(self, size: Size) -> float:
        """Processor time of an image."""
        return cpu_seconds(lambda: self(size))


def measure(world: World, progress: Progress = lambda share: None) -> Measured:
    """Measure every capability."""
    warm_up()
    own = Shot(world, Variant("", world.scene), depth_of(world.scene))
    size = fast_size(own, world.view().width, world.view().height)
    savings = []
    for k, need in enumerate(world.needs):
        progress(k / (len(world.needs) + 1))
        savings.append(saving_of(need, own, size))
    progress(len(savings) / (len(savings) + 1))
    together = compared(Need("all at once", False, ""), own, everything(world.scene, world.left_out), size)
    return Measured(size, own.depth, own(size).rays, savings, together)


def saving_of(need: Need, own: Shot, size: Size) -> Saving:
    """The cost of one capability for a scene."""
    if need.name == Capability.LIGHT_FROM_BEHIND:
        return light_from_behind(need, own, size)
    make = (WITHOUT if need.needed else WITH).get(need.name)
    if make is None:
        return Saving(need, "no part of an image")
    variant = make(own.world.scene)
    return Saving(need, variant) if isinstance(variant, str) else compared(need, own, variant, size)


def compared(need: Need, own: Shot, variant: Variant, size: Size) -> Saving:
    """Render a scene and a variant of it in turn."""
    other = Shot(prepare(variant.scene, variant.hierarchy), variant, own.depth)
    size = bearable_size(other, size)
    without, with_it = (other, own) if need.needed else (own, other)
    first, second = without(size), with_it(size)
    changed = np.abs(first.pixels - second.pixels).max(axis=2) > UNNOTICED
    times = paired(lambda: without.seconds(size), lambda: with_it.seconds(size), BUDGET)
    rays = (sum(first.rays.values()), sum(second.rays.values()))
    return Saving(need, variant.how, times, rays, size, int(changed.sum()))


def light_from_behind(need: Need, own: Shot, size: Size) -> Saving:
    """The shadow rays that an image does not trace. Trees have them: from every hit to every light.

    The time of one is measured on a scene where each light is doubled by a black one at its place.
    """
    scene = own.world.scene
    if not scene.lights:
        return Saving(need, "no light")
    rays = own(size).rays
    skipped = tree_rays(own, size)["shadow"] - rays["shadow"]
    count = (sum(rays.values()), sum(rays.values()) + skipped)
    if rays["shadow"] == 0:
        return Saving(need, "no shadow ray, so its time cannot be measured", None, count, size)
    black = tuple(replace(light, color=(0.0, 0.0, 0.0)) for light in scene.lights)
    doubled = Shot(prepare(replace(scene, lights=scene.lights + black)), own.variant, own.depth)
    times = paired(lambda: own.seconds(size), lambda: doubled.seconds(size), BUDGET)
    share = skipped / (doubled(size).rays["shadow"] - rays["shadow"])
    times = replace(times, extra=share * times.extra, uncertainty=share * times.uncertainty)
    return Saving(need, "every light from every hit (estimated)", times, count, size, 0, True)


def tree_rays(shot: Shot, size: Size) -> dict[str, int]:
    """The rows of all pixels' trees, by kind."""
    limits = make_limits(shot.world, shot.depth, records=True)
    film = Film(*size)
    task = Task.of(shot.world, shot.world.view(size), limits, PIXEL_CENTER.sampler)
    works = [Work(tile) for tile in make_tiles(*size)]
    with ThreadPoolExecutor(1) as executor:
        trace_passes(task, [works], executor, 1, lambda traced, share: film.add(traced), film.pixels)
    return {kind: int(n) for kind, n in zip(KINDS, film.totals.rays, strict=True)}


def fast_size(shot: Shot, width: int, height: int) -> Size:
    """The size of a small image of these proportions that takes FAST seconds."""
    size = shrunk((width, height), MAX_PIXELS / (width * height))
    return shrunk(size, FAST / seconds_per_pixel(shot, size) / (size[0] * size[1]))


def bearable_size(shot: Shot, size: Size) -> Size:
    """This size, or a smaller one if the image would take more than SLOW seconds."""
    return shrunk(size, SLOW / seconds_per_pixel(shot, size) / (size[0] * size[1]))


def seconds_per_pixel(shot: Shot, size: Size) -> float:
    """The approximate time per pixel, from images of increasing size until one takes MEASURABLE seconds."""
    pixels = PROBE
    while True:
        probe = shrunk(size, pixels / (size[0] * size[1]))
        took = min(shot.seconds(probe) for _ in range(3))
        if took > MEASURABLE or probe == size:
            return took / (probe[0] * probe[1])
        pixels *= 4


def shrunk(size: Size, share: float) -> Size:
    """A size with this share of the pixels, if the share is below 1."""
    factor = min(1.0, share) ** 0.5
    return max(1, round(size[0] * factor)), max(1, round(size[1] * factor))

"""The rays and seconds that a left-out capability saves a scene, and those that a needed one costs.

For each capability the scene is rendered with and without it, in turn. The image is small and traced by one thread,
so that a whole plan takes seconds. Rays are counted, not estimated. The size of the image and the number of its runs
follow from counts, too, so they are the same in every plan.
"""

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
from tracer.measure.plan.paired_timing import PairedTimes, paired
from tracer.measure.plan.variants import Variant
from tracer.measure.plan.with_capability import WITH, depth_of, everything
from tracer.measure.plan.without_capability import WITHOUT
from tracer.measure.timing import clocked
from tracer.measure.work import Size, affordable, shrunk, work_of
from tracer.progress import Progress, divided, ignore

MAX_PIXELS = 80_000
FAST, SLOW = 150_000, 3_000_000  # work of the scene's own image, and of any other image, at most
BUDGET = 7_000_000  # work of all runs of a comparison, if that is more than FEWEST and fewer than MOST pairs
FEWEST, MOST = 5, 25  # pairs of runs
UNNOTICED = 2.0**-200  # pictures that differ by less are the same


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
        """Processor time of an image: that of other programs does not count."""
        return clocked(lambda: self(size))[1].cpu


@dataclass(frozen=True)
class Comparison:
    """Two images to be timed in turn, and what is known of them before."""

    saving: Saving
    without: Shot
    with_it: Shot
    size: Size
    work: int  # of both images
    share: float = 1.0  # of the difference that the capability makes

    @property
    def pairs(self) -> int:
        return max(FEWEST, min(MOST, BUDGET // self.work))

    def timed(self, progress: Progress) -> Saving:
        times = paired(
            lambda: self.without.seconds(self.size), lambda: self.with_it.seconds(self.size), self.pairs, progress
        )
        times = replace(times, extra=self.share * times.extra, uncertainty=self.share * times.uncertainty)
        return replace(self.saving, times=times)


def measure(world: World, progress: Progress = ignore) -> Measured:
    """Measure every capability. `progress` is called with the share of the expected time of all timed runs."""
    warm_up()
    own = Shot(world, Variant("", world.scene), depth_of(world.scene))
    view = world.view()
    size = shrunk((view.width, view.height), MAX_PIXELS / (view.width * view.height))
    size = affordable(own, size, FAST)
    together = Need("all at once", False, "")
    found = [comparison_of(need, own, size) for need in world.needs]
    found.append(compared(together, own, everything(world.scene, world.left_out), size))
    progress(0.0)
    costs = [one.pairs * one.work if isinstance(one, Comparison) else 0.0 for one in found]
    parts = divided(progress, costs)
    *savings, last = [
        one.timed(part) if isinstance(one, Comparison) else one for one, part in zip(found, parts, strict=True)
    ]
    return Measured(size, own.depth, own(size).rays, savings, last)


def comparison_of(need: Need, own: Shot, size: Size) -> Comparison | Saving:
    """What is to be timed for one capability; a saving that says why if there is nothing."""
    if need.name == Capability.LIGHT_FROM_BEHIND:
        return light_from_behind(need, own, size)
    make = (WITHOUT if need.needed else WITH).get(need.name)
    if make is None:
        return Saving(need, "no part of an image")
    variant = make(own.world.scene)
    return Saving(need, variant) if isinstance(variant, str) else compared(need, own, variant, size)


def compared(need: Need, own: Shot, variant: Variant, size: Size) -> Comparison:
    """A scene and a variant of it."""
    other = Shot(prepare(variant.scene, variant.hierarchy), variant, own.depth)
    size = affordable(other, size, SLOW)
    without, with_it = (other, own) if need.needed else (own, other)
    first, second = without(size), with_it(size)
    changed = np.abs(first.pixels - second.pixels).max(axis=2) > UNNOTICED
    rays = (sum(first.rays.values()), sum(second.rays.values()))
    saving = Saving(need, variant.how, None, rays, size, int(changed.sum()))
    return Comparison(saving, without, with_it, size, work_of(first) + work_of(second))


def light_from_behind(need: Need, own: Shot, size: Size) -> Comparison | Saving:
    """The shadow rays that an image does not trace. Trees have them: from every hit to every light.

    The time of one is measured on a scene where each light is doubled by a black one at its place.
    """
    scene = own.world.scene
    if not scene.lights:
        return Saving(need, "no light")
    image = own(size)
    rays = image.rays
    skipped = tree_rays(own, size)["shadow"] - rays["shadow"]
    count = (sum(rays.values()), sum(rays.values()) + skipped)
    if rays["shadow"] == 0:
        return Saving(need, "no shadow ray, so its time cannot be measured", None, count, size)
    black = tuple(replace(light, color=(0.0, 0.0, 0.0)) for light in scene.lights)
    doubled = Shot(prepare(replace(scene, lights=scene.lights + black)), own.variant, own.depth)
    more = doubled(size)
    share = skipped / (more.rays["shadow"] - rays["shadow"])
    saving = Saving(need, "every light from every hit (estimated)", None, count, size, 0, True)
    return Comparison(saving, own, doubled, size, work_of(image) + work_of(more), share)


def tree_rays(shot: Shot, size: Size) -> dict[str, int]:
    """The rows of all pixels' trees, by kind."""
    limits = make_limits(shot.world, shot.depth, records=True)
    film = Film(*size)
    task = Task.of(shot.world, shot.world.view(size), limits, PIXEL_CENTER.sampler)
    works = [Work(tile) for tile in make_tiles(*size)]
    with ThreadPoolExecutor(1) as executor:
        trace_passes(task, [works], executor, 1, lambda traced, share: film.add(traced), film.pixels)
    return {kind: int(n) for kind, n in zip(KINDS, film.totals.rays, strict=True)}

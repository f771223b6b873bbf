"""What leaving a capability out saves this scene, and what one costs that it needs: rays counted, seconds measured.

For each line the scene is rendered in two ways in turn; `variants` and `plainer` say what the other way is. The image
is small and traced on one thread, so that a whole plan takes seconds; rays are counted, not estimated.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from tracer.image.job import Job, passes
from tracer.image.passes import trace_passes
from tracer.image.render import Image, render, warm
from tracer.kernel.left_out import Need
from tracer.kernel.limits import make_limits
from tracer.kernel.nodes import KINDS
from tracer.kernel.world import World, prepare
from tracer.measure.plan.imports import import_seconds
from tracer.measure.plan.paired_timing import PairedTimes, cpu_seconds, paired
from tracer.measure.plan.with_capability import WITH, Variant, depth_of, everything
from tracer.measure.plan.without_capability import WITHOUT

MOST_PIXELS = 80_000
QUICK, SLOW = 0.015, 0.5  # seconds that the scene's own image may take, and any other
PROBE = 64  # pixels of the first image that is tried
TELLING = 0.02  # seconds: less is not enough to tell by how long more pixels take
BUDGET = 0.7  # seconds a line
UNNOTICED = 2.0**-200  # pictures that differ by less are the same

Size = tuple[int, int]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Saving:
    """What a capability is worth: in seconds, and in rays where it is about rays."""

    need: Need
    how: str  # what was compared; or why nothing was
    turns: PairedTimes | None = None
    rays: tuple[int, int] | None = None  # without it, with it
    size: Size | None = None  # of the image
    changed: int = 0  # pixels that have another colour with it
    estimated: bool = False  # the seconds: so many rays by what one takes


@dataclass(frozen=True)
class Measured:
    """The lines of a plan, and the image they are about."""

    size: Size
    depth: int
    rays: dict[str, int]
    lines: list[Saving]
    together: Saving  # everything that the kernel leaves out, done at once


@dataclass(frozen=True)
class Shot:
    """A way to render an image."""

    world: World
    variant: Variant
    depth: int

    def __call__(self, size: Size) -> Image:
        options = {"depth": self.depth, "threads": 1, **self.variant.options}
        images = [render(self.world, size, **options) for _ in range(self.variant.images)]
        return replace(images[0], rays={kind: sum(image.rays[kind] for image in images) for kind in KINDS})

    def work(self, size: Size) -> float:
        """Seconds of processor time that it takes."""
        return cpu_seconds(lambda: self(size))


def measure(world: World, progress: Progress = lambda share: None) -> Measured:
    """Every line of the scene's plan."""
    warm()
    own = Shot(world, Variant("", world.scene), depth_of(world.scene))
    size = quick_size(own, world.view().width, world.view().height)
    lines = []
    for k, need in enumerate(world.needs):
        progress(k / (len(world.needs) + 1))
        lines.append(line(need, own, size))
    progress(len(lines) / (len(lines) + 1))
    together = compared(Need("all at once", False, ""), own, everything(world.scene, world.left_out), size)
    return Measured(size, own.depth, own(size).rays, lines, together)


def line(need: Need, own: Shot, size: Size) -> Saving:
    """What one capability is worth to a scene."""
    if need.name == "mesh library":
        _, loading = import_seconds(["trimesh"])
        return Saving(need, "import trimesh", PairedTimes(0.0, loading, 0.0, 1))
    if need.name == "light from behind":
        return unlit(need, own, size)
    make = (WITHOUT if need.needed else WITH)[need.name]
    variant = make(own.world.scene)
    return Saving(need, variant) if isinstance(variant, str) else compared(need, own, variant, size)


def compared(need: Need, own: Shot, variant: Variant, size: Size) -> Saving:
    other = Shot(prepare(variant.scene, variant.hierarchy), variant, own.depth)
    size = bearable_size(other, size)
    without, with_it = (other, own) if need.needed else (own, other)
    first, second = without(size), with_it(size)
    changed = np.abs(first.pixels - second.pixels).max(axis=2) > UNNOTICED
    turns = paired(lambda: without.work(size), lambda: with_it.work(size), BUDGET)
    rays = (sum(first.rays.values()), sum(second.rays.values()))
    return Saving(need, variant.how, turns, rays, size, int(changed.sum()))


def unlit(need: Need, own: Shot, size: Size) -> Saving:
    """Shadow rays that the image does without: the trees show them, one from every hit to every light.

    What one takes is measured with each light doubled by a black one, which is asked for where the light is.
    """
    scene = own.world.scene
    if not scene.lights:
        return Saving(need, "no light")
    rays = own(size).rays
    skipped = tree_rays(own, size)["shadow"] - rays["shadow"]
    count = (sum(rays.values()), sum(rays.values()) + skipped)
    if rays["shadow"] == 0:
        return Saving(need, "no shadow ray whose time could be taken", None, count, size)
    black = tuple(replace(light, color=(0.0, 0.0, 0.0)) for light in scene.lights)
    doubled = Shot(prepare(replace(scene, lights=scene.lights + black)), own.variant, own.depth)
    turns = paired(lambda: own.work(size), lambda: doubled.work(size), BUDGET)
    share = skipped / (doubled(size).rays["shadow"] - rays["shadow"])
    turns = replace(turns, extra=share * turns.extra, doubt=share * turns.doubt)
    return Saving(need, "every light from every hit (estimated)", turns, count, size, 0, True)


def tree_rays(shot: Shot, size: Size) -> dict[str, int]:
    """The rows of all pixels' trees, by kind."""
    limits = make_limits(shot.world, shot.depth, records=True)
    job = Job(shot.world, shot.world.view(size), limits)
    with ThreadPoolExecutor(1) as executor:
        trace_passes(job, passes(*size), executor, 1)
    return {kind: int(n) for kind, n in zip(KINDS, job.rays, strict=True)}


def quick_size(shot: Shot, width: int, height: int) -> Size:
    """The size of a small image of these proportions that is soon rendered."""
    size = shrunk((width, height), MOST_PIXELS / (width * height))
    return shrunk(size, QUICK / per_pixel(shot, size) / (size[0] * size[1]))


def bearable_size(shot: Shot, size: Size) -> Size:
    """This one, or a smaller one where the image would take too long."""
    return shrunk(size, SLOW / per_pixel(shot, size) / (size[0] * size[1]))


def per_pixel(shot: Shot, size: Size) -> float:
    """Seconds, about: by ever larger images, until one takes long enough to tell."""
    pixels = PROBE
    while True:
        probe = shrunk(size, pixels / (size[0] * size[1]))
        took = min(shot.work(probe) for _ in range(3))
        if took > TELLING or probe == size:
            return took / (probe[0] * probe[1])
        pixels *= 4


def shrunk(size: Size, share: float) -> Size:
    """A size of that share of the pixels, if it is below 1."""
    factor = min(1.0, share) ** 0.5
    return max(1, round(size[0] * factor)), max(1, round(size[1] * factor))

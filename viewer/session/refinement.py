"""Refining the image with more samples: the strategies, and a run with its curve of error over time for each setting.

A setting is a depth, a model and a strategy. Going back to one continues its image. Errors are estimated
(`tracer.image.adaptive`): they are about samples only, so the curves of two depths may coincide although one image
lacks more rays. `Run.floor` is a bound on the error due to rays that were cut.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from tracer.choices import JITTERED, RANDOM, SOBOL
from tracer.image.progressive import ProgressiveImage, RoundStats
from tracer.kernel.limits import Limits
from tracer.kernel.world import World
from tracer.scene.radiance_bound import radiance_bound
from viewer.session.image_renderer import ImageRenderer, Picture

RECENT = 6.0  # a forecast uses the rounds after 1/6 of the time
MAX_BYTES = 500e6  # of images that can be continued
BYTES_PER_PIXEL = 60


class Strategy(NamedTuple):
    """A way to distribute samples."""

    name: str
    short: str
    sampler: int
    adaptive: bool
    hint: str


STRATEGIES = (
    Strategy(
        "adaptive",
        "adaptive",
        SOBOL,
        True,
        "more samples for pixels that still change when their samples are doubled",
    ),
    Strategy("evenly everywhere", "even", SOBOL, False, "Sobol's points: at edges the error falls as N^-3/4"),
    Strategy("at random", "random", RANDOM, False, "independent points: the error falls as N^-1/2"),
    Strategy("jittered", "jittered", JITTERED, False, "one in each cell of a grid; a finer grid begins anew: N^-3/4"),
)
DISPLAYS = {  # what the image panel can show
    "image": "image",
    "error": "error map",
    "samples": "samples map",
}


@dataclass(eq=False)
class Run:
    """The image of one setting, and its error after each round."""

    depth: int
    model: str
    strategy: Strategy
    number: int  # decides on the curve's colour and marker
    image: ProgressiveImage | None  # None: dropped to save memory
    picture: Picture | None
    points: list[RoundStats] = field(default_factory=list)  # of every round with an estimate
    floor: float = 0.0  # the largest possible error due to cut rays; inf: no bound is known
    ended: bool = False  # no pixel gets more samples

    def name(self, models: Sequence[str]) -> str:
        """The curve's name. It has the model if `models`, those of all runs, differ."""
        model = f" {self.model}" if len(set(models)) > 1 else ""
        return f"depth {self.depth}{model}, {self.strategy.short}" + (" *" if math.isinf(self.floor) else "")

    def note(self, stats: RoundStats, bound: float) -> None:
        """Add a round. `bound` is an upper bound on the radiance of a ray that was cut."""
        assert self.image
        statistics = self.image.statistics
        lost = statistics.sums[..., 3] / statistics.counts
        self.floor = bound * math.sqrt(float((lost * lost).mean())) if lost.any() else 0.0
        if not math.isnan(stats.error):
            self.points.append(stats)


class Refinement:
    """All runs of the shown scene."""

    def __init__(self, renderer: ImageRenderer) -> None:
        self.renderer = renderer
        self.runs: list[Run] = []
        self.current: Run | None = None
        self.strategy = STRATEGIES[0]
        self.is_running = False
        self.shows = "image"  # one of DISPLAYS

    def forget(self) -> None:
        """Drop all runs, for another world."""
        self.runs, self.current, self.is_running = [], None, False

    def clear(self) -> None:
        """Drop all runs but the current one."""
        self.runs = [run for run in self.runs if run is self.current]

    def toggle(self) -> None:
        """Start or pause."""
        self.is_running = not self.is_running
        if not self.is_running:
            self.renderer.pause()

    def proceed(self, world: World, limits: Limits, size: tuple[int, int], model: str) -> bool:
        """Start or continue the run of this setting, once its first image is there or was paused.

        Called before every frame. Returns False if that image must be shown first.
        """
        picture = self.renderer.picture
        if not (self.is_running and picture and picture.finished):
            return True
        if self.current is None or not picture.is_endless:
            run = self._run(world, limits, size, model, picture)
        elif self.current.strategy != self.strategy:
            return False
        else:
            run = self.current
        if run.ended:
            self.renderer.picture = run.picture
            self.is_running = False
        elif run.image and run.picture:
            bound = radiance_bound(world.scene).largest

            def noted(stats: RoundStats | None) -> None:
                if stats:
                    run.note(stats, bound)
                else:
                    run.ended = True

            self.renderer.refine(run.image, run.picture, noted)
        return True

    def _run(self, world: World, limits: Limits, size: tuple[int, int], model: str, first: Picture) -> Run:
        """Find or create the run of a setting. `first` is its image without refinement."""
        setting = (limits.depth, model, self.strategy)
        found = next((r for r in self.runs if (r.depth, r.model, r.strategy) == setting), None)
        if found and not found.image:
            self.runs.remove(found)
            found = None
        if not found:
            image = ProgressiveImage(world, world.view(size), limits, self.strategy.sampler, self.strategy.adaptive)
            picture = Picture(
                first.shown.copy(), first.pixels, first.samples, 1.0, max_nodes=limits.max_nodes, is_endless=True
            )
            found = Run(limits.depth, model, self.strategy, self._free_number(), image, picture)
            self.runs.append(found)
        kept = [run for run in self.runs if run.image and run is not found]
        room = max(2, int(MAX_BYTES / (BYTES_PER_PIXEL * size[0] * size[1])))
        for old in kept[: max(0, len(kept) + 1 - room)]:
            old.image = old.picture = None
        self.current = found
        return found

    def _free_number(self) -> int:
        """The smallest number that no run has."""
        taken = {run.number for run in self.runs}
        return next(k for k in range(len(taken) + 1) if k not in taken)

    @property
    def shows_map(self) -> bool:
        """Whether a map takes the image's place."""
        run = self.current
        return self.shows != "image" and run is not None and run.image is not None and bool(run.points)

    @property
    def map(self) -> np.ndarray | None:
        """The map that takes the image's place (height, width): each pixel's error or samples; NaN: not known."""
        if not self.shows_map:
            return None
        assert self.current and self.current.image
        statistics = self.current.image.statistics
        return statistics.errors() if self.shows == "error" else statistics.counts.astype(float)


def forecast(points: Sequence[RoundStats], more: float) -> float:
    """The error after `more` seconds, by a power law through the recent rounds; NaN if there are too few."""
    recent = [p for p in points if p.error > 0.0 and p.seconds > 0.0]
    recent = [p for p in recent if p.seconds >= recent[-1].seconds / RECENT]
    if len(recent) < 2 or recent[0].seconds == recent[-1].seconds:
        return math.nan
    power, _ = np.polyfit([math.log(p.seconds) for p in recent], [math.log(p.error) for p in recent], 1)
    return recent[-1].error * (1.0 + more / recent[-1].seconds) ** min(float(power), 0.0)

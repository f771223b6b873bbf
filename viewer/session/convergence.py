"""What the error panel knows: how samples are spread, and every setting's way from error to error, kept to compare.

A setting is a depth, a model and a way to spread samples. Going back to one goes on with its image where that stopped.
Errors are estimated (`tracer.image.adaptive`), so curves of two depths may lie on each other though one of the images
lacks more rays: what those may be worth at most stands beside, as the error that no further sample takes away.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tracer.formulas.sampler import JITTERED, RANDOM, SOBOL
from tracer.image.converge import ConvergingImage, RoundStats
from tracer.kernel.limits import Limits
from tracer.kernel.world import World
from tracer.tree.bounds import radiance_bound
from viewer.session.progressive import Picture

if TYPE_CHECKING:
    from viewer.session.session import Session

LATELY = 6.0  # of the seconds so far, the part that has passed before what a forecast goes by
KEPT = 500e6  # bytes of images that can be gone on with
EACH = 60  # bytes a pixel that one takes


class Way(NamedTuple):
    """How samples are spread."""

    name: str
    short: str
    sampler: int
    adaptive: bool
    hint: str


WAYS = (
    Way("where the error is", "adaptive", SOBOL, True, "more samples for pixels that still move when theirs double"),
    Way("evenly everywhere", "even", SOBOL, False, "Sobol's points: at edges the error falls as N^-3/4"),
    Way("at random", "random", RANDOM, False, "independent points: the error falls as N^-1/2"),
    Way("jittered", "jittered", JITTERED, False, "one in each cell of a grid; a finer grid begins anew: N^-3/4"),
)
SHOWN = {  # in the image's place
    "image": "image",
    "error": "error map",
    "samples": "samples map",
}


@dataclass(eq=False)
class Run:
    """One setting's image, and what it has come to."""

    depth: int
    model: str
    way: Way
    number: int  # of its colour and marker
    made: ConvergingImage | None  # None: too long ago to be gone on with
    picture: Picture | None
    points: list[RoundStats] = field(default_factory=list)  # of every round that has an estimate
    floor: float = 0.0  # the error at most for rays that were cut; infinite: nothing bounds it
    ended: bool = False  # nothing more is to be gained

    def name(self, models: Sequence[str]) -> str:
        """`models`: those of all runs, named where there are two."""
        model = f" {self.model}" if len(set(models)) > 1 else ""
        return f"depth {self.depth}{model}, {self.way.short}" + (" *" if math.isinf(self.floor) else "")

    def note(self, reached: RoundStats, light: float) -> None:
        """After a round; `light` is what a cut ray of weight 1 is worth at most."""
        assert self.made
        sampled = self.made.sampled
        lost = sampled.sums[..., 3] / sampled.counts
        self.floor = light * math.sqrt(float((lost * lost).mean())) if lost.any() else 0.0
        if not math.isnan(reached.error):
            self.points.append(reached)


class Convergence:
    """The runs of the image on show, and whether one is to go on."""

    def __init__(self) -> None:
        self.runs: list[Run] = []
        self.current: Run | None = None
        self.way = WAYS[0]
        self.goes_on = False
        self.shows = "image"

    def forget(self) -> None:
        """Another world is on show."""
        self.runs, self.current, self.goes_on = [], None, False

    def clear(self) -> None:
        """Drop all curves but the one in the making."""
        self.runs = [run for run in self.runs if run is self.current]

    def toggle(self, session: "Session") -> None:
        """Give pixels more rays, or pause; what there is stays."""
        self.goes_on = not self.goes_on
        session.wants_error = self.goes_on
        if not self.goes_on:
            session.image.pause()

    def set_way(self, session: "Session", way: Way) -> None:
        """Spread samples in this way; what the others have come to stays to be compared."""
        changed, self.way = way != self.way, way
        if changed and self.goes_on and session.world:
            session.render()

    def go_on(self, session: "Session") -> None:
        """Once the image of one ray a pixel is there, or where it was paused; asked every frame."""
        picture = session.image.picture
        if not (session.world and self.goes_on and picture and picture.finished):
            return
        if self.current is None or not picture.endless:
            run = self.run(session.world, session.limits, session.size, session.model, picture)
        elif self.current.way != self.way:
            session.render()
            return
        else:
            run = self.current
        if run.ended:
            session.image.picture = run.picture
            self.goes_on = False
        elif run.made and run.picture:
            light = radiance_bound(session.world.scene)

            def noted(reached: RoundStats | None) -> None:
                if reached:
                    run.note(reached, light)
                else:
                    run.ended = True

            session.image.refine(run.made, run.picture, noted)

    def run(self, world: World, limits: Limits, size: tuple[int, int], model: str, first: Picture) -> Run:
        """This setting's, gone on with or begun; `first` is its image of one ray a pixel."""
        found = next((r for r in self.runs if (r.depth, r.model, r.way) == (limits.depth, model, self.way)), None)
        if found and not found.made:
            self.runs.remove(found)
            found = None
        if not found:
            made = ConvergingImage(world, world.view(size), limits, self.way.sampler, self.way.adaptive)
            picture = Picture(made.job, first.shown.copy(), share=1.0, endless=True)
            found = Run(limits.depth, model, self.way, self._free(), made, picture)
            self.runs.append(found)
        kept = [run for run in self.runs if run.made and run is not found]
        room = max(2, int(KEPT / (EACH * size[0] * size[1])))
        for old in kept[: max(0, len(kept) + 1 - room)]:
            old.made = old.picture = None
        self.current = found
        return found

    def _free(self) -> int:
        """The first number that no run has."""
        taken = {run.number for run in self.runs}
        return next(k for k in range(len(taken) + 1) if k not in taken)

    @property
    def shows_map(self) -> bool:
        """Whether there is one, and it is asked for."""
        run = self.current
        return self.shows != "image" and run is not None and run.made is not None and bool(run.points)

    @property
    def map(self) -> np.ndarray | None:
        """What is shown instead of the image (height, width): each pixel's error or its samples; NaN: not known."""
        if not self.shows_map:
            return None
        assert self.current and self.current.made
        sampled = self.current.made.sampled
        return sampled.errors() if self.shows == "error" else sampled.counts.astype(float)


def forecast(points: Sequence[RoundStats], more: float) -> float:
    """The error after so many seconds more, if it goes on falling as lately; NaN: no telling."""
    late = [p for p in points if p.error > 0.0 and p.seconds > 0.0]
    late = [p for p in late if p.seconds >= late[-1].seconds / LATELY]
    if len(late) < 2 or late[0].seconds == late[-1].seconds:
        return math.nan
    power, _ = np.polyfit([math.log(p.seconds) for p in late], [math.log(p.error) for p in late], 1)
    return late[-1].error * (1.0 + more / late[-1].seconds) ** min(float(power), 0.0)

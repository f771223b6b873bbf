"""Measures a source of error: every setting runs once, then in turn with all others, and is compared with a reference.

After the first runs the work of every setting is known. So is the number of its further runs, and the time that the
whole measurement will take.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from tracer.measure.precision.errors import errors
from tracer.measure.precision.precision import Curve, Method, Point, Reference, Setting, Source, fitted, point_of
from tracer.measure.timing import Run, Times, clocked, turns
from tracer.measure.work import work_of
from tracer.progress import Progress, divided

THREADS = 1  # of a timed run: then its wall time and its processor time are the same on an idle machine
FEWEST, MOST = 5, 20  # runs of a setting
RUN_WORK = 3_000_000  # of all runs of a setting, if that is more than FEWEST and fewer than MOST


@dataclass(frozen=True)
class Study:
    """A source of error: the settings of each method, and the reference that they are compared with."""

    name: str
    title: str
    about: str
    methods: Sequence[Method]
    refer: Callable[[Progress], Reference]
    referring: float = 0.0  # seconds that `refer` is expected to take
    bounded: bool = False  # whether the program's own bound is one on this error
    exact: bool = False  # whether the reference is a closed form


@dataclass
class Trial:
    """A setting after its first run, which is not one of its timed runs."""

    method: Method
    setting: Setting
    work: int
    seconds: float  # processor time of the first run, which other load does not change
    judging: float  # processor time of a comparison with a reference

    @property
    def runs(self) -> int:
        """The number of its timed runs. It depends on its work only, so it is the same in every report."""
        return max(FEWEST, min(MOST, RUN_WORK // max(1, self.work)))


class Experiment:
    """A study whose settings have run once."""

    def __init__(self, study: Study) -> None:
        """Run every setting once."""
        self.study = study
        self.trials: list[Trial] = []
        self.failures: list[str] = []
        for method in study.methods:
            for setting in method.settings:
                try:
                    image, first = clocked(setting.make)
                    _, judging = clocked(lambda pixels=image.pixels: errors(pixels, pixels))
                    self.trials.append(Trial(method, setting, work_of(image), first.cpu, judging.cpu))
                except (ValueError, MemoryError) as error:
                    self.failures.append(f"{method.name}, {setting.label}: {error}")

    @property
    def seconds(self) -> float:
        """The expected time of `measure`, on an idle machine."""
        return self.study.referring + sum(trial.judging + trial.runs * trial.seconds for trial in self.trials)

    def measure(self, progress: Progress) -> Source:
        """The error and the time of every setting. `progress` is called with the share that is done."""
        order = list(turns([trial.runs for trial in self.trials]))
        costs = [self.trials[k].seconds for k in order]
        for first in {k: order.index(k) for k in order}.values():
            costs[first] += self.trials[order[first]].judging
        referring, *running = divided(progress, [self.study.referring, *costs])
        reference = self.study.refer(referring)
        referring(1.0)
        runs: list[list[Run]] = [[] for _ in self.trials]
        points: dict[int, Point] = {}
        for k, part in zip(order, running, strict=True):
            setting = self.trials[k].setting
            image, run = clocked(setting.make)
            runs[k].append(run)
            if k not in points:  # the images of all runs are the same
                points[k] = point_of(setting, image, Times.of(runs[k]), reference)
            part(1.0)
        return self._source(reference, [replace(points[k], times=Times.of(of)) for k, of in enumerate(runs)])

    def _source(self, reference: Reference, points: Sequence[Point]) -> Source:
        study, curves, failures = self.study, [], list(self.failures)
        for method in study.methods:
            own = tuple(p for trial, p in zip(self.trials, points, strict=True) if trial.method is method)
            slope = fitted(own, reference) if method.slope else None
            curves.append(Curve(method.name, own, method.slope, slope))
            failures += [
                f"{method.name}, {point.label}: its image has NaN or infinite pixels"
                for point in own
                if not math.isfinite(point.errors.rmse)
            ]
        return Source(
            study.name, study.title, study.about, reference, tuple(curves), tuple(failures), study.bounded, study.exact
        )

"""The conditions that a report was measured under, and what they mean for its times."""

import platform
from collections.abc import Sequence
from dataclasses import dataclass

from tracer.compile.kernel_cache import versions
from tracer.image.render import processors
from tracer.measure.conditions import Moment, processor_model
from tracer.measure.precision.experiment import THREADS
from tracer.measure.precision.precision import Point
from tracer.measure.timing import NOTABLE
from viewer.report.chapter import Chapter


@dataclass(frozen=True)
class Conditions:
    """The command, and the moments when it began and when the page was written."""

    command: str
    began: Moment
    ended: Moment

    @property
    def seconds(self) -> float:
        """The duration of the whole report."""
        return self.ended.clock - self.began.clock

    @property
    def machine(self) -> dict[str, str]:
        """The machine and the versions, as text."""
        return {
            "processor": processor_model(),
            "processors": str(processors()),
            "threads of a timed run": str(THREADS),
            "threads of a reference image": str(processors()),
            "system": platform.platform(),
            **versions(),
        }


def points_of(chapters: Sequence[Chapter]) -> list[Point]:
    """The markers of all chapters."""
    return [p for chapter in chapters for source in chapter.sources for curve in source.curves for p in curve.points]


def busy_note(chapters: Sequence[Chapter]) -> str:
    """A sentence about the times that other programs disturbed; empty if they disturbed none."""
    points = points_of(chapters)
    busy = sum(point.times.is_busy for point in points)
    if not busy:
        return ""
    most = max(point.times.waited for point in points if point.times.is_busy)
    return (
        f"the machine was busy: in {busy} of {len(points)} settings the thread waited for a processor for more than "
        f"{100 * NOTABLE:.0f} % of the time, up to {100 * most:.0f} %. Compare processor times, or measure again on an "
        "idle machine"
    )

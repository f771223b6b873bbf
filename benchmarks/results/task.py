"""A benchmark as a list of tasks, so that the remaining time is known."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from benchmarks.results.figure import Figure


@dataclass(frozen=True)
class Options:
    runs: int
    scenes: Path | None = None  # a folder of NFF files, each with its POV-Ray source


@dataclass(frozen=True)
class Task:
    name: str
    seconds: float  # expected time, for the display of the remaining time
    measure: Callable[[], list[Figure]]

"""A benchmark as a row of tasks, so that the time left is known."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from benchmarks.figure import Figure


@dataclass(frozen=True)
class Options:
    runs: int
    scenes: Path | None = None  # a folder of NFF files, each with its POV-Ray source


@dataclass(frozen=True)
class Task:
    name: str
    seconds: float  # about how long: only for the time left
    measure: Callable[[], list[Figure]]

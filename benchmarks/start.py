"""Start times: commands against processes that only import the same libraries, and the first start on a machine.

Wall-clock times of whole processes. Only the first start compiles: it runs with an empty cache folder.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from benchmarks.results.figure import Figure, Spread, compared, in_turn
from benchmarks.results.task import Options, Task

LESSON = "glass-ball"
WITHOUT_MESH = "two-lights"
VIEW_MOST = 2.2
TRACE_MOST = 2.0
FIRST_MOST = 40.0  # seconds
FIRST_RUNS = 2  # at most
KEPT = {"PYTHONDONTWRITEBYTECODE": ""}  # as for users: Python caches the bytecode of raytree's files, too
VIEW_NEEDS = "numpy, numba, platformdirs, moderngl, imgui_bundle, glfw, PIL.Image"
TRACE_NEEDS = "numpy, numba"


def starts(options: Options) -> list[Task]:
    def view(lesson: str, needs: str) -> list[Figure]:
        with tempfile.TemporaryDirectory() as folder:
            command = raytree("view", lesson, "--screenshot", f"{folder}/view.png")
            ours, theirs = in_turn(options.runs, lambda: seconds(command), lambda: seconds(imports(needs)))
        what = f"raytree view {lesson} --screenshot"
        return [compared("start", what, "s", ours, "its imports", theirs, wanted=VIEW_MOST, at_least=False)]

    def trace() -> list[Figure]:
        command = raytree("trace", LESSON, "--pixel", "248,180")
        ours, theirs = in_turn(options.runs, lambda: seconds(command), lambda: seconds(imports(TRACE_NEEDS)))
        return [compared("start", "raytree trace", "s", ours, "its imports", theirs, wanted=TRACE_MOST, at_least=False)]

    def first() -> list[Figure]:
        took = [first_start() for _ in range(min(FIRST_RUNS, options.runs))]
        return [Figure("start", "first start ever", "s", Spread.of(took), wanted=FIRST_MOST, at_least=False)]

    return [
        Task("view", 2.5 * (options.runs + 1), lambda: view(WITHOUT_MESH, VIEW_NEEDS)),
        Task("view, with a mesh", 2.5 * (options.runs + 1), lambda: view(LESSON, VIEW_NEEDS)),
        Task("trace", 1.5 * (options.runs + 1), trace),
        Task("first start ever", 40.0 * min(FIRST_RUNS, options.runs), first),
    ]


def first_start() -> float:
    """Seconds to the viewer's first image if nothing is compiled yet."""
    with tempfile.TemporaryDirectory() as folder:
        return seconds(raytree("view", LESSON, "--screenshot", f"{folder}/view.png"), {"XDG_CACHE_HOME": folder})


def raytree(*arguments: str) -> list[str]:
    return [str(Path(sys.executable).parent / "raytree"), *arguments]


def imports(names: str) -> list[str]:
    return [sys.executable, "-P", "-c", f"import {names}"]


def seconds(command: Sequence[str], more: Mapping[str, str] | None = None) -> float:
    began = time.perf_counter()
    run = subprocess.run(
        command, capture_output=True, text=True, env={**os.environ, **KEPT, **(more or {})}, check=False
    )
    took = time.perf_counter() - began
    if run.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: {run.stderr.strip()[-500:]}")
    return took

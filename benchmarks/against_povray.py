"""Time for an image against POV-Ray's: 512x512, depth 4, weights down to 1/255, scene by scene and in total.

A second part counts the rays that each program follows if nothing is cut.
"""

import statistics

from benchmarks.race import need_povray
from benchmarks.results.figure import Figure, Spread, compared
from benchmarks.results.task import Options, Task
from benchmarks.scenes.entries import Entry, entries

EACH = 1.3
TOGETHER = 2.5


def times(options: Options) -> list[Task]:
    ratios: dict[str, list[list[float]]] = {}

    def race(entry: Entry) -> list[Figure]:
        need_povray()
        ours, theirs = entry.race().times(options.runs)
        kind = "a folder's scenes" if entry.file else "made scenes"
        ratios.setdefault(kind, []).append([b / a for a, b in zip(ours, theirs, strict=True)])
        return [compared("povray", entry.name, "s", ours, "POV-Ray", theirs, faster=True, wanted=EACH)]

    def together() -> list[Figure]:
        """Total over the scenes of one kind, run by run."""
        return [
            Figure("povray", f"{kind}, geometric mean", "times as fast", spread, "POV-Ray", wanted=TOGETHER)
            for kind, rows in ratios.items()
            for spread in [Spread.of([statistics.geometric_mean(run) for run in zip(*rows, strict=True)])]
        ]

    tasks = [
        Task(entry.name, 3.0 + 1.5 * (options.runs + 1), lambda entry=entry: race(entry))
        for entry in entries(options.scenes)
    ]
    return [*tasks, Task("geometric mean", 0.1, together)]


def counts(options: Options) -> list[Task]:
    def count(entry: Entry) -> list[Figure]:
        need_povray()
        ours, theirs = entry.count().counts()
        pairs = (
            ("reflected", ours["reflection"], theirs["reflected"]),
            ("refracted", ours["refraction"], theirs["refracted"]),
        )
        return [
            compared("counts", f"{entry.name}, {kind} rays", "rays", [our], "POV-Ray", [their])
            for kind, our, their in pairs
            if our or their
        ]

    return [Task(entry.name, 4.0, lambda entry=entry: count(entry)) for entry in entries(options.scenes)]

"""What the stable formulas cost: images with them against images with the textbook's in the same kernel.

`make bench-stable`.

The plain kernel has the quadratic by (-b -+ sqrt(b^2 - ac)) / a, planes by one division, the hit where the ray says,
directions by a root and three divisions. It is compiled in a process of its own; both take turns, one thread each.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import tracer
from tracer.image.render import warm
from tracer.measure.precision.plain import use
from viewer.lessons import lesson

SIZE = (640, 480)
RUNS = 9


def times() -> dict[str, float]:
    """Seconds for each lesson's image, at its own depth."""
    warm()
    found = {}
    for name in lesson.names():
        world = tracer.prepare(tracer.load(lesson.read(name).scene))
        found[name] = min(tracer.render(world, SIZE, threads=1).seconds["trace"] for _ in range(3))
    return found


def main() -> int:
    if sys.argv[1:] == ["--plain"]:
        use("double")
    if sys.argv[1:]:
        print(json.dumps(times()))
        return 0
    ratios: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for run in range(RUNS + 1):
            plain, ours = (seconds(kind, folder) for kind in ("--plain", "--stable"))
            if run:  # the first of each compiles
                for name, value in ours.items():
                    ratios.setdefault(name, []).append(value / plain[name])
    print(f"{SIZE[0]}x{SIZE[1]}, one thread, our time over that with plain formulas, median of {RUNS} runs in turn")
    for name, found in ratios.items():
        print(f"{name:14} {statistics.median(found):.2f}   {min(found):.2f} .. {max(found):.2f}")
    return 0


def seconds(kind: str, folder: str) -> dict[str, float]:
    environment = {**os.environ, "XDG_CACHE_HOME": str(Path(folder) / kind)}
    command = [sys.executable, "-m", "benchmarks.against_textbook", kind]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout)


if __name__ == "__main__":
    sys.exit(main())

"""Our time against POV-Ray's on the shipped scenes, side by side: `make bench`.

Two threads each, 640x480, depth 3, Whitted's model, no antialiasing, no cut-off. Its "Trace Time" stands against our
`seconds["trace"]`, in turn, several runs of each; the ratio is that of neighbouring runs. Neither includes loading.
"""

import dataclasses
import json
import statistics
import sys
import tempfile
from pathlib import Path

import tracer
from tests import povray
from tracer.render import warm
from viewer import lesson

SIZE = (640, 480)
THREADS = 2
RUNS = 9
UNSEEN = ("scale", "panes")  # smaller than what POV-Ray can see


def main() -> int:
    if not povray.available():
        print("this benchmark needs POV-Ray: the Debian package povray", file=sys.stderr)
        return 2
    warm()
    print(f"{SIZE[0]}x{SIZE[1]}, depth 3, {THREADS} threads each, median of {RUNS} runs in turn")
    print(f"{'scene':14} {'POV-Ray':>10} {'raytree':>10} {'ratio':>7}   lowest and highest")
    figures = {}
    for name in lesson.names():
        if name in UNSEEN:
            continue
        figures[name] = row = compare(name)
        low, high = row["range"]
        print(f"{name:14} {row['povray']:8.3f} s {row['raytree']:8.3f} s {row['ratio']:7.2f}   {low:.2f} .. {high:.2f}")
    if len(sys.argv) > 1:
        Path(sys.argv[1]).write_text(json.dumps(figures, indent=1) + "\n")
    return 0


def compare(name: str) -> dict:
    """Medians of the times and of the ratios of neighbouring runs."""
    scene = tracer.load(lesson.read(name).scene)
    scene = dataclasses.replace(scene, tracing=dataclasses.replace(scene.tracing, model="whitted", depth=3))
    world = tracer.prepare(scene)
    source = povray.write_scene(scene, 3, SIZE)
    theirs, ours = [], []
    with tempfile.TemporaryDirectory() as folder:
        for run in range(RUNS + 1):
            _, seconds, _ = povray.render(source, SIZE, Path(folder), THREADS)
            image = tracer.render(world, SIZE, threads=THREADS)
            if run:  # the first of each only warms up
                theirs.append(seconds)
                ours.append(image.seconds["trace"])
    ratios = [a / b for a, b in zip(theirs, ours, strict=True)]
    return {
        "povray": statistics.median(theirs),
        "raytree": statistics.median(ours),
        "ratio": statistics.median(ratios),
        "range": (min(ratios), max(ratios)),
    }


if __name__ == "__main__":
    sys.exit(main())

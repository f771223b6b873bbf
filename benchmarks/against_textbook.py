"""Cost of the stable formulas: images in turn with images by the textbook's formulas in the same kernel.

`make bench-stable`. The textbook's formulas are those of `tracer.measure.precision.textbook_kernel`.
"""

import statistics

import tracer
from benchmarks.results.figure import in_turn
from tracer.measure.precision.textbook_kernel import textbook_formulas
from viewer.lessons import lesson

SIZE = (640, 480)
RUNS = 25


def main() -> None:
    textbook = textbook_formulas("double")
    print(f"{SIZE[0]}x{SIZE[1]}, one thread, our time over that with the textbook's formulas, median of {RUNS} in turn")
    for name in lesson.names():
        scene = tracer.load(lesson.read(name).scene)
        ours, theirs = tracer.prepare(scene), tracer.prepare(scene, formulas=textbook)
        pairs = in_turn(RUNS, lambda world=ours: seconds(world), lambda world=theirs: seconds(world))
        ratios = [a / b for a, b in zip(*pairs, strict=True)]
        print(f"{name:14} {statistics.median(ratios):.2f}   {min(ratios):.2f} .. {max(ratios):.2f}")


def seconds(world: tracer.World) -> float:
    """The time of an image."""
    return tracer.render(world, SIZE, threads=1).seconds["trace"]


if __name__ == "__main__":
    main()

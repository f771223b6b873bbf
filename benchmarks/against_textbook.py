"""Cost of the stable formulas: images in turn with images by the textbook's formulas in the same kernel.

`make bench-stable`. The textbook's formulas are those of `tracer.measure.precision.textbook_kernel`.
"""

import statistics

import tracer
from tracer.measure.precision.textbook_kernel import textbook_formulas
from viewer.lessons import lesson

SIZE = (640, 480)
RUNS = 9


def main() -> None:
    textbook = textbook_formulas("double")
    print(f"{SIZE[0]}x{SIZE[1]}, one thread, our time over that with the textbook's formulas, median of {RUNS} in turn")
    for name in lesson.names():
        scene = tracer.load(lesson.read(name).scene)
        ours, theirs = tracer.prepare(scene), tracer.prepare(scene, formulas=textbook)
        seconds(ours), seconds(theirs)  # compiles
        ratios = [seconds(ours) / seconds(theirs) for _ in range(RUNS)]
        print(f"{name:14} {statistics.median(ratios):.2f}   {min(ratios):.2f} .. {max(ratios):.2f}")


def seconds(world: tracer.World) -> float:
    """The least time of three images."""
    return min(tracer.render(world, SIZE, threads=1).seconds["trace"] for _ in range(3))


if __name__ == "__main__":
    main()

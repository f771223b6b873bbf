"""Adaptive sampling against the same number of samples in every pixel: rays and seconds to the same true error.

The shipped lessons at their own size. The true image has very many samples; the goal is the error of the image with
N samples a pixel. Rounds of the adaptive one end when its true error is no larger; between two rounds the error is
interpolated as a power. Rays are the same in every run; seconds are those of a single run.
"""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import tracer
from benchmarks.results.figure import Figure, Spread
from benchmarks.results.task import Options, Task
from tracer.choices import SOBOL
from tracer.image.progressive import ProgressiveImage
from tracer.image.render import processors
from tracer.kernel.limits import make_limits
from tracer.measure.precision.errors import rmse
from viewer.lessons import lesson

TRUE = 1024
SAMPLES = (16, 64)
WANTED = 1.0 / 3.0


def adaptive(options: Options) -> list[Task]:
    return [Task(name, 120.0, lambda name=name: measure(name)) for name in lesson.names()]


def measure(name: str) -> list[Figure]:
    world = tracer.prepare(tracer.load(lesson.read(name).scene))
    true = tracer.render(world, samples=TRUE).pixels
    plain = [tracer.render(world, samples=count) for count in SAMPLES]
    goals = [rmse(image.pixels, true) for image in plain]
    found = to_each(world, goals, true)
    figures = []
    for count, image, (rays, seconds) in zip(SAMPLES, plain, found, strict=True):
        all_rays, all_seconds = float(sum(image.rays.values())), image.seconds["trace"]
        what = f"{name}, error of {count} samples"
        for unit, ours, theirs, wanted in (("rays", rays, all_rays, WANTED), ("s", seconds, all_seconds, None)):
            pair = [Spread(value, value, value) for value in (ours, theirs, ours / theirs)]
            figures.append(
                Figure("adaptive", f"{what}, {unit}", unit, pair[0], "everywhere", pair[1], pair[2], wanted, False)
            )
    return figures


def to_each(world: tracer.World, goals: Sequence[float], true: np.ndarray) -> list[tuple[float, float]]:
    """(rays, seconds) at which the true error reaches each of the goals, the largest first."""
    made = ProgressiveImage(world, world.view(), make_limits(world, records=False), SOBOL)
    threads = processors()
    ahead, found = list(goals), []
    before = (math.inf, 0.0, 0.0)
    with ThreadPoolExecutor(threads) as pool:
        for reached in made.rounds(pool, threads):
            now = (rmse(made.statistics.means(), true), float(reached.rays), reached.seconds)
            while ahead and now[0] <= ahead[0]:
                goal = ahead.pop(0)
                share = math.log(before[0] / goal) / math.log(before[0] / now[0]) if before[0] < math.inf else 1.0
                found.append((between(before[1], now[1], share), between(before[2], now[2], share)))
            if not ahead:
                break
            before = now
    return found


def between(a: float, b: float, share: float) -> float:
    """Interpolate on a logarithmic scale."""
    return b if share == 1.0 else a ** (1.0 - share) * b**share

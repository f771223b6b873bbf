"""A click: the tree behind one pixel at depth 3, in a scene of 327 680 triangles, mirror or glass."""

import time

import numpy as np

import tracer
from benchmarks.results.figure import Figure, Spread, in_turn
from benchmarks.results.task import Options, Task
from benchmarks.scenes.stone import LARGE, stone_world
from tracer.scene import Material

CLICKS = 500  # a run
DEPTH = 3
MOST = 2.0  # milliseconds, for 99 of 100 clicks
MATERIALS = (
    Material("mirror", diffuse=0.3, reflect=0.6),
    Material("glass", diffuse=0.1, reflect=0.1, transmit=0.8, ior=1.5),
)


def clicks(options: Options) -> list[Task]:
    def measure(material: Material) -> list[Figure]:
        world = stone_world(LARGE, material)
        random = np.random.default_rng(7)
        runs: list[np.ndarray] = []

        def run() -> float:
            runs.append(np.percentile(milliseconds(world, random), (50, 99)))
            return 0.0

        in_turn(options.runs, run)
        middle, slow = (Spread.of([float(run[k]) for run in runs[1:]]) for k in (0, 1))
        return [
            Figure("click", f"{material.name}, median", "ms", middle, at_least=False),
            Figure("click", f"{material.name}, 99 of 100", "ms", slow, wanted=MOST, at_least=False),
        ]

    return [Task(material.name, 8.0 + options.runs, lambda m=material: measure(m)) for material in MATERIALS]


def milliseconds(world: tracer.World, random: np.random.Generator) -> list[float]:
    """Times of clicks at random pixels of the image."""
    image = world.scene.image
    took: list[float] = []
    for _ in range(CLICKS):
        pixel = (int(random.integers(image.width)), int(random.integers(image.height)))
        began = time.perf_counter()
        tracer.trace(world, pixel, depth=DEPTH)
        took.append(1e3 * (time.perf_counter() - began))
    return took

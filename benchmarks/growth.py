"""Growth of cost with the scene: a ray in 64 times as many triangles, and building their BVH."""

import time

import numpy as np

from benchmarks.closest import Searcher
from benchmarks.results.figure import Figure, Spread, compared, in_turn
from benchmarks.results.task import Options, Task
from benchmarks.scenes.stone import LARGE, SMALL, coherent_rays, scattered_rays, stone, stone_world
from tracer.accel import bvh
from tracer.shapes.mesh import Mesh

MOST = 3.0  # times the time of a ray
BUILT = 1.0  # million triangles a second


def growth(options: Options) -> list[Task]:
    def rays() -> list[Figure]:
        large, small = (Searcher(stone_world(level)) for level in (LARGE, SMALL))
        found = []
        for kind, bundle in (("coherent", coherent_rays()), ("scattered", scattered_rays())):
            times = in_turn(options.runs, *(lambda of=of, b=bundle: 1.0 / of.rate(b) for of in (large, small)))
            what = f"a {kind} ray in 327 680 triangles"
            found.append(compared("growth", what, "µs", times[0], "in 5 120", times[1], wanted=MOST, at_least=False))
        return found

    def build() -> list[Figure]:
        mesh = Mesh(stone(LARGE))
        bounds, corners = mesh.bounds(), mesh.placed()
        (rates,) = in_turn(options.runs, lambda: build_rate(bounds, corners))
        return [Figure("growth", "building the hierarchy", "M triangles/s", Spread.of(rates), wanted=BUILT)]

    return [Task("rays", 10.0 + 2.0 * options.runs, rays), Task("building", 5.0 + 0.5 * options.runs, build)]


def build_rate(bounds: np.ndarray, corners: np.ndarray) -> float:
    """Millions of triangles a second, on one thread."""
    began = time.perf_counter()
    bvh.build(bounds, corners)
    return len(bounds) / (time.perf_counter() - began) / 1e6

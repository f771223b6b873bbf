"""Closest hits on a mesh of 327 680 triangles against Embree's, one ray at a time, on one thread each.

Embree (I. Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", SIGGRAPH 2014) by the package
embreex. Embree computes in single precision, raytree in double. Both have the same rays and corners, and must hit
the same triangles.
"""

import time
from typing import Any

import numpy as np

from benchmarks.closest import Searcher
from benchmarks.results.figure import Figure, compared, in_turn
from benchmarks.results.task import Options, Task
from benchmarks.scenes.stone import LARGE, coherent_rays, scattered_rays, stone, stone_world

WANTED = 0.7
DIFFERENT = 1e-3  # share of rays that may hit another triangle: those within single precision of an edge


def rates(options: Options) -> list[Task]:
    def measure() -> list[Figure]:
        theirs, ours = embree(), Searcher(stone_world(LARGE))
        found = []
        for kind, rays in (("coherent", coherent_rays()), ("scattered", scattered_rays())):
            different = (ours.hits(rays) != theirs.run(*rays, query="INTERSECT")).mean()
            if different > DIFFERENT:
                raise RuntimeError(f"{different:.1%} of the {kind} rays meet another triangle by Embree")
            us, them = in_turn(options.runs, lambda rays=rays: ours.rate(rays), lambda rays=rays: rate(theirs, rays))
            found.append(compared("embree", f"{kind} rays", "M rays/s", us, "Embree", them, wanted=WANTED))
        return found

    return [Task("rays", 15.0 + 2.0 * options.runs, measure)]


def embree() -> Any:
    """An Embree scene of the same mesh."""
    from embreex.mesh_construction import TriangleMesh  # pyright: ignore[reportMissingImports]
    from embreex.rtcore_scene import EmbreeScene  # pyright: ignore[reportMissingImports]

    geometry = stone(LARGE)
    scene = EmbreeScene()
    TriangleMesh(scene, geometry.vertices.astype(np.float32), geometry.faces.astype(np.int32))
    return scene


def rate(scene: Any, rays: tuple[np.ndarray, np.ndarray]) -> float:
    """Millions of rays a second."""
    began = time.perf_counter()
    scene.run(*rays, query="INTERSECT")
    return len(rays[0]) / (time.perf_counter() - began) / 1e6

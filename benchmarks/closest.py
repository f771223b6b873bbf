"""Closest hits of many rays on one thread, by the kernel's own traversal."""

import time
from typing import Any

import numpy as np

import tracer
from tracer.compile.intrinsics import reference
from tracer.compile.jit import kernel
from tracer.formulas.vector import unit, vector
from tracer.kernel.closest_hit import closest
from tracer.kernel.workspace import Workspace
from tracer.rays import make_ray


@kernel
def search_all(world: Any, origins: Any, directions: Any, space: Any, surfaces: Any) -> None:
    """The surface that each ray hits first, -1 for none."""
    for k in range(len(surfaces)):
        origin = vector(origins[k])
        reach = abs(origin[0]) + abs(origin[1]) + abs(origin[2])
        ray = make_ray(origin, unit(vector(directions[k])), -1, 0.0, reach, reference(space.table[0].history))
        _, surfaces[k], _ = closest(world, ray, 0.0, -1, space)


class Searcher:
    """A world with buffers for its traversal."""

    def __init__(self, world: tracer.World) -> None:
        self.world = world
        self.workspace = Workspace(world.eye((0.0, 0.0, 0.0)))

    def hits(self, rays: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """The surfaces that were hit. The first call may compile."""
        origins, directions = (np.ascontiguousarray(part, np.float64) for part in rays)
        surfaces = np.zeros(len(origins), np.int64)
        search_all(self.world.arrays, origins, directions, self.workspace.space, surfaces)
        return surfaces

    def rate(self, rays: tuple[np.ndarray, np.ndarray]) -> float:
        """Millions of rays a second."""
        began = time.perf_counter()
        self.hits(rays)
        return len(rays[0]) / (time.perf_counter() - began) / 1e6

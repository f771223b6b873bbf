"""Compilation of the kernels ahead of their use."""

import time

import numpy as np

from tracer.compile.jit import is_cached, is_compiled, is_uncompiled
from tracer.compile.kernel_cache import unwritable_cache
from tracer.kernel.entry import trace_pixels, trace_rays_in_turn
from tracer.kernel.world import prepare
from tracer.scene import Material, Object, Scene
from tracer.shapes.sphere import Sphere
from tracer.tree.batch import trace_rays
from tracer.tree.trace import trace

BALL = Scene((Object(Sphere((0.0, 0.0, -1.0), 0.5), Material()),))


def missing_kernels(batch: bool = False) -> int:
    """The number of large kernels that are not on disk from an earlier start: each takes about 20 s to compile.

    `batch`: with the one of `trace_rays`.
    """
    return sum(not is_cached(entry) for entry in (trace_pixels, *([trace_rays_in_turn] if batch else [])))


def are_kernels_cached() -> bool:
    """Whether the kernels are on disk from an earlier start, so that nothing needs to be compiled."""
    return not missing_kernels()


def unkept_kernels() -> str:
    """One line for the user if compiled kernels could not be stored for later starts, else empty."""
    return "" if are_kernels_cached() or is_uncompiled(trace_pixels) else unwritable_cache()


def warm_up() -> float:
    """Compile the kernels of images and trees, or load them from disk. Returns the seconds it took; 0 if ready."""
    if is_compiled(trace_pixels):
        return 0.0
    began = time.perf_counter()
    trace(prepare(BALL), ray=((0.0, 0.0, 0.0), (0.0, 0.0, -1.0)))
    return time.perf_counter() - began


def fill_cache(batch: bool = False) -> None:
    """Compile every kernel that a scene may need, for later starts to load. `batch`: also the one of `trace_rays`."""
    warm_up()
    prepare(BALL, hierarchy=True)
    if batch:
        trace_rays(prepare(BALL), np.zeros((1, 3)), np.array([(0.0, 0.0, -1.0)]))

"""The message while the kernels are compiled."""

import time

from tracer.compile.numba_private import NOTE, USES_PRIVATE
from tracer.image.warmup import fill_cache, missing_kernels, unkept_kernels
from viewer.base.progress import Progress
from viewer.base.streams import put_note

COMPILING = "compile the kernels (only at the first start, about {} seconds)"
SECONDS = {1: "twenty", 2: "forty"}  # that so many kernels take


def compiling(kernels: int = 1) -> str:
    """What is said while so many kernels are compiled."""
    return COMPILING.format(SECONDS[kernels])


def compile_once(batch: bool = False) -> float:
    """Compile all kernels on the first start on a machine, and say so. Returns the seconds it took.

    `batch`: also the kernel that traces many rays by hand.
    """
    if not USES_PRIVATE:
        put_note(NOTE)
    missing = missing_kernels(batch)
    if not missing:
        return 0.0
    began = time.perf_counter()
    with Progress(compiling(missing), at_once=True):
        fill_cache(batch)
    if note := unkept_kernels():
        put_note(note)
    return time.perf_counter() - began

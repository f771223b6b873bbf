"""The message while the kernels are compiled."""

import time

from tracer.compile.numba_private import NOTE, USES_PRIVATE
from tracer.image.warmup import are_kernels_cached, fill_cache, unkept_kernels
from viewer.base.progress import Progress
from viewer.base.streams import put_note

COMPILING = "compile the kernels (only at the first start, about twenty seconds)"


def compile_once() -> float:
    """Compile all kernels on the first start on a machine, and say so. Returns the seconds it took."""
    if not USES_PRIVATE:
        put_note(NOTE)
    if are_kernels_cached():
        return 0.0
    began = time.perf_counter()
    with Progress(COMPILING, at_once=True):
        fill_cache()
    if note := unkept_kernels():
        put_note(note)
    return time.perf_counter() - began

"""Output of commands, and the message while the kernels are compiled."""

import sys
import time

from tracer.compile.numba_private import NOTE, USES_PRIVATE
from tracer.image.warmup import are_kernels_cached, fill_cache
from viewer.base.progress import Progress

COMPILING = "compile the kernels (only at the first start, about twenty seconds)"


def put(text: str) -> None:
    """Write to the terminal, in UTF-8 whatever the system's own encoding is."""
    sys.stdout.buffer.write(text.encode("utf-8"))
    sys.stdout.buffer.flush()


def compile_once() -> float:
    """Compile all kernels on the first start on a machine, and say so. Returns the seconds it took."""
    if not USES_PRIVATE:
        put_note(NOTE)
    if are_kernels_cached():
        return 0.0
    began = time.perf_counter()
    with Progress(COMPILING, at_once=True):
        fill_cache()
    return time.perf_counter() - began


def put_note(note: str) -> None:
    """Write a note beside the command's output."""
    print(f"note: {note}", file=sys.stderr)

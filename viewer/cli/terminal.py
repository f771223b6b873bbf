"""Output of commands, and the message while the kernels are compiled."""

import sys
import time

from tracer.compile.numba_private import NOTE, USES_PRIVATE
from tracer.image.warmup import fill_cache, missing_kernels
from viewer.base.progress import Progress

COMPILING = "compile the kernels (only at the first start, about {} seconds)"
SECONDS = {1: "twenty", 2: "forty"}  # that so many kernels take


def put(text: str) -> None:
    """Write to the terminal, in UTF-8 whatever the system's own encoding is."""
    sys.stdout.buffer.write(text.encode("utf-8"))
    sys.stdout.buffer.flush()


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
    return time.perf_counter() - began


def put_note(note: str) -> None:
    """Write a note beside the command's output."""
    print(f"note: {note}", file=sys.stderr)

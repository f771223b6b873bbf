"""Gets the kernels ready while the window is already in use.

The very first start on a machine compiles, for a good ten seconds. That is done by a process of its own, so that the
window keeps its frames; this process then loads what it left in the cache, as every later start does.
"""

import subprocess
import sys
import threading
import time

from tracer.compile.jit import is_cached
from tracer.image.render import warm
from tracer.kernel.entry import trace_area


class Warmup:
    """`ready` once trees can be traced without waiting."""

    def __init__(self) -> None:
        self.began = time.perf_counter()
        self.compiles = not is_cached(trace_area)
        self.child: subprocess.Popen | None = None
        self.finished = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    @property
    def ready(self) -> bool:
        return self.finished.is_set()

    @property
    def seconds(self) -> float:
        """How long it has been going on."""
        return time.perf_counter() - self.began

    def wait(self) -> None:
        self.finished.wait()

    def close(self) -> None:
        """Leave without waiting for a compiler."""
        if self.child and self.child.poll() is None:
            self.child.terminate()
            self.child.wait()

    def _run(self) -> None:
        try:
            if self.compiles:
                self.child = subprocess.Popen(
                    [sys.executable, "-c", "from tracer.image.render import fill_cache; fill_cache()"],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
                if self.child.wait() < 0:  # closed while it was at work
                    return
            warm()  # from the cache; or here and now, where the other process could not do it
        finally:
            self.finished.set()

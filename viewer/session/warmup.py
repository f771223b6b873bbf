"""Loads the kernels while the window is already in use.

The first start on a machine compiles them, which takes about twenty seconds. A process of its own does that, so that
the window keeps its frame rate. This process then loads them from the cache, as every later start does.
"""

import subprocess
import threading
import time
from collections.abc import Callable

from tracer.compile.kernel_cache import cache_folder
from tracer.image.warmup import are_kernels_cached, unkept_kernels, warm_up
from tracer.processes import python_command


class Warmup:
    """Loads the kernels; `ready` becomes true when trees can be traced."""

    def __init__(self, say: Callable[[str], object]) -> None:
        self.began = time.perf_counter()
        self.compiles = not are_kernels_cached()
        self.child: subprocess.Popen | None = None
        self.say = say  # called in another thread with a note for the user
        self.finished = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    @property
    def ready(self) -> bool:
        return self.finished.is_set()

    @property
    def seconds(self) -> float:
        """The time since the start."""
        return time.perf_counter() - self.began

    def wait(self) -> None:
        self.finished.wait()

    def close(self) -> None:
        """End without waiting for the compiler."""
        if self.child and self.child.poll() is None:
            self.child.terminate()
            self.child.wait()

    def _run(self) -> None:
        try:
            if self.compiles and cache_folder() is not None:
                self.child = subprocess.Popen(
                    python_command("from tracer.image.warmup import fill_cache; fill_cache()"),
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
                if self.child.wait() < 0:  # `close` has ended it
                    return
            warm_up()  # from the cache, or by compiling here if the other process failed
            if note := unkept_kernels():
                self.say(note)
        finally:
            self.finished.set()

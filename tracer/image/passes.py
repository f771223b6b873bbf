"""Hands out the tiles of an image to a thread pool or a cluster, pass by pass."""

import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from queue import SimpleQueue
from typing import Any

import numpy as np

from tracer.image.film import Traced
from tracer.image.task import Cancelled, RemoteExecutor, Work, never, trace_works

AHEAD = 2  # calls per thread: one that runs, one that waits
MAX_TILES_REMOTE = 16  # tiles in a call to another process: a message costs a millisecond
MAX_TILES_HERE = 8  # in a call to a thread, which costs a tenth of that

Finished = Callable[[Traced, float], None]


class Stopped(Exception):
    """The rendering was cancelled; its image is incomplete."""


def trace_passes(
    task: Any,
    passes: Sequence[Sequence[Work]],
    executor: Executor,
    threads: int,
    finished: Finished,
    image: np.ndarray | None = None,
    cancelled: Cancelled = never,
) -> None:
    """Trace the tiles of each pass. Raises Stopped if `cancelled` returns true.

    `task` is a Task or a handle of it (`tracer.image.task.shared`). A pass begins when the one before has ended,
    since a coarse square must not overwrite finer pixels. `finished` is called in this thread, with each tile and
    the share done. `image` is the array that threads of this process write colours into.
    """
    here = isinstance(executor, ThreadPoolExecutor)
    if not here and len(passes) > 1:
        raise ValueError("several passes need a ThreadPoolExecutor: a finer pass keeps the pixels of the coarser ones")
    total = sum(len(works) for works in passes)
    done = due = 0
    ended = threading.Event()  # if this thread is interrupted, the others stop, too
    if here:
        options = (image, lambda: ended.is_set() or cancelled())
    else:
        options = (None, executor.abandoned if isinstance(executor, RemoteExecutor) else never)
    for works in passes:
        due += len(works)
        waiting = deque(shared_out(works, threads, MAX_TILES_HERE if here else MAX_TILES_REMOTE))
        news: SimpleQueue[Future[list[Traced]]] = SimpleQueue()
        running: set[Future[list[Traced]]] = set()
        try:
            while True:
                if isinstance(executor, RemoteExecutor):
                    threads = max(threads, executor.threads)
                while waiting and len(running) < AHEAD * threads and not cancelled():
                    future = executor.submit(trace_works, task, waiting.popleft(), *options)
                    running.add(future)
                    future.add_done_callback(news.put)
                if not running:
                    break
                future = news.get()
                running.remove(future)
                for traced in future.result():
                    done += 1
                    finished(traced, done / total)
        finally:
            if done < due:  # also for a call that is not in `running` yet
                ended.set()
            for future in running:
                future.cancel()
        if done < due:
            raise Stopped


def shared_out(works: Sequence[Work], threads: int, most: int) -> Iterator[Sequence[Work]]:
    """Split the tiles into calls of decreasing size, so that all threads finish together.

    Guided self-scheduling: Polychronopoulos & Kuck, IEEE Trans. Computers 36(12), 1987.
    """
    first = 0
    while first < len(works):
        count = min(most, -(-(len(works) - first) // (4 * threads)))
        yield works[first : first + count]
        first += count

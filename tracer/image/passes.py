"""The tiles of an image, handed out to a pool of threads or a cluster, pass by pass.

Tiles write disjoint pixels and no sum crosses a tile's border, so an image has the same bits for any number of threads
and any order of tiles.
"""

import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from queue import SimpleQueue

from tracer.image.job import Cancelled, Job, Remote, Traced, never, trace_tiles
from tracer.kernel.entry import Area

AHEAD = 2  # calls a thread: one it works on, one that waits
MOST_TILES = 16  # that another process is sent at a time, for a message costs a millisecond
MOST_HERE = 8  # and a thread, for a call costs a tenth of that

Finished = Callable[[Area, float], None]


class Stopped(Exception):
    """The rendering was cancelled; its image is incomplete."""


def trace_passes(
    job: Job,
    all_passes: Sequence[Sequence[Area]],
    executor: Executor,
    threads: int,
    finished: Finished = lambda area, share: None,
    cancelled: Cancelled = never,
) -> None:
    """Trace the tiles of each pass in their order; Stopped where `cancelled` turns true.

    A pass begins when the one before has ended: a coarse square must not fall onto a finer one. `finished` is told of
    each tile and of the share done, on this thread.
    """
    here = isinstance(executor, ThreadPoolExecutor)
    if not here and len(all_passes) > 1:
        raise ValueError("several passes need threads of this process: a finer pass leaves the pixels of a coarser one")
    total = sum(len(areas) for areas in all_passes)
    done = due = 0
    ended = threading.Event()  # where this thread is interrupted the others are to end, too
    task = job.shared_with(executor) if isinstance(executor, Remote) else job.task
    if here:
        ways = (job.pixels, lambda: ended.is_set() or cancelled())
    else:
        ways = (None, executor.abandoned if isinstance(executor, Remote) else never)
    for areas in all_passes:
        due += len(areas)
        waiting = deque(shared_out(areas, threads, MOST_HERE if here else MOST_TILES))
        news: SimpleQueue[Future[list[Traced]]] = SimpleQueue()
        running: set[Future[list[Traced]]] = set()
        try:
            while True:
                if isinstance(executor, Remote):
                    threads = max(threads, executor.threads)
                while waiting and len(running) < AHEAD * threads and not cancelled():
                    some = waiting.popleft()
                    future = executor.submit(trace_tiles, task, some, *ways, job.ways_on(some, here))
                    running.add(future)
                    future.add_done_callback(news.put)
                if not running:
                    break
                future = news.get()
                running.remove(future)
                for traced in future.result():
                    job.keep(traced)
                    done += 1
                    finished(traced.area, done / total)
        finally:
            if running:
                ended.set()
            for future in running:
                future.cancel()
        if done < due:
            raise Stopped


def shared_out(areas: Sequence[Area], threads: int, most: int) -> Iterator[Sequence[Area]]:
    """The tiles a call is given, fewer and fewer, so that all threads end together (guided self-scheduling:
    Polychronopoulos & Kuck, IEEE Trans. Computers 36(12), 1987)."""
    first = 0
    while first < len(areas):
        count = min(most, -(-(len(areas) - first) // (4 * threads)))
        yield areas[first : first + count]
        first += count

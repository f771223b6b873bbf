"""Rendering on a Dask cluster (https://distributed.dask.org), as an Executor.

    with tracer.cluster.connect("tcp://host:8786") as cluster:
        image = tracer.render(world, executor=cluster)

The world is sent once, and workers pass it on. It is the result of a call, not scattered data: if the workers that
held it are lost, the scheduler repeats the call. Tiles of a killed worker are traced by another.
"""

import asyncio
import contextlib
import logging
import re
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from typing import Any

from tracer.compile.kernel_cache import machine, versions
from tracer.extras import missing_extra
from tracer.image.task import Mismatch, RemoteExecutor, Task, difference
from tracer.image.warmup import warm_up as warm_up_kernels
from tracer.printable import printable

CONNECTING = 5  # seconds for the scheduler to answer
WAITING = 120.0  # seconds for a first worker to appear
LOOKING = 5.0  # seconds between checks for more workers
RETRIES = 3  # repetitions of a failed call
SCHEMES = ("tcp", "tls", "ws", "wss", "ucx")
LOGGERS = ("distributed", "distributed.client", "tornado", "tornado.application")  # Dask sets them one by one
LARGEST = "8 GiB"  # size of a world up to which Dask's warning about large graphs is suppressed


class ClusterError(RuntimeError):
    """A cluster that cannot be used, or was lost. `faults` has a line for each fault."""

    def __init__(self, *faults: str) -> None:
        super().__init__("\n".join(faults))
        self.faults = faults


class Cluster(RemoteExecutor):
    """A Dask client as an executor of tiles."""

    def __init__(self, client: Any) -> None:
        self.client = client
        self.look()
        self.inner = client.get_executor(pure=False, retries=RETRIES)
        self.abandoned = abandoned

    def share(self, task: Task) -> Any:
        from dask.config import set as settings

        with settings({"distributed.admin.large-graph-warning-threshold": LARGEST}):
            return self.client.submit(received, task, pure=False)

    def look(self) -> None:
        """Update the number of threads."""
        self.threads = sum(self.client.nthreads().values())
        self.looked = time.monotonic()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **options: Any) -> Future:
        if time.monotonic() - self.looked > LOOKING:
            self.look()
        return self.inner.submit(fn, *args, **options)


def received(task: Task) -> Task:
    """Runs on a worker: return what was sent, as a result that can be passed on."""
    return task


def abandoned() -> bool:
    """Runs on a worker: end the calling task if it was cancelled. Its thread cannot be stopped from outside.

    It ends by an exception, so that half a result never passes for a whole one. Otherwise returns False.
    """
    import distributed.worker as dask

    state: Any = dask  # `thread_state` is not part of Dask's documented interface
    task = dask.get_worker().state.tasks.get(state.thread_state.key)
    if task is not None and task.state == "cancelled":
        raise CancelledError
    return False


@contextlib.contextmanager
def connect(
    address: str,
    say: Callable[[str], None] = lambda doing: None,
    note: Callable[[str], None] = lambda line: None,
    waiting: float = WAITING,
) -> Iterator[Cluster]:
    """Connect to the cluster of the scheduler at this address.

    `say` is called with the current activity, `note` with a warning: no worker yet, or last bits that may differ.
    Leaving the context cancels calls that still run. ClusterError if there is no cluster, or if its workers have
    other versions.
    """
    address = checked(address)
    try:
        from distributed import Client, KilledWorker
        from distributed.comm.core import CommClosedError
    except ImportError:
        raise ClusterError(missing_extra("a cluster needs", "dask")) from None
    say(f"connect to {address}")
    with contextlib.ExitStack() as stack:
        stack.enter_context(quiet())
        check_scheduler(address)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # about Dask's versions; ours are compared below
                client: Any = Client(address, timeout=CONNECTING, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise ClusterError(f"{address}: no Dask scheduler answers: {_line(error)}") from None
        stack.callback(client.close, timeout=2)
        try:
            if not client.nthreads():
                note(f"{address} has no worker yet: waiting for one, at most {waiting:g} s")
                say("wait for a worker")
                wait_for_worker(client, address, waiting)
            for line in compare(client):
                note(line)
            say("compile the kernels on the cluster (only the first time, about twenty seconds)")
            warm_up(client)
            yield Cluster(client)
        except Mismatch as error:
            raise ClusterError(f"{address}: a worker that came later has {error}") from None
        except KilledWorker as error:
            raise ClusterError(f"{address}: several workers were killed during the same call: {_line(error)}") from None
        except (CancelledError, asyncio.CancelledError, CommClosedError, TimeoutError) as error:
            raise ClusterError(f"{address}: the scheduler was lost: {_line(error)}") from None
        except OSError as error:  # raised by the connection, or by anything else in this context
            if address not in str(error):
                raise
            raise ClusterError(f"{address}: the scheduler was lost: {_line(error)}") from None


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Silence Dask's log: its faults are raised as one line."""
    loggers = [logging.getLogger(name) for name in LOGGERS]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


def check_scheduler(address: str) -> None:
    """ClusterError if no Dask scheduler answers within CONNECTING seconds.

    Dask's client stops only its attempts to connect after that time, and waits for ever for the first answer of a
    program that accepts the connection. Its own thread runs this, since a notebook has an event loop in the main one.
    """
    runner = ThreadPoolExecutor(1)
    try:
        runner.submit(asyncio.run, _ask(address)).result()
    except TimeoutError:
        raise ClusterError(f"{address}: no Dask scheduler answers within {CONNECTING} s") from None
    except (OSError, ValueError, TypeError) as error:
        raise ClusterError(f"{address}: no Dask scheduler answers: {_line(error)}") from None
    except Exception:  # of any kind: the decoder of Dask's messages takes whatever another program says for one
        raise ClusterError(f"{address}: no Dask scheduler answers, but another program") from None
    finally:
        runner.shutdown(wait=False)


async def _ask(address: str) -> None:
    """Ask a scheduler who it is. TimeoutError after CONNECTING seconds."""
    from distributed.comm.core import connect as open_comm
    from distributed.security import Security

    async def answered() -> None:
        comm = await open_comm(address, timeout=CONNECTING, **Security().get_connection_args("client"))
        try:
            await comm.write({"op": "identity", "reply": True})
            answer = await comm.read()
        finally:
            comm.abort()
        if not isinstance(answer, dict) or answer.get("type") != "Scheduler":
            raise RuntimeError("another program")

    await asyncio.wait_for(answered(), CONNECTING)


def wait_for_worker(client: Any, address: str, waiting: float) -> None:
    try:
        client.wait_for_workers(1, timeout=waiting)
    except TimeoutError:
        raise ClusterError(f"{address}: no worker came within {waiting:g} s") from None


def compare(client: Any) -> list[str]:
    """Notes on workers whose last bits may differ from ours. ClusterError for workers with other versions.

    A worker with another version of raytree, numba or numpy is refused. A worker with another processor or C library
    is accepted, with a note.
    """
    faults: dict[str, list[str]] = {}
    notes: dict[str, list[str]] = {}
    for worker, found in sorted(client.run(described, on_error="return").items()):
        if not isinstance(found, tuple):
            faults.setdefault(f"no compatible raytree: {_line(found)}", []).append(worker)
            continue
        for ours, theirs, lines in zip(described(), found, (faults, notes), strict=True):
            if text := difference(ours, theirs):
                lines.setdefault(text, []).append(worker)
    if faults:
        raise ClusterError(*(f"{_several(workers)} has {text}" for text, workers in faults.items()))
    return [f"{_several(workers)} has {text}: last bits may differ" for text, workers in notes.items()]


def described() -> tuple[dict[str, str], dict[str, str]]:
    """Runs on a worker: what must agree with the client, and what should."""
    return versions(), machine()


def warm_up(client: Any) -> None:
    """Let one worker of each machine compile the kernels; the others there load them."""
    first = {re.sub(r":\d+$", "", worker): worker for worker in client.nthreads()}
    options = {"allow_other_workers": True, "retries": RETRIES, "pure": False}
    client.gather([client.submit(warm_up_kernels, workers=[worker], **options) for worker in first.values()])


def checked(address: str) -> str:
    """The address with its protocol, tcp by default."""
    found = re.fullmatch(r"(?:(\w+)://)?([^\s/]+:\d+)", address)
    if not found or (found[1] or "tcp") not in SCHEMES:
        raise ClusterError(f'a cluster\'s address must be like tcp://host:8786, got "{address}"')
    return f"{found[1] or 'tcp'}://{found[2]}"


def _several(workers: list[str]) -> str:
    return f"worker {workers[0]}" + (f" (and {len(workers) - 1} more)" if len(workers) > 1 else "")


def _line(error: BaseException) -> str:
    return printable(" ".join(str(error).split())[:200]) or type(error).__name__

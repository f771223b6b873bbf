"""`raytree render --dask` in a process of its own, on a cluster of two workers."""

import json
import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from distributed import Client
from distributed.diagnostics.plugin import SchedulerPlugin

from tests.tracer.image.test_cluster import local_cluster
from tests.viewer.cli.test_cli import raytree
from tests.viewer.pseudo_terminal import RAYTREE, on_a_terminal

pytestmark = pytest.mark.early


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with local_cluster(2) as cluster:
        yield cluster


def test_a_course_of_figures(cluster: Any, tmp_path: Path) -> None:
    """Files and messages are equal to those made without a cluster, byte for byte."""
    arguments = ["glass-ball", "mirror-balls", "--size", "200x150", "--format", "exr"]
    here = raytree("render", *arguments, "-o", "here/", "--stats", "here.json", cwd=tmp_path)
    there = raytree(
        "render", *arguments, "-o", "there/", "--stats", "there.json", "--dask", cluster.scheduler_address, cwd=tmp_path
    )
    assert (here.returncode, there.returncode) == (0, 0)
    for name in ("glass-ball.exr", "mirror-balls.exr"):
        assert (tmp_path / "there" / name).read_bytes() == (tmp_path / "here" / name).read_bytes()
    stats = [json.loads((tmp_path / name).read_text())["images"] for name in ("here.json", "there.json")]
    for one, other in zip(*stats, strict=True):
        assert list(one) == list(other)
        assert other.pop("threads") == 2
        for changes in ("seconds", "image"):
            one.pop(changes), other.pop(changes)
        one.pop("threads")
        assert one == other


class Witness(SchedulerPlugin):
    """Notices when the first tile is finished, and when the cluster holds none any more."""

    name = "witness"

    def __init__(self) -> None:
        self.known: set[Any] = set()
        self.started = threading.Event()
        self.forgotten = threading.Event()

    def transition(self, key: Any, start: str, finish: str, *args: Any, **found: Any) -> None:
        if not str(key).startswith("trace_works"):
            return
        if finish == "forgotten":
            self.known.discard(key)
            if not self.known:
                self.forgotten.set()
        else:
            self.known.add(key)
        if finish == "memory":
            self.started.set()


def test_interrupt_cancels_what_the_cluster_does(cluster: Any, tmp_path: Path) -> None:
    witness = Witness()
    cluster.scheduler.add_plugin(witness)
    arguments = ["glass-ball", "-o", "image.npy", "--size", "8000x6000", "--samples", "16"]
    process = subprocess.Popen(
        [RAYTREE, "render", *arguments, "--dask", cluster.scheduler_address], cwd=tmp_path, stderr=subprocess.PIPE
    )
    assert witness.started.wait(60)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate()
    assert process.returncode == 130
    assert said.decode().splitlines()[-1] == "stopped"
    assert b"Traceback" not in said
    assert list(tmp_path.iterdir()) == []
    assert witness.forgotten.wait(30)


def executing(dask_worker: Any) -> int:
    """Run on a worker: the number of calls that its threads execute."""
    return dask_worker.state.executing_count


def test_interrupt_frees_threads_that_are_in_the_middle_of_a_tile(cluster: Any, tmp_path: Path) -> None:
    """Two tiles that take minutes, one a worker: after the interrupt both workers accept other work."""
    arguments = ["glass-ball", "-o", "image.npy", "--size", "32x16", "--samples", "9", "--tolerance", "0"]
    client: Any
    with Client(cluster) as client:
        command = [RAYTREE, "render", *arguments, "--dask", cluster.scheduler_address]
        process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE)
        while sum(client.run(executing).values()) < 2 or "trace_works" not in str(client.processing()):
            assert process.poll() is None
        process.send_signal(signal.SIGINT)
        process.communicate()
        assert process.returncode == 130
        pids = client.run(os.getpid)
        assert client.gather([client.submit(os.getpid, workers=[worker], pure=False) for worker in pids]) == [
            *pids.values()
        ]


def test_a_cluster_without_workers_is_waited_for(tmp_path: Path) -> None:
    with local_cluster(0) as cluster:
        arguments = ["two-lights", "-o", "image.npy", "--size", "40x30", "--dask", cluster.scheduler_address]
        process = subprocess.Popen([RAYTREE, "render", *arguments], cwd=tmp_path, stderr=subprocess.PIPE)
        assert process.stderr
        assert f"{cluster.scheduler_address} has no worker yet" in process.stderr.readline().decode()
        cluster.scale(1)
        _, said = process.communicate()
    assert (process.returncode, said) == (0, b"")
    assert (tmp_path / "image.npy").is_file()


def test_unreachable_scheduler_is_one_line(tmp_path: Path) -> None:
    run = raytree("render", "two-lights", "-o", "image.npy", "--dask", "127.0.0.1:9", cwd=tmp_path)
    assert run.returncode == 2
    waited = r"connect to tcp://127\.0\.0\.1:9 \(\d s\)\n"  # in a log: a line if the attempt takes a while
    said = r"tcp://127\.0\.0\.1:9: no Dask scheduler answers(: .+| within 5 s)\n"  # it is tried again for five seconds
    assert re.fullmatch(f"({waited})?{said}", run.stderr), run.stderr
    assert list(tmp_path.iterdir()) == []


def dask(program: str, *arguments: str) -> subprocess.Popen:
    """The path of one of Dask's own programs."""
    command = [sys.executable, "-m", f"distributed.cli.dask_{program}", *arguments, "--dashboard-address", ":0"]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)


def test_lost_scheduler_is_one_line(tmp_path: Path) -> None:
    """The scheduler is killed in the middle of an image: one line at once, and no file."""
    scheduler = dask("scheduler", "--host", "127.0.0.1", "--port", "0")
    assert scheduler.stderr
    address = next(found[1] for line in scheduler.stderr if (found := re.search(r"Scheduler at:\s+(tcp://\S+)", line)))
    worker = dask("worker", address, "--nthreads", "1", "--no-nanny")
    try:
        arguments = ["render", "glass-ball", "-o", "image.npy", "--size", "8000x6000", "--dask", address]
        with on_a_terminal(arguments, tmp_path) as terminal:
            terminal.wait_for(r"render glass-ball \d+ %")
            scheduler.kill()
            assert terminal.wait() == 2
    finally:
        for process in (scheduler, worker):
            process.kill()
            process.communicate()
    assert terminal.said.split("\x1b[K")[-1].startswith(f"{address}: the scheduler was lost"), terminal.said
    assert terminal.said.count("\n") == 1, terminal.said
    assert list(tmp_path.iterdir()) == []

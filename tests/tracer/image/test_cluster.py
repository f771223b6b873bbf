"""Images on a real cluster of two processes: the same bits, also when a worker dies."""

import os
import pickle
import shutil
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import distributed
import numpy as np
import pytest
from distributed.diagnostics.plugin import SchedulerPlugin

import tracer
from tests import ROOT
from tests.scenes import ball, world_of
from tracer.formulas.sampler import PIXEL_CENTER
from tracer.image import cluster as cluster_module
from tracer.image.cluster import ClusterError, connect
from tracer.image.task import Task, Work, trace_works
from tracer.image.tiles import Tile
from tracer.kernel.entry import trace_pixels
from tracer.kernel.limits import make_limits
from tracer.scene import Image, Light, Material, Object
from tracer.shapes.mesh import Geometry, Mesh

pytestmark = pytest.mark.early


def local_cluster(workers: int) -> Any:
    return distributed.LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=":0"
    )


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with local_cluster(2) as cluster:
        yield cluster


@pytest.fixture(scope="module")
def world() -> tracer.World:
    """A smooth mesh below a glass ball, seen from inside another ball: every kind of data that is sent to workers."""
    n = 40
    x, z = np.meshgrid(np.linspace(-3, 3, n + 1), np.linspace(-3, 3, n + 1))
    vertices = np.stack([x, 0.2 * np.sin(3 * x) * np.cos(2 * z) - 1.5, z], axis=-1).reshape(-1, 3)
    normals = np.tile([0.0, 1.0, 0.0], (len(vertices), 1))
    first = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    faces = np.concatenate([np.stack([first, first + n + 1, first + 1], 1)])
    glass = Material("glass", specular=0.3, reflect=0.1, transmit=0.9, ior=1.5)
    return world_of(
        Object(Mesh(Geometry(vertices, faces, normals)), Material("clay", diffuse=0.8, reflect=0.2), "ground"),
        ball((0, 0, 0), 1, glass, "ball"),
        ball((0, 0, 6), 2, glass, "around the eye"),
        lights=[Light("lamp", position=(3, 5, 4))],
        background=(0.25, 0.5, 1.0),
        image=Image(333, 207),
    )


def kernels() -> int:
    """Run on a worker: for how many sets of types the kernel was compiled."""
    from tracer.kernel.entry import trace_pixels

    return len(trace_pixels.signatures)


def assert_same(image: tracer.Image, reference: tracer.Image) -> None:
    assert image.pixels.tobytes() == reference.pixels.tobytes()
    assert image.rays == reference.rays
    assert image.residual == reference.residual


@pytest.mark.parametrize("options", [{}, {"samples": 3, "depth": 5}, {"tolerance": 1e-2}])
def test_cluster_traces_the_same_bits(cluster: Any, world: tracer.World, options: dict) -> None:
    shares: list[float] = []
    with connect(cluster.scheduler_address) as executor:
        image = tracer.render(world, executor=executor, progress=shares.append, **options)
        assert set(executor.client.run(kernels).values()) == {1}
    assert_same(image, tracer.render(world, **options))
    assert image.threads == 2
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_an_image_that_converges_has_the_same_bits_there(cluster: Any, world: tracer.World) -> None:
    """The sums of each tile are sent to a worker and back, round by round."""
    size = (96, 72)
    here = tracer.render(world, size, until_error=0.006)
    with connect(cluster.scheduler_address) as workers:
        there = tracer.render(world, size, until_error=0.006, executor=workers)
    assert here.counts is not None and there.counts is not None
    assert here.counts.max() > 4
    assert there.counts.tobytes() == here.counts.tobytes()
    assert there.pixels.tobytes() == here.pixels.tobytes()
    assert there.rays == here.rays


def test_what_came_over_a_wire_is_traced_as_it_is(world: tracer.World) -> None:
    """Arrays from a message may be read-only. They are aligned, and nothing is compiled for them."""
    task = Task.of(world, world.view(), make_limits(world, records=False), PIXEL_CENTER.sampler)
    sent: list[pickle.PickleBuffer] = []
    head = pickle.dumps(task, protocol=5, buffer_callback=sent.append)
    came = [memoryview(b"?" + buffer.raw().tobytes())[1:] for buffer in sent]
    task = pickle.loads(head, buffers=came)
    assert len(came) == 10
    (traced,) = trace_works(task, [Work(Tile(150, 100, 170, 120))])
    assert traced.colors is not None
    assert (traced.colors == tracer.render(world).pixels[100:120, 150:170]).all()
    assert len(trace_pixels.signatures) == 1
    assert all(value.flags.aligned for value in vars(task.arrays)["_fields"] if isinstance(value, np.ndarray))


def test_any_executor_traces_the_same_bits(world: tracer.World) -> None:
    with ProcessPoolExecutor(1, get_context("spawn")) as executor:
        image = tracer.render(world, (100, 70), executor=executor, threads=1)
    assert_same(image, tracer.render(world, (100, 70)))


def test_workers_that_come_later_are_given_work(cluster: Any, world: tracer.World) -> None:
    with connect(cluster.scheduler_address) as executor:
        assert executor.threads == 2
        cluster.scale(3)
        cluster.wait_for_workers(3)
        executor.look()
        assert executor.threads == 3
        image = tracer.render(world, executor=executor)
        assert set(executor.client.run(kernels).values()) == {1}
        cluster.scale(2)
    assert image.threads == 3


class Assassin(SchedulerPlugin):
    """Kills the first worker that has finished a tile."""

    name = "assassin"

    def __init__(self, pids: dict[str, int]) -> None:
        self.pids = pids
        self.killed: str | None = None
        self.waiting = 0  # tiles that were not finished by then
        self.gone = threading.Event()
        self.scheduler: Any = None

    def transition(self, key: Any, start: str, finish: str, *args: Any, **found: Any) -> None:
        if str(key).startswith("trace_works") and finish == "memory" and self.killed is None:
            self.killed = found["worker"]
            states = self.scheduler.tasks.values()
            self.waiting = sum(str(task.key).startswith("trace_works") and task.state != "memory" for task in states)
            os.kill(self.pids[found["worker"]], signal.SIGKILL)

    def remove_worker(self, scheduler: Any, worker: str, **found: Any) -> None:
        if worker == self.killed:
            self.gone.set()


@pytest.mark.parametrize("workers", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_killed_worker_costs_no_pixel(world: tracer.World, workers: int) -> None:
    """The other worker takes over. If it was the only one, it is started again and receives the scene again."""
    with (
        local_cluster(workers) as cluster,
        connect(cluster.scheduler_address) as executor,
    ):
        assassin = Assassin(executor.client.run(os.getpid))
        assassin.scheduler = cluster.scheduler
        cluster.scheduler.add_plugin(assassin)
        image = tracer.render(world, (900, 700), executor=executor)
    assert assassin.gone.is_set()
    assert assassin.waiting > 0
    assert_same(image, tracer.render(world, (900, 700)))


@pytest.mark.parametrize("address", ["http://127.0.0.1:1", "127.0.0.1", "tcp://", "tcp://host:port", "a b:1"])
def test_what_is_no_address_is_said(address: str) -> None:
    with pytest.raises(ClusterError, match=f'must be like tcp://host:8786, got "{address}"'), connect(address):
        pass


def test_workers_of_other_versions_are_refused(tmp_path: Path) -> None:
    """A worker with other sources and one that cannot load them: one line each, before anything is traced."""
    for name, more in (("other", "# not the same\n"), ("none", "raise ImportError('no such thing here')\n")):
        shutil.copytree(ROOT / "tracer", tmp_path / name / "tracer", ignore=shutil.ignore_patterns("__pycache__"))
        with (tmp_path / name / "tracer" / "__init__.py").open("a") as file:
            file.write(more)
    with local_cluster(0) as cluster:
        too_soon = pytest.raises(ClusterError, match=r"no worker came within 0\.1 s")
        with too_soon, connect(cluster.scheduler_address, waiting=0.1):
            pass
        command = [sys.executable, "-m", "distributed.cli.dask_worker", cluster.scheduler_address, "--no-dashboard"]
        workers = [
            subprocess.Popen(
                [*command, "--name", name, "--no-nanny"],
                env={**os.environ, "PYTHONPATH": str(tmp_path / name)},
                cwd=tmp_path,
                stderr=subprocess.DEVNULL,
            )
            for name in ("other", "none")
        ]
        try:
            cluster.wait_for_workers(2)
            with pytest.raises(ClusterError) as refused, connect(cluster.scheduler_address):
                pass
        finally:
            for worker in workers:
                worker.kill()
                worker.wait()
    assert len(refused.value.faults) == 2
    assert any("has raytree 0.1.0/" in fault and "(here 0.1.0/" in fault for fault in refused.value.faults)
    assert any("has no compatible raytree: ImportError('no such thing" in fault for fault in refused.value.faults)


def test_a_program_that_never_answers_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its connection is accepted: only the limit on the whole time ends the wait for its first word."""
    monkeypatch.setattr(cluster_module, "CONNECTING", 1)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"127.0.0.1:{silent.getsockname()[1]}"
        with (
            pytest.raises(ClusterError, match=f"^tcp://{address}: no Dask scheduler answers within 1 s$"),
            connect(address),
        ):
            pass


def test_another_program_is_no_scheduler() -> None:
    """Its answer is taken for a message of Dask, of three exbibytes."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            connection, _ = server.accept()
            with connection:
                connection.recv(4096)
                connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")

        thread = threading.Thread(target=answer)
        thread.start()
        address = f"127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(ClusterError, match=f"^tcp://{address}: no Dask scheduler answers"), connect(address):
            pass
        thread.join()

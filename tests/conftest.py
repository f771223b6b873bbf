"""Shared by all tests: the shipped scenes, and numpy's floating point errors as exceptions."""

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import tracer
from tracer.measure.precision import precision
from viewer.lessons import lesson

LESSONS = lesson.names()


@pytest.fixture(autouse=True)
def _strict_numbers() -> Iterator[None]:
    """A division by zero or an overflow that nobody expects must not pass as a number."""
    with np.errstate(divide="raise", over="raise", invalid="raise"):
        yield


@pytest.fixture(scope="session")
def worlds() -> dict[str, tracer.World]:
    """Every shipped scene, prepared once."""
    return {name: tracer.prepare(tracer.load(lesson.read(name).scene)) for name in LESSONS}


@pytest.fixture(params=LESSONS)
def world(request: pytest.FixtureRequest, worlds: dict[str, tracer.World]) -> tracer.World:
    """Each shipped scene in turn."""
    return worlds[request.param]


@pytest.fixture
def scene_file(tmp_path: Path):
    """Writes a scene file; gives its path."""

    def write(text: str, name: str = "scene.toml") -> Path:
        path = tmp_path / name
        path.write_text(text, "utf-8")
        return path

    return write


@pytest.fixture(autouse=True, scope="session")
def taken_once() -> Iterator[None]:
    """No test is of how long something takes: what is measured is measured once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(precision, "RUNS", 1)
        yield


@pytest.fixture(autouse=True, scope="session")
def heard():
    """Shells let what they start in the background ignore Ctrl-C, and commands would go on ignoring it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)

"""Fixtures shared by all tests: the shipped scenes. numpy's floating point errors are raised as exceptions."""

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import tracer
from tracer.measure.precision import experiment
from viewer.lessons import lesson

# Lessons whose scenes the tests of everything else use: all kinds of objects, media and rays, few enough to be quick.
LESSONS = ["mirror-balls", "glass-ball", "underwater", "scale", "drop", "plates"]
MORE_LESSONS = ["two-lights", "panes"]  # for the slow tests, too
EACH_LESSON = [*LESSONS, *(pytest.param(name, marks=pytest.mark.slow) for name in MORE_LESSONS)]
ALL_LESSONS = lesson.names()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files of few long tests begin first: at the end, one process would work on them, and the other wait."""
    items.sort(key=lambda item: item.get_closest_marker("early") is None)


@pytest.fixture(autouse=True)
def _strict_numbers() -> Iterator[None]:
    """An unexpected division by zero or overflow fails the test instead of passing on as inf or NaN."""
    with np.errstate(divide="raise", over="raise", invalid="raise"):
        yield


@pytest.fixture(scope="session")
def worlds() -> dict[str, tracer.World]:
    """All shipped scenes, each prepared once for the whole run."""
    return {name: tracer.prepare(tracer.load(lesson.read(name).scene)) for name in [*LESSONS, *MORE_LESSONS]}


@pytest.fixture(params=EACH_LESSON)
def world(request: pytest.FixtureRequest, worlds: dict[str, tracer.World]) -> tracer.World:
    """Each shipped scene in turn."""
    return worlds[request.param]


@pytest.fixture
def scene_file(tmp_path: Path):
    """A function that writes a scene file and returns its path."""

    def write(text: str, name: str = "scene.toml") -> Path:
        path = tmp_path / name
        path.write_text(text, "utf-8")
        return path

    return write


@pytest.fixture(autouse=True, scope="session")
def taken_once() -> Iterator[None]:
    """Take each timing once: no test asserts a duration."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(experiment, "FEWEST", 1)
        patch.setattr(experiment, "MOST", 1)
        yield


@pytest.fixture(autouse=True, scope="session")
def heard():
    """Restore the default handler of Ctrl-C: shells start background jobs with it ignored, and commands would inherit
    that.
    """
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)

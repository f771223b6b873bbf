"""Progress messages: one line on a terminal, a few in a log, none for quick work."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.viewer.cli.test_cli import raytree
from tests.viewer.pseudo_terminal import on_a_terminal
from tracer.progress import divided
from viewer.base.progress import Progress, duration


class Clock:
    """A clock that shows what it is set to."""

    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


def test_time_left_is_what_the_share_says() -> None:
    clock = Clock()
    progress = Progress("render ball", clock=clock)
    assert progress.line(1000.5) == "render ball"
    assert progress.line(1003.0) == "render ball (3 s)"
    clock.now = 1004.0
    progress(0.25)
    assert progress.line(1004.0) == "render ball 25 %, 12 s left"
    assert progress.line(1009.0) == "render ball 25 %, 7 s left"  # no further tile was finished, time passes
    assert progress.line(1099.0) == "render ball 25 %, 6 s left"  # a tile that takes long: it will not be over at once
    progress.say("write ball.png")
    assert progress.line(1004.0) == "write ball.png"


def test_too_little_is_done_to_tell_what_is_left() -> None:
    clock = Clock()
    progress = Progress("render ball", clock=clock)
    clock.now = 1002.0
    progress(0.01)
    assert progress.line(1002.0) == "render ball 1 % (2 s)"
    clock.now = 1011.0
    progress(0.02)
    assert progress.line(1011.0) == "render ball 2 %, 9 min left"  # after ten seconds, it is a fair sample


def test_the_time_before_the_work_begins_does_not_count() -> None:
    """Processes that start, kernels that are loaded."""
    clock = Clock()
    progress = Progress("bounds", clock=clock)
    clock.now = 1030.0
    progress(0.0)
    clock.now = 1031.0
    progress(0.1)
    assert progress.line(1031.0) == "bounds 10 %, 9 s left"


@pytest.mark.parametrize("speed", [0.7, 1.0, 1.4])
def test_time_left_is_right_within_a_factor_of_two_if_the_costs_are(speed: float) -> None:
    """A work of long and short parts, each up to 1.4 times as long or as short as expected, on any machine."""
    clock = Clock()
    progress = Progress("report", clock=clock)
    random = np.random.default_rng(3)
    expected = 10.0 ** random.uniform(-2.0, 0.5, 200)
    took = speed * expected * random.uniform(0.7, 1.4, len(expected))
    ends = np.cumsum(took)
    for part, end in zip(divided(progress, list(expected)), ends, strict=True):
        clock.now = 1000.0 + end
        part(1.0)
        left = progress.left(clock.now)
        if left is not None and end < ends[-1]:
            assert 0.5 <= left / (ends[-1] - end) <= 2.0
    assert progress.left(clock.now) == 0.0


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.2, "0 s"), (99.0, "99 s"), (100.0, "2 min"), (3600.0, "60 min"), (7200.0, "2 h")]
)
def test_duration(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def test_terminal_has_one_line_that_is_cleared(tmp_path: Path) -> None:
    with on_a_terminal(["render", "glass-ball", "-o", "image.npy", "--size", "1600x1200"], tmp_path) as terminal:
        assert terminal.wait() == 0
    assert "\n" not in terminal.said
    lines = terminal.said.split("\r\x1b[K")
    assert lines[-1] == ""
    shares = [int(share) for share in re.findall(r"render glass-ball (\d+) %, \d+ s left", terminal.said)]
    assert shares == sorted(shares)


def test_log_has_a_line_every_ten_percent(capsys: pytest.CaptureFixture) -> None:
    clock = Clock()
    progress = Progress("render ball", clock=clock)
    for percent in range(101):
        clock.now = 1000.0 + percent
        progress(percent / 100)
        progress.show(clock.now)
    lines = capsys.readouterr().err.splitlines()
    assert lines[:3] == ["render ball", "render ball 10 %, 90 s left", "render ball 20 %, 80 s left"]
    assert len(lines) == 10


def test_log_has_nothing_of_what_is_quick(tmp_path: Path) -> None:
    quick = raytree("render", "glass-ball", "-o", "image.npy", "--size", "320x240", cwd=tmp_path)
    assert (quick.returncode, quick.stderr, quick.stdout) == (0, "", "")

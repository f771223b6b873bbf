"""Progress messages: one line on a terminal, a few in a log, none for quick work."""

import re
from pathlib import Path

import pytest

from tests.viewer.cli.test_cli import raytree
from tests.viewer.pseudo_terminal import on_a_terminal
from viewer.base.progress import Progress, duration


def test_time_left_is_what_the_share_says() -> None:
    progress = Progress("render ball")
    began = progress.began
    assert progress.line(began + 0.5) == "render ball"
    assert progress.line(began + 3.0) == "render ball (3 s)"
    progress.share, progress.told = 0.25, began + 4.0
    assert progress.line(began + 4.0) == "render ball 25 %, 12 s left"
    assert progress.line(began + 9.0) == "render ball 25 %, 7 s left"  # no further tile was finished, time passes
    assert progress.line(began + 99.0) == "render ball 25 %, 0 s left"
    progress.say("write ball.png")
    assert progress.line(progress.began) == "write ball.png"


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
    progress = Progress("render ball")
    for percent in range(101):
        progress.share, progress.told = percent / 100, progress.began + percent
        progress.show(progress.told)
    lines = capsys.readouterr().err.splitlines()
    assert lines[:3] == ["render ball", "render ball 10 %, 90 s left", "render ball 20 %, 80 s left"]
    assert len(lines) == 10


def test_log_has_nothing_of_what_is_quick(tmp_path: Path) -> None:
    quick = raytree("render", "glass-ball", "-o", "image.npy", "--size", "320x240", cwd=tmp_path)
    assert (quick.returncode, quick.stderr, quick.stdout) == (0, "", "")

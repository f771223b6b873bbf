"""Standard output on a full disk, closed, or read by a program that has read enough."""

import os
import subprocess
from pathlib import Path

import pytest

from tests.viewer.pseudo_terminal import RAYTREE

FULL = Path("/dev/full")
pytestmark = pytest.mark.skipif(not FULL.exists(), reason="Linux has a device that is full")

COMMANDS = {
    "version": ["--version"],
    "help": ["--help"],
    "help of a command": ["trace", "--help"],
    "trace": ["trace", "glass-ball", "--pixel", "248,180"],
    "json": ["trace", "glass-ball", "--pixel", "248,180", "--format", "json"],
    "plan": ["plan", "glass-ball"],
    "check": ["check", "A3"],
    "lessons": ["lessons"],
    "export": ["export", "two-lights", "--depth", "1", "-o", "figure.svg"],
    "render": ["render", "two-lights", "-o", "image.png", "--size", "20x20", "--until-error", "0.1"],
}


@pytest.mark.parametrize("name", COMMANDS)
def test_a_full_disk_is_one_line(name: str, tmp_path: Path) -> None:
    with FULL.open("w") as full:
        found = subprocess.run(
            [RAYTREE, *COMMANDS[name]], stdout=full, stderr=subprocess.PIPE, text=True, cwd=tmp_path, check=False
        )
    assert found.stderr == "standard output: cannot be written: No space left on device\n"
    assert found.returncode == 2


@pytest.mark.parametrize("name", ["help", "trace", "lessons"])
def test_a_reader_that_has_read_enough_is_no_error(name: str, tmp_path: Path) -> None:
    ours, theirs = os.pipe()
    os.close(ours)
    found = subprocess.run(
        [RAYTREE, *COMMANDS[name]], stdout=theirs, stderr=subprocess.PIPE, text=True, cwd=tmp_path, check=False
    )
    os.close(theirs)
    assert (found.returncode, found.stderr) == (0, "")


@pytest.mark.parametrize("name", ["version", "help", "lessons"])
def test_a_closed_output_is_one_line(name: str) -> None:
    command = f'"{RAYTREE}" {" ".join(COMMANDS[name])} >&-'
    found = subprocess.run(["sh", "-c", command], stderr=subprocess.PIPE, text=True, check=False)
    assert found.stderr == "standard output: cannot be written: it is closed\n"
    assert found.returncode == 2


@pytest.mark.parametrize("place", ["2> /dev/full", "2>&-"])
def test_without_standard_error_the_status_says_it(place: str) -> None:
    for command, status in (("lessons", 0), ("nonsense", 2), ("trace nothing.toml --pixel 1,1", 2)):
        found = subprocess.run(
            ["sh", "-c", f'"{RAYTREE}" {command} {place}'], stdout=subprocess.PIPE, text=True, check=False
        )
        assert found.returncode == status
        assert bool(found.stdout) == (status == 0)

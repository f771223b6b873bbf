"""Text in other encodings, extreme numbers and nesting, and files that are no regular files."""

import os
from pathlib import Path

import pytest

import tracer
from tests.tracer.formats.test_scene_files import faults_of


def test_bytes_of_another_encoding_may_stand_in_comments_only(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_bytes(b"format = 1 # gr\xfcn\n[[object]]\nshape = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\x1a")
    assert len(tracer.load(path).objects) == 1
    path.write_bytes(b"format = 1\ntitle = 'gr\xfcn'\n")
    assert faults_of(path)[0].startswith("byte 22: a scene file is UTF-8 text")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (f"a = {'[' * 10**5}{']' * 10**5}", "nested too deeply"),
        (f"format = 1{'0' * 5000}", "Exceeds the limit (4300 digits)"),
        (f'format = 1\n[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1{"0" * 400}', "at most 1e+150"),
        ('format = 1\n[[object]]\nshape = "mesh"\nfile = "C:\\Users\\a.obj"', "write a Windows path in '...'"),
        ('format = 1\n[[object]]\nshape = "mesh"\nfile = "a\\u0000.obj"', "not the name of a file"),
    ],
)
def test_extreme_text_is_one_line(scene_file, text: str, said: str) -> None:
    (line,) = faults_of(scene_file(text))
    assert said in line
    assert len(line) < 300


@pytest.mark.parametrize("kind", ["pipe", "device"])
def test_what_is_not_a_regular_file_is_refused_at_once(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    if kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    assert faults_of(path) == [f"must be a file, got a {kind}"]

"""Text in other encodings, extreme numbers and nesting, and files that are no regular files."""

import os
from pathlib import Path

import pytest

import tracer
from tests.tracer.formats.test_meshes import glb, obj, write
from tests.tracer.formats.test_scene_files import faults_of
from tracer.shapes.mesh import Mesh


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


@pytest.mark.parametrize("mark", ["\x85", "\u2028", "\x0c", "\x1c"])
def test_only_line_ends_end_a_comment(mark: str, tmp_path: Path) -> None:
    """Python knows more line ends. One of them is the byte of "..." in Windows-1252."""
    nff = tmp_path / "a.nff"
    nff.write_text(f"f 1 1 1 1 0 0 0 0\ns 0 0 0 1\n# a second ball:{mark}s 2 2 0 1\n", "utf-8")
    assert len(tracer.load(nff).objects) == 1
    write(tmp_path / "a.mtl", f"newmtl a\nKd 0 0 1\n# glass{mark}d 0.2\n")
    scene = tracer.load(write(tmp_path / "a.obj", obj("mtllib a.mtl\nusemtl a")))
    assert scene.objects[0].material.transmit == 0.0


def test_a_line_of_another_encoding_does_not_change_the_names_of_the_others(tmp_path: Path) -> None:
    write(tmp_path / "a.mtl", b"# gr\xfcn\nnewmtl " + "Körper\nKd 1 0 0\n".encode())
    world = tracer.prepare(tracer.load(write(tmp_path / "a.obj", obj("mtllib a.mtl\nusemtl Körper"))))
    assert world.scene.objects[0].material.color == (1.0, 0.0, 0.0)
    assert world.notes == []


@pytest.mark.parametrize(
    ("library", "statement"),
    [("my  mats.mtl", "my  mats.mtl"), ("scene #1.mtl", "scene #1.mtl"), ("a b.mtl", '"a b.mtl" # all')],
)
def test_names_of_libraries(library: str, statement: str, tmp_path: Path) -> None:
    write(tmp_path / library, "newmtl a\nKd 1 0 0\n")
    path = write(tmp_path / "a.obj", obj(f"mtllib {statement}\nusemtl a"))
    assert tracer.load(path).objects[0].material.color == (1.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("Material #25", "Material #25"),
        ("red # the walls", "red"),
        ("dark \t red", "dark red"),
        ("赤\u3000色", "赤\u3000色"),
    ],
)
def test_names_of_materials(name: str, shown: str, tmp_path: Path) -> None:
    write(tmp_path / "a.mtl", f"newmtl {name}\nKd 1 0 0\n")
    world = tracer.prepare(tracer.load(write(tmp_path / "a.obj", obj(f"mtllib a.mtl\nusemtl {name}"))))
    assert [(item.name, item.material.name) for item in world.scene.objects] == [(shown, shown)]
    assert world.notes == []


def test_a_comment_that_ends_with_a_backslash_is_not_continued(tmp_path: Path) -> None:
    text = "# from C:\\models\\\nv 0 0 0\nv 1 0 \\\n0\nv 0 1 0\nf 1 2 3 # D:\\\nf 3 2 1\n"
    (item,) = tracer.load(write(tmp_path / "a.obj", text)).objects
    assert isinstance(item.shape, Mesh)
    assert item.shape.placed()[0].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert len(item.shape.geometry.faces) == 2


def test_names_have_no_control_characters(tmp_path: Path) -> None:
    path = write(tmp_path / "a.glb", glb({"name": "b\x07"}, nodes=[{"mesh": 0, "name": "a\n\ud800\u001b[31m"}]))
    (item,) = tracer.load(path).objects
    assert (item.name, item.material.name) == ("a\\n\\ud800\\x1b[31m", "b\\x07")


def test_a_link_finds_the_library_beside_its_target(tmp_path: Path) -> None:
    folder = tmp_path / "models"
    folder.mkdir()
    write(folder / "a.mtl", "newmtl a\nKd 1 0 0\n")
    write(folder / "a.obj", obj("mtllib a.mtl\nusemtl a"))
    (tmp_path / "link.obj").symlink_to(folder / "a.obj")
    assert tracer.load(tmp_path / "link.obj").objects[0].material.color == (1.0, 0.0, 0.0)


@pytest.mark.parametrize("kind", ["pipe", "device"])
def test_what_is_not_a_regular_file_is_refused_at_once(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    if kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    assert faults_of(path) == [f"must be a file, got a {kind}"]

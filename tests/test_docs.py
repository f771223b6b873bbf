"""The README and docs/ agree with what the program does."""

import json
import re
import shlex
import textwrap
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

import tracer
from tests import ROOT
from tracer.formulas.media import INDICES
from tracer.scene import Camera, Image, Light, Material, Object, Tracing
from tracer.tree.text import tree_text
from viewer.cli import main
from viewer.cli.main import make_parser
from viewer.cli.view import CONTENTS
from viewer.lessons import lesson

README = (ROOT / "README.md").read_text(encoding="utf-8")
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
FORMAT = (ROOT / "docs" / "scene-format.md").read_text(encoding="utf-8")


def blocks(start: str) -> list[str]:
    """The README's indented blocks whose first line starts with `start`."""
    found = re.findall(r"(?:^    .*\n|^\n(?=    ))+", README, re.MULTILINE)
    dedented = [textwrap.dedent(block).strip("\n") for block in found]
    return [block for block in dedented if block.startswith(start)]


def test_traced_tree() -> None:
    (example,) = blocks("$ raytree trace")
    command, said = example.split("\n", 1)
    options = make_parser().parse_args(shlex.split(command)[2:])
    tree = tracer.trace(tracer.prepare(tracer.load(lesson.read(options.scene).scene)), options.pixel)
    assert said == tree_text(tree).rstrip("\n")


def test_every_command_is_understood() -> None:
    lines = blocks("raytree  ")[0].splitlines()
    assert len(lines) > 5
    for line in lines:
        command = re.split(r"\s{2,}", line)[0]
        options = make_parser().parse_args(shlex.split(command)[1:])
        assert options.command is None or options.command in command


def test_python_example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (example,) = blocks("import tracer")
    (tmp_path / "scene.toml").write_text(blocks("format = 1")[0])
    monkeypatch.chdir(tmp_path)
    space: dict = {}
    exec(example, space)  # the README's own example
    assert space["image"].pixels.shape == (480, 640, 3)
    assert not np.any(space["image"].pixels)  # the README calls it a black ball before a black background
    assert len(space["tree"]) == 1


def test_example_of_the_public_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (example,) = blocks("import raytree")
    (tmp_path / "scene.toml").write_text(blocks("format = 1")[0])
    monkeypatch.chdir(tmp_path)
    space: dict = {}
    exec(example, space)  # the README's own example
    assert space["tree"].radiance.tolist() == [0.0, 0.0, 0.0]


def test_scene_format_is_read_and_its_defaults_are_those(tmp_path: Path) -> None:
    """The example in docs/scene-format.md loads, and each value that it calls a default is one."""
    example = FORMAT.split("```toml\n")[1].split("```")[0]
    (tmp_path / "scene.toml").write_text(example)
    scene = tracer.load(tmp_path / "scene.toml")
    (item,), (light,) = scene.objects, scene.lights
    marked = re.findall(r"^(\w+) = [^#\n]*# default", example, re.MULTILINE)
    assert set(marked) == {
        "up",
        "fov",
        "width",
        "height",
        "samples",
        "depth",
        "shadows",
        "model",
        "ambient",
        "color",
        "priority",
        "thin",
    }
    assert (scene.camera.up, scene.camera.fov) == (Camera().up, Camera().fov)
    assert scene.image == Image()
    assert scene.tracing == Tracing()
    assert item.material.color == Material().color == Light().color
    assert (item.priority, item.thin) == (Object.__dataclass_fields__["priority"].default, False)
    assert light.color == (0.7, 0.7, 0.7)
    assert item.material.checker is not None


def test_every_named_index_is_listed() -> None:
    listed = re.search(r"Names for `ior`: (.*?)\.\n\n", FORMAT, re.DOTALL)
    assert listed
    pairs = (part.rsplit(" ", 1) for part in listed[1].replace("\n", " ").split(", "))
    assert {name: float(n) for name, n in pairs} == INDICES


def test_the_picture_of_the_viewer_is_of_this_version(tmp_path: Path) -> None:
    """It names the menus, panels, legend and rays that are to be seen in it. `make picture` draws it again."""
    (command,) = re.findall(r"^picture:.*\n\t\$\(BIN\)/raytree (view .*)docs/viewer.png$", MAKEFILE, re.MULTILINE)
    assert main.main([*command.split(), str(tmp_path / "now.png")]) == 0
    pictures = [PIL.Image.open(path) for path in (ROOT / "docs" / "viewer.png", tmp_path / "now.png")]
    old, new = (json.loads(picture.info[CONTENTS]) for picture in pictures)
    assert old == new and set(new) == {"menus", "panels", "legend", "rays"}
    assert pictures[0].size == pictures[1].size
    assert len(new["rays"]) > 3 and "Ray tree" in new["panels"]

"""Commands in processes of their own: their output, the files that they write, and their exit status."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import tracer
from tests.conftest import ALL_LESSONS, EACH_LESSON, LESSONS
from viewer.base.srgb import srgb
from viewer.cli import plan as plan_command
from viewer.cli.main import main
from viewer.figures.catalogue import DATA
from viewer.lessons import lesson


def raytree(*arguments: str, cwd: Path | None = None, **environment: str) -> subprocess.CompletedProcess:
    """Run the installed command in a process."""
    command = [str(Path(sys.executable).parent / "raytree"), *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, cwd=cwd, env={**os.environ, **environment}, check=False
    )


def test_version_and_help() -> None:
    run = raytree("--version")
    assert run.returncode == 0
    assert run.stdout.startswith("raytree ")
    for command in ((), ("view",), ("trace",), ("render",), ("plan",), ("lessons",)):
        run = raytree(*command, "--help")
        assert run.returncode == 0
        assert run.stdout.startswith("usage: raytree")


def test_lessons_are_listed_a_line_each(capsys: pytest.CaptureFixture) -> None:
    assert main(["lessons"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ALL_LESSONS
    assert all(len(line.split()) > 1 for line in lines)


@pytest.mark.parametrize("name", EACH_LESSON)
def test_trace_in_every_format(name: str, capsysbinary: pytest.CaptureFixture, worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds[name], (320, 240), depth=2)
    said = {}
    for form in ("text", "json", "csv", "dot"):
        assert main(["trace", name, "--pixel", "320,240", "--depth", "2", "--format", form]) == 0
        said[form] = capsysbinary.readouterr().out.decode()
    document = json.loads(said["json"])
    assert document["radiance"] == tree.radiance.tolist()
    assert document["scene"].endswith("scene.toml")
    assert re.search(r"pixel 320,240 of 80[01]x60[01], depth 2", said["text"])
    assert len(said["csv"].splitlines()) == len(tree) + 1
    assert said["dot"].startswith("digraph")


def test_trace_a_ray_with_minus_signs(capsysbinary: pytest.CaptureFixture) -> None:
    assert main(["trace", "mirror-balls", "--ray", "-1,2,5,-0.1,-0.5,-1", "--format", "json"]) == 0
    document = json.loads(capsysbinary.readouterr().out)
    assert document["pixel"] is None
    assert document["nodes"][0]["origin"] == [-1.0, 2.0, 5.0]


def test_trace_into_a_file(tmp_path: Path) -> None:
    target = tmp_path / "tree.json"
    assert (
        main(["trace", "two-lights", "--pixel", "1,2", "--size", "30x20", "--format", "json", "-o", str(target)]) == 0
    )
    assert json.loads(target.read_text())["size"] == [30, 20]
    assert list(tmp_path.iterdir()) == [target]


def test_render_in_every_format(tmp_path: Path, worlds: dict[str, tracer.World]) -> None:
    expected = tracer.render(worlds["glass-ball"], (80, 60), depth=2).pixels
    for suffix in ("png", "npy", "exr"):
        path = tmp_path / f"image.{suffix}"
        stats = tmp_path / "stats.json"
        arguments = ["render", "glass-ball", "-o", str(path), "--size", "80x60", "--depth", "2", "--stats", str(stats)]
        assert main(arguments) == 0
    assert (np.load(tmp_path / "image.npy") == expected).all()
    assert (np.array(Image.open(tmp_path / "image.png")) == srgb(expected)).all()
    import OpenEXR

    linear = OpenEXR.File(str(tmp_path / "image.exr")).channels()["RGB"].pixels
    assert (linear == expected.astype(np.float32)).all()
    found = json.loads((tmp_path / "stats.json").read_text())
    assert list(found["seconds"]) == ["load", "prepare", "compile", "trace"]
    assert list(found["rays"]) == ["camera", "reflection", "refraction", "tir", "shadow"]
    assert found["rays"]["camera"] == 80 * 60
    assert (found["size"], found["samples"], found["depth"]) == ([80, 60], 1, 2)
    assert set(found["residual"]) == {"max", "mean"}
    assert "vertex normals" in found["left_out"]


def test_several_scenes_are_rendered_into_a_folder(tmp_path: Path, worlds: dict[str, tracer.World]) -> None:
    """A scene with a fault is named and left out; the others are rendered."""
    (tmp_path / "bad.toml").write_text('format = 1\n[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = -1\n')
    arguments = ["two-lights", "bad.toml", "scale", "-o", "figures/", "--format", "npy", "--size", "40x30"]
    run = raytree("render", *arguments, "--stats", "stats.json", cwd=tmp_path)
    assert run.returncode == 2
    assert run.stderr == "bad.toml: object[0]: radius must be > 0, got -1\n"
    assert sorted(path.name for path in (tmp_path / "figures").iterdir()) == ["scale.npy", "two-lights.npy"]
    for name in ("two-lights", "scale"):
        expected = tracer.render(worlds[name], (40, 30)).pixels
        assert np.load(tmp_path / "figures" / f"{name}.npy").tobytes() == expected.tobytes()
    figures = json.loads((tmp_path / "stats.json").read_text())["images"]
    assert [figure["image"] for figure in figures] == ["figures/two-lights.npy", "figures/scale.npy"]


def test_plan_says_what_is_left_out_and_why(capsysbinary: pytest.CaptureFixture) -> None:
    assert main(["plan", "mirror-balls"]) == 0
    lines = capsysbinary.readouterr().out.decode().splitlines()
    table = {line[:20].strip(): line[20:] for line in lines}
    assert any(key.startswith("refraction") and "left out" in key + row for key, row in table.items())
    assert main(["plan", "glass-ball"]) == 0
    assert "vertex normals" in capsysbinary.readouterr().out.decode()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["trace", "no-such-lesson", "--pixel", "1,1"], 'no lesson "no-such-lesson"'),
        (["trace", "miror-balls", "--pixel", "1,1"], 'did you mean "mirror-balls"?'),
        (["trace", "nothing.toml", "--pixel", "1,1"], "nothing.toml: file not found"),
        (["view", "nothing.nff", "--screenshot", "view.png"], "nothing.nff: file not found"),
        (["view", "nothing.nff"], "nothing.nff: file not found"),
        (["render", "drop", "panes", "-o", "image.png"], "the images of several scenes need a folder, got image.png"),
        (["trace", "scene.xyz", "--pixel", "1,1"], "scene.xyz: a scene must be one of .toml"),
        (["trace", "mirror-balls", "--pixel", "800,0"], "pixel must be within 0,0 .. 799,599, got 800,0"),
        (["trace", "mirror-balls", "--pixel", "-1,0"], "pixel must be within 0,0 .. 799,599, got -1,0"),
        (["trace", "mirror-balls", "--pixel", "12"], "two whole numbers like 320,240"),
        (["trace", "mirror-balls", "--ray", "0,0,0,0,0,0"], "direction must not be 0,0,0"),
        (["trace", "mirror-balls", "--ray", "0,0,nan,0,0,1"], "six finite numbers"),
        (["trace", "mirror-balls", "--ray", "0,0,0"], "six numbers"),
        (["trace", "mirror-balls"], "one of the arguments --pixel --ray is required"),
        (["trace", "mirror-balls", "--pixel", "1,1", "--depth", "-1"], "a whole number >= 0"),
        (["trace", "mirror-balls", "--pixel", "1,1", "--format", "xml"], f"one of {', '.join(DATA)}"),
        (["render", "mirror-balls"], "the following arguments are required: -o"),
        (["render", "mirror-balls", "-o", "image.bmp"], "an image must be one of .png, .npy, .exr"),
        (["render", "mirror-balls", "-o", "no/such/folder/image.png"], "folder not found"),
        (["render", "mirror-balls", "-o", "image.png", "--samples", "0"], "a whole number >= 1"),
        (["render", "mirror-balls", "-o", "image.png", "--size", "0x4"], "a size from 1x1"),
        (["render", "mirror-balls", "two-lights", "-o", "no/such/folder"], "folder not found"),
        (
            ["render", "mirror-balls", "mirror-balls", "-o", "all"],
            "2 scenes would be written to the same file: mirror-b",
        ),
        (["render", "mirror-balls", "-o", "image.png", "--format", "npy"], "--format is for images in a folder"),
        (
            ["render", "mirror-balls", "-o", "image.png", "--dask", "nowhere"],
            'must be like tcp://host:8786, got "nowhere"',
        ),
        (["render", "mirror-balls", "-o", "image.png", "--dask", "a:1", "--threads", "2"], "not allowed with argument"),
        (["view", "mirror-balls", "--screenshot", "shot.jpg"], "a screenshot must be a .png file"),
        (["view", "mirror-balls", "--screenshot", "shot.png", "--pixel", "-3,1"], "within 0,0 .. 799,599, got -3,1"),
        (["view", "mirror-balls", "--screenshot", "shot.png", "--pixel", "9999,1"], "got 9999,1"),
        (["glass-ball"], 'no command "glass-ball": did you mean "raytree view glass-ball"?'),
        (["traec"], 'did you mean "raytree trace"?'),
    ],
)
def test_unusable_arguments_are_one_line_and_status_2(arguments: list[str], said: str, tmp_path: Path) -> None:
    run = raytree(*arguments, cwd=tmp_path)
    assert run.returncode == 2
    assert said in run.stderr
    assert len(run.stderr.splitlines()) == 1
    assert run.stdout == ""
    assert list(tmp_path.iterdir()) == []


def test_every_fault_of_a_scene_is_a_line(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(
        'format = 1\n[camera]\nfov = 0\n[[object]]\nname = "ball"\nshape = "sphere"\ncenter = [0, 0]\nradius = -1\n'
    )
    for command in (
        ["trace", "--pixel", "0,0"],
        ["render", "-o", "x.png"],
        ["plan"],
        ["view", "--screenshot", "x.png"],
    ):
        run = raytree(command[0], "scene.toml", *command[1:], cwd=tmp_path)
        assert run.returncode == 2
        assert run.stderr.splitlines() == [
            "scene.toml: camera: fov must be > 0 and < 180, got 0",
            'scene.toml: object[0] "ball": center must be three numbers [x, y, z], got [0, 0]',
            'scene.toml: object[0] "ball": radius must be > 0, got -1',
        ]


def test_a_name_on_the_command_line_is_the_lesson_of_that_name() -> None:
    for name in LESSONS:
        found = lesson.read(name)
        assert found.scene.is_file()
        assert found.first.state.pixel is not None


def test_plan_and_statistics_leave_out_the_same(tmp_path: Path, capsysbinary: pytest.CaptureFixture) -> None:
    for name in LESSONS:
        assert (
            main(["render", name, "--size", "4x3", "-o", str(tmp_path / "a.npy"), "--stats", str(tmp_path / "s")]) == 0
        )
        capsysbinary.readouterr()
        assert main(["plan", name, "--json"]) == 0
        plan = json.loads(capsysbinary.readouterr().out)
        left_out = {need["name"] for need in plan["needs"] if not need["needed"]}
        stats = set(json.loads((tmp_path / "s").read_text())["left_out"])
        tracers = {need.name for need in tracer.prepare(tracer.load(lesson.read(name).scene)).needs}
        assert stats == left_out & tracers


def test_plan_is_measured(capsysbinary: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every line has its measurement or a reason for having none. As text it fits into 100 columns."""
    monkeypatch.setattr("tracer.measure.plan.savings.BUDGET", 0.1)  # the fewest runs
    texts = []
    as_json = plan_command.as_json
    monkeypatch.setattr(plan_command, "as_json", lambda plan: texts.append(plan_command.as_text(plan)) or as_json(plan))
    assert main(["plan", "glass-ball", "--measure", "--json"]) == 0
    plan = json.loads(capsysbinary.readouterr().out)
    assert {"rays", "seconds", "compared"} <= set(plan["together"])
    assert plan["together"]["changed"] == 0
    needs = {need["name"]: need for need in plan["needs"]}
    assert needs["glass pass, shader"]["needed"] == needs["refraction"]["needed"] is True
    for need in plan["needs"]:
        if need["of"] == "image":
            assert need["compared"]
            assert "seconds" in need or need["name"] in ("vertex normals", "light through glass")
    assert needs["checker"]["rays"]["with"] == needs["checker"]["rays"]["without"]
    lines = texts[0].splitlines()
    assert max(map(len, lines)) <= 100
    assert lines[-1].endswith(".")
    assert "×" in lines[-1]

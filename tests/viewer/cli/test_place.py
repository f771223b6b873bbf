"""The place in a lesson that `trace`, `export` and `view` are about: its pixel, sample, depth, model and scene."""

import json
from pathlib import Path

import pytest

import tracer
from viewer.cli.main import main
from viewer.lessons.image_place import ray_between

SCENE = """
format = 1
[camera]
position = [0, 1, 6]
look_at = [0, 0.2, 0]
[image]
width = 64
height = 48
samples = 4
[[material]]
name = "glass"
reflect = 0.1
transmit = 0.8
ior = 1.5
[[object]]
name = "ball"
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "glass"
"""
LESSON = """+++
title = "Glass"
question = "Why?"
+++
## Whole

```step
pixel = [0, 0]
```

## Changed

```step
pixel = [30, 18]
sample = 2
depth = 2
model = "fresnel"
hit = "T"
show = ["camera", "refraction"]
set = { material.glass.ior = 1.3 }
```

## Swept

```step
sweep = { of = "pixel", from = [30, 18], to = [36, 21] }
```

## Denser

```step
sweep = { of = "material.glass.ior", from = 1.3, to = 1.7 }
```
"""
CHANGES = {"material": {"glass": {"ior": 1.3}}}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    (tmp_path / "lesson.md").write_text(LESSON, "utf-8")
    return tmp_path


def test_a_step_is_traced_as_it_asks_for(folder: Path) -> None:
    def nodes(*words: str, command: str = "trace") -> list:
        out = folder / "a.json"
        assert main([command, str(folder), *words, "--format", "json", "-o", str(out)]) == 0
        return json.loads(out.read_text("utf-8"))["nodes"]

    def traced(changes: dict, pixel: tuple[int, int] | None, **how) -> list:
        world = tracer.prepare(tracer.load(folder / "scene.toml", changes=changes))
        if "between" in how:
            how["ray"] = ray_between(world, how.pop("between"))
        return json.loads(tracer.trace(world, pixel, **how).to_json())["nodes"]

    own = {"sample": 2, "depth": 2, "model": "fresnel"}
    denser = {"material": {"glass": {"ior": 1.3 + 0.25 * (1.7 - 1.3)}}}
    for command in ("trace", "export"):
        assert nodes("--at", "2", command=command) == traced(CHANGES, (30, 18), **own)
        assert nodes("--at", "2", "--pixel", "31,19", command=command) == traced(CHANGES, (31, 19), **own)
        assert nodes("--at", "2", "--depth", "1", "--sample", "0", "--model", "whitted", command=command) == (
            traced(CHANGES, (30, 18), sample=0, depth=1, model="whitted")
        )
        assert nodes("--at", "3.1", command=command) == traced(CHANGES, (36, 21), **own)
        between = {"between": (32.4, 19.2), "depth": 2, "model": "fresnel"}
        assert nodes("--at", "3", "--swept", "0.4", command=command) == traced(CHANGES, None, **between)
        assert nodes("--at", "4", "--swept", "0.26", command=command) == traced(denser, (36, 21), **own)
    assert nodes() == traced({}, (0, 0), sample=0)
    assert nodes("--pixel", "30,18") == traced({}, (30, 18), sample=0)  # as the scene's file has it


def test_a_figure_of_a_step_has_its_hit_and_its_kinds_of_rays(folder: Path) -> None:
    def figure(*words: str) -> str:
        out = folder / "a.svg"
        assert main(["export", str(folder), "--at", "2", *words, "-o", str(out)]) == 0
        return out.read_text("utf-8").split("</metadata>")[1]

    assert figure("--figure", "hit") == figure("--figure", "hit", "--node", "T")
    assert figure() == figure("--filter", "camera,refraction") != figure("--filter", "camera,reflection,refraction")


@pytest.mark.parametrize("command", [["trace"], ["export", "-o", "a.svg"], ["view", "--screenshot", "a.png"], ["view"]])
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["scene.toml", "--at", "2"], "scene.toml: --at is for a lesson; this is a scene"),
        (["scene.toml", "--swept", "0.2"], "scene.toml: --swept is for a lesson; this is a scene"),
        ([".", "--at", "5"], "lesson.md: --at must be within 1 .. 4, got 5"),
        ([".", "--swept", "0"], "lesson.md: --swept needs --at with a step that has a sweep (3, 4), got no --at"),
        (
            [".", "--at", "1.1", "--swept", "0.5"],
            "lesson.md: --swept needs --at with a step that has a sweep (3, 4), got --at 1",
        ),
    ],
)
def test_a_place_that_there_is_not_is_one_line(
    folder: Path, command: list[str], words: list[str], said: str, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.chdir(folder)
    assert main([command[0], words[0], *command[1:], *words[1:]]) == 2
    assert capsys.readouterr() == ("", f"{said}\n")
    assert sorted(path.name for path in folder.iterdir()) == ["lesson.md", "scene.toml"]


def test_a_figure_of_a_scene_has_no_place_in_a_lesson(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    assert main(["export", "scene.toml", "--pixel", "30,18", "-o", "a.svg"]) == 0
    capsys.readouterr()
    for words in (["trace"], ["view", "--screenshot", "a.png"]):
        assert main([words[0], "a.svg", *words[1:], "--at", "2"]) == 2
        assert capsys.readouterr().err.splitlines()[-1] == "a.svg: --at is for a lesson; this is a scene"


def test_a_place_between_pixels_has_no_samples(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["trace", str(folder), "--at", "3", "--swept", "0.4", "--sample", "1"]) == 2
    assert capsys.readouterr().err == "raytree trace: --sample is for a pixel: --swept 0.4 is between pixels\n"

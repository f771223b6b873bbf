"""The number of samples of a pixel that a scene file gives."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import tracer
from tracer.formulas.camera import pixel_direction
from tracer.formulas.sampler import image_points, make_samples, sample_number
from viewer.cli.main import main
from viewer.lessons import lesson

SIZE, COUNT = (40, 30), 4
PIXELS = [(0, 0), (13, 9), (20, 15), (26, 21), (39, 29)]


def with_samples(name: str, folder: Path, count: int = COUNT, size: tuple[int, int] = SIZE) -> Path:
    """A copy of a lesson's scene, small, with so many samples of a pixel."""
    width, height = size
    image = f"[image]\nwidth = {width}\nheight = {height}\nsamples = {count}\n"
    text, changed = re.subn(
        r"\[image\]\nwidth = \d+\nheight = \d+\n", image, lesson.read(name).scene.read_text("utf-8")
    )
    assert changed == 1
    path = folder / f"{name}-{count}.toml"
    path.write_text(text, "utf-8")
    return path


def mean(colors: list[np.ndarray]) -> np.ndarray:
    """Summed up in their order, as the image does it."""
    total = np.zeros(3)
    for color in colors:
        total = total + color
    return total / len(colors)


@pytest.mark.parametrize("name", ["two-lights", "mirror-balls"])
def test_an_image_is_the_mean_of_the_trees_of_its_samples(name: str, tmp_path: Path) -> None:
    """To the last bit. Each tree's camera ray goes through the point of its sample."""
    world = tracer.prepare(tracer.load(with_samples(name, tmp_path)))
    image = tracer.render(world)
    assert image.samples == COUNT and image.size == SIZE
    assert image.pixels.tobytes() == tracer.render(world, samples=COUNT).pixels.tobytes()
    differs = 0
    for x, y in PIXELS:
        trees = [tracer.trace(world, (x, y), sample=k) for k in range(COUNT)]
        assert mean([tree.radiance for tree in trees]).tobytes() == image.pixels[y, x].tobytes()
        points = image_points(x, y, make_samples(COUNT))
        assert [tree.image_point for tree in trees] == points
        assert {(int(2 * (px - x)), int(2 * (py - y))) for px, py in points} == {(0, 0), (0, 1), (1, 0), (1, 1)}
        for tree, point in zip(trees, points, strict=True):
            assert tuple(tree.nodes["direction"][0]) == pixel_direction(world.view(), *point)
        differs += len({tree.radiance.tobytes() for tree in trees}) > 1
    assert differs >= 2  # otherwise any order of any samples would do

    # An option goes before the scene's number. Without a sample, a tree is that of the pixel's centre.
    plain = tracer.render(world, samples=1).pixels
    assert plain.tobytes() != image.pixels.tobytes()
    centre = tracer.trace(world, PIXELS[1])
    assert centre.radiance.tobytes() == plain[PIXELS[1][1], PIXELS[1][0]].tobytes()
    assert centre.sample is None and centre.image_point == (PIXELS[1][0] + 0.5, PIXELS[1][1] + 0.5)


def test_commands_use_the_samples_of_the_scene(tmp_path: Path, capsysbinary: pytest.CaptureFixture) -> None:
    path = with_samples("two-lights", tmp_path)
    world = tracer.prepare(tracer.load(path))
    for options, count in (([], COUNT), (["--samples", "1"], 1)):
        assert main(["render", str(path), "-o", str(tmp_path / "image.npy"), *options]) == 0
        assert np.load(tmp_path / "image.npy").tobytes() == tracer.render(world, samples=count).pixels.tobytes()
    capsysbinary.readouterr()
    colors = []
    for k in range(COUNT):
        assert main(["trace", str(path), "--pixel", "13,9", "--sample", str(k), "--format", "json"]) == 0
        found = json.loads(capsysbinary.readouterr().out)
        assert found["sample"] == k
        colors.append(np.array(found["radiance"]))
    assert mean(colors).tobytes() == tracer.render(world).pixels[9, 13].tobytes()
    assert main(["trace", str(path), "--pixel", "13,9"]) == 0
    assert b": pixel 13,9 of 40x30, sample 0 of 4, depth " in capsysbinary.readouterr().out
    plain = with_samples("two-lights", tmp_path, 1)
    assert main(["trace", str(plain), "--pixel", "13,9", "--format", "json"]) == 0
    assert json.loads(capsysbinary.readouterr().out)["sample"] is None


@pytest.mark.parametrize("value", ["0", "4097", "2.0", '"four"', "true"])
def test_what_is_no_number_of_samples_is_a_line(value: str, tmp_path: Path) -> None:
    path = with_samples("two-lights", tmp_path)
    path.write_text(path.read_text("utf-8").replace("samples = 4", f"samples = {value}"), "utf-8")
    with pytest.raises(tracer.SceneError) as caught:
        tracer.load(path)
    (fault,) = caught.value.faults
    assert "image: samples must be a whole number from 1 to 4096, got " in fault


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["trace", "--pixel", "1,1", "--sample", "4"],
            "sample must be within 0 .. 3 (the scene has samples = 4), got 4",
        ),
        (["trace", "--ray", "0,0,9,0,0,-1", "--sample", "1"], "trace: --sample is for a pixel: a ray has no samples"),
        (["trace", "--pixel", "1,1", "--sample", "-1"], 'argument --sample: a whole number >= 0, got "-1"'),
        (["export", "--pixel", "1,1", "--sample", "9", "-o", "a.svg"], "sample must be within 0 .. 3 (the scene has"),
        (["export", "--ray", "0,0,9,0,0,-1", "--sample", "1", "-o", "a.svg"], "export: --sample is for a pixel"),
        (["view", "--pixel", "1,1", "--sample", "4", "--screenshot", "a.png"], "--sample must be within 0 .. 3 (the"),
    ],
)
def test_a_sample_that_a_pixel_does_not_have_is_a_line(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture
) -> None:
    path = with_samples("two-lights", tmp_path)
    monkeypatch.chdir(tmp_path)
    command, *options = arguments
    try:
        status = main([command, str(path), *options])
    except SystemExit as ended:  # by the parser
        status = ended.code
    assert status == 2
    assert said in capfd.readouterr().err.splitlines()[-1]
    assert not (tmp_path / "a.svg").exists() and not (tmp_path / "a.png").exists()


def test_sample_numbers_in_python() -> None:
    assert [sample_number(1), sample_number(1, 0), sample_number(5), sample_number(5, 4)] == [None, None, 0, 4]
    world = tracer.prepare(tracer.load(lesson.read("two-lights").scene))
    for options, said in (
        ({"pixel": (1, 1), "sample": -1}, "sample must be >= 0, got -1"),
        ({"pixel": (1, 1), "sample": 4, "samples": 4}, "sample must be within 0 .. 3, got 4"),
        ({"pixel": (1, 1), "samples": 0}, "samples must be >= 1, got 0"),
        ({"ray": ((0, 0, 9), (0, 0, -1)), "sample": 0}, "a ray that is given by hand has no samples, got sample 0"),
    ):
        with pytest.raises(ValueError, match=re.escape(said)):
            tracer.trace(world, **options)

"""`raytree view` with a state, as the program: the same window again, to the last pixel."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from tests.viewer.driver import are_equal, viewer
from tests.viewer.session.test_reopening import change_everything, still
from viewer.cli.main import main
from viewer.reopen.view_state import ViewState
from viewer.session.restore.command import scene_word, view_command

CLOCK = (slice(670, None), slice(1000, None))  # rows and columns of the seconds that an image took


def picture(path: Path) -> np.ndarray:
    pixels = np.asarray(PIL.Image.open(path).convert("RGB")).copy()
    pixels[CLOCK] = 0
    return pixels


def raytree(*words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    program = [sys.executable, "-c", "from viewer.cli.main import program; program()", *words]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])}
    return subprocess.run(program, capture_output=True, text=True, cwd=cwd, env=environment)


@pytest.mark.parametrize("scene", ["glass-ball", "scale", "a b'$ö.toml"])
def test_a_copied_command_line_opens_an_equal_window(tmp_path: Path, scene: str) -> None:
    """Compared as the state and as the picture. The line is run by a shell, in another folder."""
    with viewer() as driver:
        if scene.endswith("toml"):
            path = tmp_path / scene
            path.write_text(
                'format = 1\n[image]\nwidth = 400\nheight = 300\n[[material]]\nname = "m"\nambient = 1\nreflect = 0.5\n'
                '[[object]]\nshape = "sphere"\ncenter = [1e3, 7, 3]\nradius = 0.3\nmaterial = "m"\n'
                '[[object]]\nshape = "sphere"\ncenter = [1e3, 8, 3]\nradius = 0.3\nmaterial = "m"\n'
            )
            driver.open_file(path)
        else:
            driver.open(scene)
        change_everything(driver)
        session = driver.session
        assert session.opening
        line = view_command(session, scene_word(session.opening.path, session.lesson), driver.app.surface.size)
        seen = still(driver)
    program = f"{shlex.quote(sys.executable)} -c 'from viewer.cli.main import program; program()'"
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])}
    command = line.replace("raytree view", f"{program} view", 1) + " --screenshot a.png"
    subprocess.run(["bash", "-c", command], check=True, cwd=elsewhere, env=environment)
    again = picture(elsewhere / "a.png")[:, : seen.shape[1]]
    seen = seen.copy()
    seen[CLOCK] = 0
    assert are_equal(again, seen)


def test_a_screenshot_of_a_figure_is_that_of_its_view(tmp_path: Path) -> None:
    """Options that are given go before those of the figure."""
    words = ["--pixel", "250,181", "--depth", "2", "--model", "whitted"]
    given = ["--camera", "10,20,3.3", "--select", "TR", "--theme", "light"]
    export = ["export", "glass-ball", *words, "--figure", "tree", "--reopen", shlex.join(given), "-o", "a.pptx"]
    assert raytree(*export, cwd=tmp_path).returncode == 0
    for source, more, name in (("glass-ball", words + given, "a"), ("a.pptx", [], "b")):
        run = raytree("view", source, *more, "--screenshot", f"{name}.png", cwd=tmp_path)
        assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
    assert (picture(tmp_path / "a.png") == picture(tmp_path / "b.png")).all()
    for source, more, name in (
        ("glass-ball", [*words, *given[:-1], "dark"], "c"),
        ("a.pptx", ["--theme", "dark"], "d"),
    ):
        assert raytree("view", source, *more, "--screenshot", f"{name}.png", cwd=tmp_path).returncode == 0
    assert (picture(tmp_path / "c.png") == picture(tmp_path / "d.png")).all()
    assert (picture(tmp_path / "c.png") != picture(tmp_path / "a.png")).any()


def test_export_and_trace_take_a_figure_whose_scene_is_gone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene = Path("scene.toml")
    scene.write_text('format = 1\n[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n')
    assert main(["trace", "scene.toml", "--pixel", "320,240", "--format", "json", "-o", "a.json"]) == 0
    assert main(["export", "scene.toml", "--pixel", "320,240", "--depth", "1", "-o", "a.svg"]) == 0
    scene.unlink()
    assert main(["trace", "a.svg", "--pixel", "320,240", "--format", "json", "-o", "b.json"]) == 0
    a, b = (Path(name).read_text().split('"pixel"')[1] for name in ("a.json", "b.json"))
    assert a == b
    assert main(["export", "a.svg", "-o", "b.svg"]) == 0
    assert main(["plan", "a.svg"]) == 2
    a, b = (Path(name).read_bytes().split(b"</metadata>")[1] for name in ("a.svg", "b.svg"))
    assert a == b


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["glass-ball", "--select", "TRTRTR"], "--select TRTRTR: must be a ray of this tree, which has depth 3: E, "),
        (["glass-ball", "--pixel", "99999,0"], "pixel must be within 0,0 .. "),
        (["gone.svg"], "gone.svg: file not found"),
        (["junk.svg"], "junk.svg: not XML: "),
    ],
)
def test_what_cannot_be_shown_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("junk.svg").write_text("junk")
    assert main(["view", *words, "--screenshot", "a.png"]) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1
    assert not Path("a.png").exists()


@pytest.mark.parametrize(
    "camera", ["0,90,1", "0,-90,1e-300", "1e300,0,1e300", "0,0,1,1e300,-1e300,1e300", "0,0,5e-324"]
)
def test_any_camera_draws_a_picture(tmp_path: Path, camera: str) -> None:
    run = raytree("view", "plates", f"--camera={camera}", "--screenshot", "a.png", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "") or (run.returncode == 2 and run.stderr.count("\n") == 1)


def test_a_state_is_read_from_every_option() -> None:
    from viewer.cli.main import parse

    line = "view x.toml --pixel 1,2 --depth 3 --model fresnel --up z --select E --camera=-1,2,3 --filter none"
    line += " --hide camera --theme light --type-size lecture --image-zoom 2,0.5,0.5 --tree-zoom=1,-3,4"
    line += " --step rays --order recursion --page 3 --turn 12.5"
    _, options = parse(line.split())
    assert options.state == ViewState(
        pixel=(1, 2), depth=3, model="fresnel", up="z", select="E", camera=(-1, 2, 3), filter=(), hide=("camera",),
        theme="light", type_size="lecture", image_zoom=(2, 0.5, 0.5), tree_zoom=(1, -3, 4),
        step="rays", order="recursion", page=3, turn=12.5,
    )  # fmt: skip

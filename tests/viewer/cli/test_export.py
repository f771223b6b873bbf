"""`raytree export`: file names, faults in one line, no incomplete files."""

import re
from pathlib import Path

import pytest

from tracer.extras import install_command
from viewer.cli import main
from viewer.figures.catalogue import FIGURE_NAMES, FORMATS


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_names_in_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = f"{tmp_path}/figures/"
    assert main.main(["export", "glass-ball", "--depth", "0..3", "--format", "svg,pdf,json", "-o", out]) == 0
    stem = "glass-ball_248_180"
    expected = {f"{stem}_tree_d{d}.svg" for d in range(4)} | {f"{stem}_d{d}.json" for d in range(4)}
    assert names(tmp_path / "figures") == expected | {f"{stem}_tree_d0-3.pdf"}
    assert {Path(line).name for line in capsys.readouterr().out.splitlines()} == names(tmp_path / "figures")


def test_names_of_steps(tmp_path: Path) -> None:
    for step, count in (("levels", 4), ("rays", 6), ("colour", 3)):
        folder = tmp_path / step
        arguments = ["--depth", "1", "--step", step, "--format", "svg,pptx,text", "-o", f"{folder}/"]
        assert main.main(["export", "mirror-balls", "--pixel", "370,272", *arguments]) == 0
        stem = "mirror-balls_370_272"
        first = step[0]
        assert names(folder) == {
            *(f"{stem}_tree_d1_{first}{k}.svg" for k in range(count)),
            f"{stem}_tree_d1_{step}.pptx",
            f"{stem}_d1.txt",
        }


def test_a_ray_by_hand(tmp_path: Path) -> None:
    out = tmp_path / "a.svg"
    assert main.main(["export", "glass-ball", "--ray", "0,1,6,0,0,-1", "-o", str(out)]) == 0
    assert "--ray 0.0,1.0,6.0,0.0,0.0,-1.0" in out.read_text("utf-8")


@pytest.mark.parametrize(
    ("arguments", "line"),
    (
        (["-o", "{}/a.xyz"], f"{{}}/a.xyz: must end with one of {', '.join(k.suffix for k in FORMATS.values())}"),
        (
            ["-o", "{}/a.svg", "--format", "pdf"],
            "{}/a.svg: is svg, but --format asks for pdf: name a folder, or one format",
        ),
        (["-o", "{}/a.svg", "--depth", "0..3"], "{}/a.svg: 4 pages need a folder, or one of PDF, PPTX and HTML"),
        (["-o", "{}/none/a.svg"], "{}/none/a.svg: folder not found: {}/none"),
        (["-o", "{}/none/b/"], "{}/none/b: folder not found: {}/none"),
        (["-o", "{}/file/", "--format", "svg"], "{}/file: must be a folder, got a file"),
        (["-o", "{}/b", "--format", "svg"], 'raytree export: a folder\'s name ends with "/": -o {}/b/'),
        (
            ["-o", "{}/a.svg", "--figure", "hit", "--node", "R"],
            "raytree: --node R must be the path or the label of a ray that meets a surface: E, T (T2), TR (R3), "
            "TT (T4), TRR (R5), TRT (T6)",
        ),
        (
            ["-o", "{}/a.svg", "--figure", "hit", "--node", "R4"],
            "raytree: --node R4 must be the path or the label of a ray that meets a surface: E, T (T2), TR (R3), "
            "TT (T4), TRR (R5), TRT (T6)",
        ),
        (
            ["-o", "{}/a.svg", "--figure", "hit", "--pixel", "0,0"],
            "raytree: --figure hit: the ray meets no surface",
        ),
        (["-o", "{}/a.svg", "--node", "T4"], "raytree export: --node is for --figure hit, got tree"),
        (
            ["-o", "{}/a.svg", "--view", "1,2,3"],
            "raytree export: --view is for --figure scene and both, got tree",
        ),
        (
            ["-o", "{}/a.svg", "--figure", "scene", "--eye", "left"],
            "raytree export: --eye is for --figure tree and both, got scene",
        ),
        (["-o", "{}/a.svg", "--width", "640"], "raytree export: --width is for png, got svg"),
        (
            ["-o", "{}/a.pdf", "--step", "rays", "--depth", "0..3"],
            "raytree export: --step rays goes through one tree: give one depth",
        ),
        (
            ["-o", "{}/a.pdf", "--step", "rays", "--figure", "hit"],
            "raytree export: a hit has no steps: --step rays is for tree, scene and both",
        ),
        (
            ["-o", "{}/a.pdf", "--step", "levels", "--order", "recursion"],
            "raytree export: --order recursion is for --step rays and colour, got levels",
        ),
        (
            ["-o", "{}/a.svg", "--step", "rays", "--page", "20"],
            "raytree export: --page must be within 0 .. 19, got 20",
        ),
        (
            ["-o", "{}/a.svg", "--order", "recursion"],
            "raytree export: --order recursion is for --step rays and colour, got depth",
        ),
        (
            ["-o", "{}/a.svg", "--figure", "hit", "--text-size", "28"],
            "raytree: a hit has room for text of 20 points at most, got 28",
        ),
        (
            ["-o", "{}/a.svg", "--pixel", "9999,0"],
            "raytree: pixel must be within 0,0 .. 799,599, got 9999,0",
        ),
    ),
)
def test_faults_are_one_line(
    arguments: list[str], line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    before = names(tmp_path)
    assert main.main(["export", "glass-ball", *(text.format(tmp_path) for text in arguments)]) == 2
    assert capsys.readouterr().err.strip().splitlines()[-1] == line.format(*[tmp_path] * 2)
    assert names(tmp_path) == before


@pytest.mark.parametrize("command", ["trace", "export"])
def test_a_scene_needs_a_pixel(command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], scene_file) -> None:
    scene = scene_file('format = 1\n[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n')
    assert main.main([command, str(scene), "-o", str(tmp_path / "a.svg")]) == 2
    said = f"raytree {command}: give a pixel (--pixel X,Y) or a ray (--ray ox,oy,oz,dx,dy,dz)\n"
    assert capsys.readouterr().err == said


def test_all_that_is_wrong_is_said_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["no-such-scene", "--node", "T4", "-o", f"{tmp_path}/none/a.svg"]
    assert main.main(["export", *arguments]) == 2
    scene, target, node = capsys.readouterr().err.strip().splitlines()
    assert scene.startswith('no lesson "no-such-scene" (known: ')
    assert target == f"{tmp_path}/none/a.svg: folder not found: {tmp_path}/none"
    assert node == "raytree export: --node is for --figure hit, got tree"


def test_a_ray_is_asked_for_as_figures_name_it(tmp_path: Path) -> None:
    written = []
    for node in ("TT", "T4", "t4"):
        out = tmp_path / f"{node}.svg"
        assert main.main(["export", "glass-ball", "--figure", "hit", "--node", node, "-o", str(out)]) == 0
        written.append(out.read_bytes().split(b"</metadata>")[1])
    assert written[0] == written[1] == written[2]


def test_what_has_no_room_or_no_glyph_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str], scene_file) -> None:
    both = ["panes", "--figure", "both", "--model", "fresnel"]
    assert main.main(["export", *both, "-o", str(tmp_path / "a.svg")]) == 0
    (note,) = capsys.readouterr().err.splitlines()
    size = re.fullmatch(
        r"note: both: branches that do not fit are folded; .* --text-size (\d+) shows all branches", note
    )
    assert size
    arguments = [*both, "--text-size", size[1], "-o", str(tmp_path / "b.svg")]
    assert main.main(["export", *arguments]) == 0
    assert capsys.readouterr().err == ""
    scene = scene_file('format = 1\n[[object]]\nname = "球"\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n')
    for suffix, said in (("pdf", True), ("tex", True), ("svg", False), ("pptx", False)):
        out = tmp_path / f"c.{suffix}"
        assert main.main(["export", str(scene), "--ray", "0,0,5,0,0,-1", "-o", str(out)]) == 0
        assert ('has no glyph for "球"' in capsys.readouterr().err) == said


def test_rays_to_lights_are_left_out_on_wish(tmp_path: Path) -> None:
    """Shadow rays are left out of every figure, and so are the pages about them."""
    for figure in FIGURE_NAMES:
        out = tmp_path / f"{figure}.svg"
        assert main.main(["export", "glass-ball", "--figure", figure, "--no-lights", "-o", str(out)]) == 0
        text = out.read_text("utf-8")
        assert "--no-lights" in text
        assert ">L1" not in text
        assert 'id="ray-4"' in text
        assert 'id="ray-1"' not in text
    folder = tmp_path / "steps"
    assert main.main(["export", "glass-ball", "--step", "rays", "--no-lights", "-o", f"{folder}/"]) == 0
    assert {name[-7:-4] for name in names(folder)} == {f"r{k:02}" for k in range(14)}  # 7 rays appear and are summed up


@pytest.mark.parametrize(
    ("arguments", "said"),
    (
        (["--node", "L(sun)"], "a ray that meets a surface; L(sun) goes to a light: name the ray that it starts from"),
        (
            ["--node", "T.L(sun)"],
            "a ray that meets a surface; T.L(sun) goes to a light: name the ray that it starts from",
        ),
        (["--node", "4"], 'the path or the label of a ray, like TR, R3 or E, got "4"'),
        (["--fold", "2"], 'a number from 0 to 1, got "2"'),
        (["--figur", "hit"], "unrecognized arguments: --figur"),
    ),
)
def test_bad_options(arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as leaving:
        main.main(["export", "glass-ball", "--figure", "hit", *arguments, "-o", str(tmp_path / "a.svg")])
    assert leaving.value.code == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("depth", ("3..1", "a", "0..", "-1"))
def test_bad_depths(depth: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as leaving:
        main.main(["export", "glass-ball", "--depth", depth, "-o", str(tmp_path / "a.svg")])
    assert leaving.value.code == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_without_the_extra_pptx_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "pptx", None)
    assert main.main(["export", "glass-ball", "-o", str(tmp_path / "a.pptx")]) == 2
    said = f"raytree export: PPTX needs the extra raytree[pptx]: {install_command('pptx')}"
    assert capsys.readouterr().err.strip() == said
    assert names(tmp_path) == set()

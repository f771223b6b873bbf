"""`--missing` and `--max-rays` on the command line: image and tree agree, and a limit that was reached is said."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from viewer.cli.main import main
from viewer.figures import export
from viewer.figures.figure import scene

MIRRORS = """
format = 1
camera = { position = [0.5, 0.3, 0.2], look_at = [1.0, 0.35, 0.9], fov = 50 }
image = { width = 64, height = 48 }
background = { color = [0.2, 0.3, 0.4] }
light = [{ name = "lamp", position = [0.5, 2.0, 0.5] }]
material = [{ name = "mirror", reflect = 1.0, ambient = 0.1, checker = { color = [0, 0, 0], size = 0.7 } }]
object = [
    { shape = "plane", point = [0, 0, 0], normal = [1, 0, 0], material = "mirror" },
    { shape = "plane", point = [1, 0, 0], normal = [-1, 0, 0], material = "mirror" },
]
"""


@pytest.fixture
def mirrors(tmp_path: Path) -> str:
    (tmp_path / "mirrors.toml").write_text(MIRRORS)
    return str(tmp_path / "mirrors.toml")


@pytest.mark.parametrize(
    "asked",
    [
        "--depth 9 --max-rays 14400",
        "--tolerance 1e-3 --max-rays 14400",
        pytest.param("--missing 1e-2 --max-rays 14400", marks=pytest.mark.slow),
        "--missing 0.1",
    ],
)
def test_render_and_trace_end_at_the_same_ray(asked: str, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Colours, limits and ends, with the same options."""
    limits = asked.split()
    npy, stats, file = (str(tmp_path / name) for name in ("image.npy", "stats.json", "tree.json"))
    assert main(["render", "panes", "-o", npy, "--size", "40x30", "--stats", stats, *limits]) == 0
    said = capsys.readouterr().out
    found = json.loads(Path(stats).read_text())
    pixels, ended = np.load(npy), 0
    for x, y in np.ndindex(40, 30):
        if (x + y) % 7 == 0:
            where = ["--pixel", f"{x},{y}", "--size", "40x30"]
            assert main(["trace", "panes", *where, *limits, "--format", "json", "-o", file]) == 0
            tree = json.loads(Path(file).read_text())
            assert tree["radiance"] == pixels[y, x].tolist()
            assert tree["max_nodes"] == found["max_nodes"]
            ended += any(node["end"] == "nodes" for node in tree["nodes"])
    if "--max-rays" in limits:
        assert (found["max_rays"], found["max_nodes"]) == (40 * 30 * 12, 12)
        assert 0 < ended < found["limited"]
        line = f"the limit of rays ended {found['limited']} of 1,200 pixels, each at 12 rays, shadow rays included; "
        assert line + "a --max-rays above 14,400 lets them grow\n" in said
    else:
        assert (found["max_rays"], found["max_nodes"], found["limited"]) == (10**10, 10**6, 0)
        assert "limit of rays" not in said
        assert found["missing"] == 0.1 >= found["bound"]
        assert said.endswith("within the 0.1 that was asked for\n")


def test_endless_scene_ends(mirrors: str, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    npy, stats = str(tmp_path / "image.npy"), tmp_path / "stats.json"
    limits = ["--tolerance", "0", "--max-rays", "100000"]
    assert main(["render", mirrors, "-o", npy, "--stats", str(stats), *limits]) == 0
    assert "the limit of rays ended 3,072 of 3,072 pixels, each at 32 rays" in capsys.readouterr().out
    assert sum(json.loads(stats.read_text())["rays"].values()) <= 100_000
    assert main(["trace", mirrors, "--pixel", "3,4", *limits]) == 0
    assert "stopped at the limit of 32 rays" in capsys.readouterr().out


def test_figures_have_the_limit_of_their_image(tmp_path: Path) -> None:
    for suffix, rows in (("", 1000), ("--max-rays 14400", 12)):
        target = tmp_path / f"tree-{rows}.json"
        options = ["--pixel", "20,15", "--size", "40x30", "--depth", "9", *suffix.split(), "-o", str(target)]
        assert main(["export", "panes", *options]) == 0
        tree = json.loads(target.read_text())
        assert tree["max_nodes"] == (10**6 if rows == 1000 else 12)
        assert any(node["end"] == "nodes" for node in tree["nodes"]) == (rows == 12)


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        (
            ["--missing", "0.1"],
            'raytree: --missing needs a bound on the light of a ray, and the material "mirror" has',
        ),
        (["--missing", "0.1", "--tolerance", "0.1"], "--tolerance: not allowed with argument --missing"),
        (["--missing", "-1"], 'a number >= 0, got "-1"'),
        (["--max-rays", "0"], 'a whole number >= 1, got "0"'),
    ],
)
def test_unusable_limits_are_one_line(
    limits: list[str], said: str, mirrors: str, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    for command in (["trace", mirrors, "--pixel", "3,4"], ["render", mirrors, "-o", str(tmp_path / "image.npy")]):
        try:
            status = main([*command, *limits])
        except SystemExit as end:
            status = end.code
        assert status == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert said in line
    assert not (tmp_path / "image.npy").exists()


def test_figure_of_the_scene_draws_the_heaviest_rays(
    mirrors: str, tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a tree that is too large, the table has all rows."""
    for module in (export, scene):
        monkeypatch.setattr(module, "MOST_IN_FIGURE", 3)
    options = ["--pixel", "30,20", "--depth", "20", "--figure", "scene", "--format", "svg,json"]
    assert main(["export", mirrors, *options, "-o", f"{tmp_path}/"]) == 0
    assert "scene: of 42 rays, the heaviest 3 are drawn in the scene" in capsys.readouterr().err
    svg, data = (next(tmp_path.glob(f"*.{end}")).read_text() for end in ("svg", "json"))
    assert len(json.loads(data)["nodes"]) == 42
    drawn = {int(row) for row in re.findall(r'id="ray-(\d+)', svg)}
    assert drawn == {0, 1}  # a ray and its shadow ray; the next two rows would be one too many

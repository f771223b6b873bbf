"""`raytree trace --verify` and `raytree render --bounds`."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from viewer.cli.main import main

SCENE = """
format = 1
camera = { position = [0.2, 1, 6], look_at = [0, 0, 0] }
image = { width = 16, height = 12 }
background = { color = [0.3, 0.4, 0.6] }
light = [{ position = [4, 6, 5], color = [0.7, 0.7, 0.7] }]
material = [{ name = "shiny", ambient = 0.2, diffuse = 0.3, reflect = 0.3 }]
object = [
    { shape = "sphere", center = [-0.6, 0.2, 0], radius = 0.9, material = "shiny" },
    { shape = "plane", point = [0, -0.8, 0], normal = [0, 1, 0], material = "shiny" },
]
"""


def test_trace_verified(scene_file: Callable[..., Path], capsys: pytest.CaptureFixture[str]) -> None:
    """As text and as JSON; in a format that has no place for it, one line."""
    scene = scene_file(SCENE)
    assert main(["trace", str(scene), "--pixel", "8,8", "--verify"]) == 0
    text = capsys.readouterr().out
    assert "verified with 128 bits: the exact colour is " in text
    assert "decisions are certified; " in text
    assert main(["trace", str(scene), "--pixel", "8,8", "--verify", "--format", "json"]) == 0
    tree = json.loads(capsys.readouterr().out)
    assert tree["verified"]["certified"] == tree["verified"]["decisions"] > 0
    for (low, high), color in zip(tree["verified"]["color"], tree["radiance"], strict=True):
        assert low - 1e-15 <= color <= high + 1e-15
    assert all(node["verified"]["certified"] for node in tree["nodes"])
    assert main(["trace", str(scene), "--pixel", "8,8", "--verify", "--format", "csv"]) == 2
    assert capsys.readouterr().err == "raytree trace: --verify is written as text or json, not as csv\n"


def test_render_bounds(scene_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene, target = scene_file(SCENE), tmp_path / "bounds.npy"
    assert main(["render", str(scene), "-o", str(target), "--size", "8x6", "--bounds"]) == 0
    low, high = np.load(target)
    assert low.shape == high.shape == (6, 8, 3)
    assert (low <= high).all()
    assert " decisions certified; the median pixel is known to " in capsys.readouterr().out
    exr = tmp_path / "bounds.exr"
    assert main(["render", str(scene), "-o", str(exr), "--size", "8x6", "--bounds"]) == 0
    channels = OpenEXR.File(str(exr)).channels()
    assert (channels["low"].pixels <= low).all()
    assert (channels["high"].pixels >= high).all()
    capsys.readouterr()
    for wrong, said in (
        (["-o", str(tmp_path / "b.png")], "--bounds are written as .npy or .exr, got .png"),
        (["-o", str(target), "--until-error", "0.1"], "--bounds do not go with --until-error"),
    ):
        assert main(["render", str(scene), "--bounds", *wrong]) == 2
        assert said in capsys.readouterr().err

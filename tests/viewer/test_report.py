"""`raytree report`: a page that needs nothing else, plots, and data; the same every time but for the times."""

import csv
import json
import re
import xml.etree.ElementTree as xml
from pathlib import Path

import pytest

from viewer import cli

ARGUMENTS = ["--quick", "--size", "16x12"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("report") / "new"
    assert cli.main(["report", "plates", *ARGUMENTS, "-o", str(found)]) == 0
    return found


def test_files(folder: Path) -> None:
    plots = {
        f"{source}-{what}.{kind}"
        for source in ("trees", "pixels", "together")
        for what in ("rmse-seconds", "rmse-rays", "rmse-tests", "largest-seconds", "flip-seconds")
        for kind in ("svg", "pdf")
    }
    assert {path.name for path in folder.iterdir()} == plots | {"report.html", "report.csv", "report.json"}


def test_page_needs_nothing_else(folder: Path) -> None:
    page = (folder / "report.html").read_text("utf-8")
    links = re.findall(r'(?:src|href)="([^"]+)"', page)
    assert all(link.startswith("#") for link in links)
    names = re.findall(r'\bid="([^"]+)"', page)
    assert len(names) == len(set(names))
    assert {link[1:] for link in links} <= set(names)
    assert page.count("16x12 pixels") == 3
    for words in ("Trees that are cut", "Pixels that are sampled", "Both together", "What failed", "numba"):
        assert words in page


def test_plots_say_what_their_axes_are(folder: Path) -> None:
    for path in folder.glob("*.svg"):
        text = " ".join(element.text or "" for element in xml.parse(path).iter() if element.tag.endswith("text"))
        assert ("time (s)" in text) == path.stem.endswith("seconds")
        assert ("rays traced" in text) == path.stem.endswith("rays")
        assert ("tests of a ray against a surface" in text) == path.stem.endswith("tests")
    bounds = (folder / "trees-largest-seconds.svg").read_text("utf-8")
    assert "cut at a depth: its bound" in bounds


def test_data_says_the_same(folder: Path) -> None:
    rows = list(csv.DictReader((folder / "report.csv").open(encoding="utf-8")))
    document = json.loads((folder / "report.json").read_text("utf-8"))
    assert document["format"] == "raytree-report/1"
    points = [p for s in document["sources"] for c in s["curves"] for p in c["points"]]
    assert len(rows) == len(points)
    for row, point in zip(rows, points, strict=True):
        assert row["setting"] == point["label"]
        assert float(row["rmse"]) == point["errors"]["rmse"]
        assert int(row["rays"]) == point["rays"]


def test_the_same_again_but_for_the_times(folder: Path, tmp_path: Path) -> None:
    assert cli.main(["report", "plates", *ARGUMENTS, "-o", str(tmp_path)]) == 0

    def timeless(path: Path) -> str:
        return re.sub(r'"seconds": [^,\n]+', "", path.read_text("utf-8"))

    assert timeless(tmp_path / "report.json") == timeless(folder / "report.json")
    assert (tmp_path / "pixels-rmse-rays.svg").read_bytes() == (folder / "pixels-rmse-rays.svg").read_bytes()
    assert (tmp_path / "pixels-rmse-rays.pdf").read_bytes() == (folder / "pixels-rmse-rays.pdf").read_bytes()


def test_faults_are_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert cli.main(["report", "no-such-lesson", "-o", str(tmp_path / "file")]) == 2
    scene, output = capsys.readouterr().err.splitlines()
    assert "no-such-lesson" in scene
    assert output == f"{tmp_path}/file: must be a folder, got a file"
    assert cli.main(["report", "plates", "-o", str(tmp_path / "none" / "there")]) == 2
    assert "folder not found" in capsys.readouterr().err

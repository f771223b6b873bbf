"""`raytree report`: a self-contained page, plots and data; equal every time except for the times."""

import csv
import html
import json
import math
import re
import xml.etree.ElementTree as xml
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from tracer.measure.conditions import Moment
from tracer.measure.precision.errors import Errors
from tracer.measure.precision.precision import Curve, Point, Reference, Source
from tracer.measure.precision.stiff import PROBLEMS
from tracer.measure.timing import Times
from viewer.cli import main
from viewer.lessons import lesson
from viewer.report.chapter import Chapter
from viewer.report.conditions import Conditions
from viewer.report.data import as_json
from viewer.report.page import as_html

pytestmark = pytest.mark.early

ARGUMENTS = ["--quick", "--size", "16x12"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("report") / "new"
    assert main.main(["report", "plates", *ARGUMENTS, "-o", str(found)]) == 0
    return found


@pytest.fixture
def one_plot(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two of each source only, because plots take longest."""
    monkeypatch.setattr("viewer.report.chapter.PLOTS", (("rays", "rmse"),))
    monkeypatch.setattr("viewer.report.chapter.EXACT_PLOTS", (("rays", "largest"),))


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
    for words in ("Cut trees", "Sampled pixels", "Both together", "What failed", "numba"):
        assert words in page


def test_plots_say_what_their_axes_are(folder: Path) -> None:
    for path in folder.glob("*.svg"):
        text = " ".join(element.text or "" for element in xml.parse(path).iter() if element.tag.endswith("text"))
        assert ("time (s)" in text) == path.stem.endswith("seconds")
        assert ("rays traced" in text) == path.stem.endswith("rays")
        assert ("ray-surface intersection tests" in text) == path.stem.endswith("tests")
    bounds = (folder / "trees-largest-seconds.svg").read_text("utf-8")
    assert "cut at a depth: its bound" in bounds


def test_data_says_the_same(folder: Path) -> None:
    rows = list(csv.DictReader((folder / "report.csv").open(encoding="utf-8")))
    document = json.loads((folder / "report.json").read_text("utf-8"))
    assert document["format"] == "raytree-report/1"
    points = [p for scene in document["scenes"] for s in scene["sources"] for c in s["curves"] for p in c["points"]]
    assert len(rows) == len(points)
    for row, point in zip(rows, points, strict=True):
        assert row["setting"] == point["label"]
        assert float(row["rmse"]) == point["errors"]["rmse"]
        assert int(row["rays"]) == point["rays"]
        assert int(row["runs"]) == point["runs"] >= 1
        for name in ("seconds", "lower_quartile", "upper_quartile", "cpu_seconds"):
            assert float(row[name]) == point[name] > 0.0
        assert point["lower_quartile"] <= point["seconds"] <= point["upper_quartile"]
        assert (row["busy"] == "True") == point["busy"]


def test_page_and_data_say_when_and_on_what_machine(folder: Path) -> None:
    page = html.unescape((folder / "report.html").read_text("utf-8"))
    document = json.loads((folder / "report.json").read_text("utf-8"))
    began, ended = (datetime.fromisoformat(document[name]["utc"]) for name in ("began", "ended"))
    assert began.utcoffset() == timedelta(0)
    assert abs((ended - began).total_seconds() - document["duration"]) <= 1.0
    assert document["command"] == "raytree report plates --size 16x12 --quick"
    assert f"from {began:%Y-%m-%d %H:%M:%S} UTC to {ended:%Y-%m-%d %H:%M:%S} UTC" in page
    for name in ("began", "ended"):
        assert ", ".join(f"{load:.2f}" for load in document[name]["load"]) in page
    for name, value in document["machine"].items():
        assert f"{name}: {value}" in page
    assert {"processor", "processors", "threads of a timed run", "system", "numba"} <= set(document["machine"])
    assert document["command"] in page


def test_rows_state_runs_median_and_quartiles(folder: Path) -> None:
    page = (folder / "report.html").read_text("utf-8")
    heads = re.findall(r"<thead><tr>(.*?)</tr></thead>", page)
    assert len(heads) == 3
    for head in heads:
        names = re.findall(r"<th>(.*?)</th>", head)
        assert names[2:6] == ["n", "median (ms)", "quartiles (ms)", "CPU (ms)"]
    assert "least of" not in page


def chapter(*times: Times) -> Chapter:
    errors = Errors(0.1, 0.1, 0.1, 0.1)
    points = tuple(Point(f"depth {k}", k, time, 100, 100, errors, 1.0, math.nan) for k, time in enumerate(times))
    reference = Reference(np.zeros((2, 2, 3)), "nothing", errors)
    return Chapter("a", "A", [], sources=[Source("s", "S", "", reference, (Curve("m", points, None, None),))],
                   plots={"s": []})  # fmt: skip


def test_a_busy_machine_is_warned_of_at_the_row_and_at_the_top() -> None:
    quiet, busy = Times(5, 1.0, 0.9, 1.1, 0.99), Times(5, 2.0, 1.5, 2.5, 0.5)
    conditions = Conditions("raytree report", Moment(load=None), Moment())
    page = as_html("A", [chapter(quiet, busy, quiet)], conditions).decode()
    assert page.index('<p class="warning">') < page.index("<h2")
    assert "in 1 of 3 settings" in page
    rows = re.findall(r"<tr( class=\"busy\")?><td>m</td><td>(depth \d)</td>", page)
    assert [label for mark, label in rows if mark] == ["depth 1"]
    assert "<td>75 %</td>" in page
    document = json.loads(as_json([chapter(quiet, busy, quiet)], conditions))
    assert [p["busy"] for p in document["scenes"][0]["sources"][0]["curves"][0]["points"]] == [False, True, False]
    assert len(document["warnings"]) == 1
    assert document["began"]["load"] is None

    page = as_html("A", [chapter(quiet, quiet)], conditions).decode()
    assert 'class="warning"' not in page
    assert 'class="busy"' not in page
    assert json.loads(as_json([chapter(quiet)], conditions))["warnings"] == []


def test_the_same_again_but_for_the_times(folder: Path, tmp_path: Path, one_plot: None) -> None:
    assert main.main(["report", "plates", *ARGUMENTS, "-o", str(tmp_path)]) == 0

    def timeless(path: Path) -> str:
        document = json.loads(path.read_text("utf-8"))
        for name in ("began", "ended", "duration", "warnings"):
            del document[name]
        times = r'"(seconds|lower_quartile|upper_quartile|cpu_seconds|busy)": [^,}]+'
        return re.sub(times, "", json.dumps(document))

    assert timeless(tmp_path / "report.json") == timeless(folder / "report.json")
    assert '"runs": ' in timeless(folder / "report.json")
    assert (tmp_path / "pixels-rmse-rays.svg").read_bytes() == (folder / "pixels-rmse-rays.svg").read_bytes()
    assert (tmp_path / "pixels-rmse-rays.pdf").read_bytes() == (folder / "pixels-rmse-rays.pdf").read_bytes()


def test_faults_are_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main.main(["report", "no-such-lesson", "-o", str(tmp_path / "file")]) == 2
    scene, output = capsys.readouterr().err.splitlines()
    assert "no-such-lesson" in scene
    assert output == f"{tmp_path}/file: must be a folder, got a file"
    assert main.main(["report", "plates", "-o", str(tmp_path / "none" / "there")]) == 2
    assert "folder not found" in capsys.readouterr().err


@pytest.mark.slow
def test_all_lessons_on_one_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, one_plot: None) -> None:
    """One lesson and three stiff trees: one chapter for the lesson, one for the trees; file names say whose data they
    hold.
    """
    monkeypatch.setattr(lesson, "names", lambda: ["plates"])
    monkeypatch.setattr("viewer.report.chapter.PROBLEMS", PROBLEMS[2:])
    assert main.main(["report", "--all", *ARGUMENTS, "-o", str(tmp_path / "all")]) == 0
    page = (tmp_path / "all" / "report.html").read_text("utf-8")
    assert re.findall(r'<h1 id="([^"]+)"', page) == ["plates", "stiff"]
    links = re.findall(r'(?:src|href)="([^"]+)"', page)
    names = re.findall(r'\bid="([^"]+)"', page)
    assert all(link.startswith("#") for link in links)
    assert len(names) == len(set(names))
    assert {link[1:] for link in links} <= set(names)
    assert "closed form: 10." in page
    document = json.loads((tmp_path / "all" / "report.json").read_text("utf-8"))
    assert [scene["name"] for scene in document["scenes"]] == ["plates", "stiff"]
    assert {row["scene"] for row in csv.DictReader((tmp_path / "all" / "report.csv").open(encoding="utf-8"))} == {
        "plates", "stiff",
    }  # fmt: skip
    assert (tmp_path / "all" / "plates-pixels-rmse-rays.pdf").exists()
    assert (tmp_path / "all" / "stiff-shell-largest-rays.svg").exists()


@pytest.mark.parametrize("given", [[], ["plates", "--all"]])
def test_a_scene_or_all_of_them(given: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main.main(["report", *given, "-o", str(tmp_path / "new")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("raytree report: a SCENE, or --all for every lesson and the stiff trees")


@pytest.mark.parametrize("kind", ["nff", "ply"])
def test_other_people_s_files(kind: str, tmp_path: Path, one_plot: None) -> None:
    """A scene in Haines' format, and a bare mesh."""
    path = tmp_path / f"'given' & so.{kind}"
    if kind == "nff":
        path.write_text(
            "v\nfrom 0 1 6\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 64 64\nb 0.1 0.2 0.3\nl 4 6 5\n"
            "f 1 0.9 0.7 0.5 0.5 30 0 1\ns 0 0 0 1\ns 1 1 0 0.5\n"
        )
    else:
        path.write_text(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
        )
    assert main.main(["report", str(path), *ARGUMENTS, "-o", str(tmp_path / "report")]) == 0
    document = json.loads((tmp_path / "report" / "report.json").read_text("utf-8"))
    (scene,) = document["scenes"]
    assert scene["name"] == "'given' & so"
    page = (tmp_path / "report" / "report.html").read_text("utf-8")
    assert set(re.findall(r'<section id="([^"]*)"', page)) == {f"-given----so-{s['name']}" for s in scene["sources"]}
    assert all(re.fullmatch(r"#[\w-]+", link) for link in re.findall(r"url\(([^)]*)\)", page))
    assert [source["name"] for source in scene["sources"]][-1] == ("together" if kind == "nff" else "pixels")
    assert all(point["tests"] > 0 for s in scene["sources"] for curve in s["curves"] for point in curve["points"])

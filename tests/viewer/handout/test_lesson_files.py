"""`raytree export LESSON --lesson`: its files and their names, and what it refuses."""

from pathlib import Path

import pytest

from tests.viewer.handout.sample import write_lesson
from viewer.cli.main import main
from viewer.figures.marks import Handle
from viewer.handout.document import Handout
from viewer.handout.files import DOCUMENTS
from viewer.handout.live import positions
from viewer.lessons import lesson


def test_a_folder_has_a_document_of_each_kind_and_figures_that_sort_as_the_lesson_goes(
    tmp_path: Path, handout: Handout, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = write_lesson(tmp_path / "glass")
    assert main(["export", str(folder), "--lesson", "-o", f"{tmp_path / 'out'}/", "--format", "pdf,svg"]) == 0
    names = [Path(line).name for line in capsys.readouterr().out.splitlines()]
    stages = len(handout.pages[0].stages)
    digits = len(str(stages))  # one more press shows the hidden part
    rays = [f"glass_1.{k:0{digits}}_{kind}.svg" for k in range(stages) for kind in ("scene", "tree")]
    levels = [f"glass_2.{k}_tree.svg" for k in range(3)]
    swept = ["glass_3.0_hit.svg", "glass_3.0_snell.svg", "glass_3.1_hit.svg", "glass_3.2_lifeguard.svg"]
    rest = [*swept, "glass_4.0_ray.svg", "glass_4.0_difference.svg"]
    assert names == ["glass.pdf", *rays, *levels, *rest]
    assert sorted(names[1:]) == sorted(path.name for path in (tmp_path / "out").glob("*.svg"))
    keys = [name.rsplit("_", 1)[0] for name in names[1:]]
    assert keys == sorted(keys)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--pixel", "3,4"], "--lesson has the figures of the steps: --pixel cannot be given"),
        (
            ["--depth", "2", "--figure", "hit"],
            "--lesson has the figures of the steps: --figure --depth cannot be given",
        ),
        (["--format", "csv"], "--format must be of svg, pdf, png, tikz, pptx, html with --lesson, got csv"),
        (["-o", "a.svg"], "a.svg: a lesson has many figures: name a folder, or a file of html, pptx, pdf"),
    ],
)
def test_what_has_no_meaning_for_a_lesson_is_one_line(
    words: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    output = [] if "-o" in words else ["-o", "out/"]
    assert main(["export", "glass-ball", "--lesson", *output, *words]) == 2
    assert capsys.readouterr().err.strip().endswith(said)
    assert list(tmp_path.iterdir()) == []


def test_a_scene_is_no_lesson(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = lesson.read("drop").scene
    assert main(["export", str(scene), "--lesson", "-o", str(tmp_path / "a.html")]) == 2
    assert capsys.readouterr().err.strip().endswith("--lesson is for a lesson; this is a scene")


def test_positions_of_a_handle_are_round_and_have_the_one_that_it_begins_with() -> None:
    def values(value: float, low: float, high: float) -> list[float]:
        return positions(Handle("x", value, (low, high), ((0.0, 0.0), (1.0, 0.0)), (0.0, 0.0, 0.0, 1.0)))

    assert values(29.5, 0.0, 90.0) == sorted([*map(float, range(91)), 29.5])
    shore = values(2.0, -1.0, 8.0)
    assert len(shore) == 91 and shore[0] == -1.0 and shore[-1] == 8.0 and 4.0 in shore
    angle = Handle("x", 30.0, (0.0, 90.0), ((0.0, 0.0), (1.0, 0.0)), (0.0, 0.0, 0.0, 1.0))
    assert positions(angle, 75) == list(map(float, range(0, 91, 2)))  # of four pieces in a lesson


@pytest.mark.slow
@pytest.mark.parametrize("name", lesson.names())
def test_the_page_of_a_lesson_has_at_most_two_megabytes(name: str, tmp_path: Path) -> None:
    for kind in DOCUMENTS:
        assert main(["export", name, "--lesson", "-o", str(tmp_path / f"a.{kind}")]) == 0
    assert (tmp_path / "a.html").stat().st_size <= 2_000_000

"""Figures: medians, ratios of neighbouring runs, the table, and changes since an earlier report."""

import json
from pathlib import Path

import pytest

from benchmarks.__main__ import main, measure
from benchmarks.results.against_before import changes
from benchmarks.results.figure import Figure, Spread, compared, in_turn
from benchmarks.results.report import as_json, as_markdown, read_json, short
from benchmarks.results.task import Task

ABOUT = {"processor": "a loom", "cores": 2}


def figure(low: float, median: float, high: float, what: str = "weaving", at_least: bool = True) -> Figure:
    return Figure("loom", what, "m/s", Spread(median, low, high, 7), wanted=2.0, at_least=at_least)


def test_runs_are_taken_in_turn_and_the_first_is_left_out() -> None:
    asked: list[str] = []

    def measure_as(name: str) -> float:
        asked.append(name)
        return float(len(asked))

    assert in_turn(2, lambda: measure_as("ours"), lambda: measure_as("theirs")) == [[3.0, 5.0], [4.0, 6.0]]
    assert asked == ["ours", "theirs"] * 3


def test_ratio_is_that_of_neighbouring_runs() -> None:
    found = compared("p", "w", "s", [1.0, 2.0, 4.0], "x", [2.0, 4.0, 4.0], faster=True, wanted=2.0)
    assert found.ratio == Spread(2.0, 1.0, 2.0, 3)
    assert found.met
    slower = compared("p", "w", "s", [1.0, 2.0, 4.0], "x", [2.0, 4.0, 4.0], wanted=0.4, at_least=False)
    assert slower.ratio == Spread(0.5, 0.5, 1.0, 3)
    assert slower.met is False


def test_json_reads_back(tmp_path: Path) -> None:
    figures = [figure(1, 2, 3), compared("p", "w", "s", [1.0], "x", [2.0])]
    path = tmp_path / "bench.json"
    path.write_text(as_json(figures, {"loom, thread": "it broke"}, ABOUT, 3))
    assert read_json(path) == figures
    assert json.loads(path.read_text())["failures"] == {"loom, thread": "it broke"}


def test_table_has_a_row_a_figure_and_says_what_was_missed() -> None:
    text = as_markdown([figure(1, 1.5, 3), figure(1, 2, 3, "warping")], {"loom, dye": "none left"}, ABOUT)
    rows = [line for line in text.splitlines() if line.startswith("| loom")]
    assert "**no**" in rows[0] and "yes" in rows[1]
    assert ">= 2" in rows[0] and "1.5 m/s" in rows[0] and "1 .. 3" in rows[0]
    assert [cell.strip() for cell in rows[0].split("|")][7] == "7"  # of runs
    assert "**loom, dye could not be run**: none left" in text


def test_a_change_is_one_that_lies_outside_both_spreads() -> None:
    before = [
        figure(9, 10, 11),
        figure(9, 10, 11, "warping"),
        figure(9, 10, 11, "waiting", False),
        figure(1, 2, 3, "old"),
    ]
    now = [figure(7, 8, 8.5), figure(7, 8, 12, "warping"), figure(7, 8, 8.5, "waiting", False), figure(1, 2, 3, "new")]
    assert list(changes(before, now)) == [
        "worse   loom: weaving: 8 m/s, was 10 m/s (9 .. 11)",
        "better  loom: waiting: 8 m/s, was 10 m/s (9 .. 11)",
        "1 of 3 figures are as they were",
    ]


def test_a_part_that_fails_does_not_stop_the_others() -> None:
    def fails() -> list[Figure]:
        raise RuntimeError("no yarn")

    figures, failures = measure([("loom", Task("a", 1, fails)), ("loom", Task("b", 1, lambda: [figure(1, 2, 3)]))])
    assert figures == [figure(1, 2, 3)]
    assert failures == {"loom, a": "RuntimeError: no yarn"}


@pytest.mark.parametrize(
    "arguments", [["knitting"], ["--runs", "0"], ["--scenes", "nowhere"], ["--against", "nothing.json"]]
)
def test_unusable_arguments_are_refused_before_anything_runs(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert list(tmp_path.iterdir()) == []


def test_numbers_have_three_digits() -> None:
    assert [short(x) for x in (0.01234, 1.0, 12.34, 1234.5, 327680.0)] == ["0.0123", "1", "12.3", "1234", "327680"]

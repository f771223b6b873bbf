"""`raytree check`: the table, a case explained, JSON, exit status."""

import json
import math
import re
from dataclasses import replace

import pytest

from tracer.measure.check import check
from tracer.measure.check.case import Reading
from viewer.cli.main import main

pytestmark = pytest.mark.early


def test_table_has_every_case_and_a_verdict(capsysbinary: pytest.CaptureFixture) -> None:
    assert main(["check"]) == 0
    said = capsysbinary.readouterr().out.decode()
    for case in check.CASES:
        assert f"\n{case.id:4}{case.title}\n" in said
    assert said.rstrip().splitlines()[-1].startswith(f"{len(check.CASES)} cases in ")
    assert "FAILED" not in said
    assert max(map(len, said.splitlines())) <= 140


def test_json_says_what_the_table_says(capsysbinary: pytest.CaptureFixture) -> None:
    assert main(["check", "--json"]) == 0
    document = json.loads(capsysbinary.readouterr().out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    assert [case["id"] for case in document["cases"]] == [case.id for case in check.CASES]
    for case in document["cases"]:
        assert case["ok"] is True
        assert {"id", "ok", "exact", "got", "error", "tolerance"} <= set(case)
        assert case["error"] <= case["tolerance"]
        worst = max(case["readings"], key=lambda one: one["error"] / (one["tolerance"] or 1.0))
        assert worst["error"] / (worst["tolerance"] or 1.0) == case["error"] / (case["tolerance"] or 1.0)
        for reading in case["readings"]:
            ours, theirs, word = reading["error"], reading["textbook_error"], reading["textbook_is"]
            if theirs is None:  # no answer, or an infinite error
                assert word in (None, "worse")
            else:
                assert word == ("worse" if theirs > ours else "as good" if theirs == ours else "better")
    (family,) = (case for case in document["cases"] if case["id"] == "A12")
    first = family["readings"][0]
    assert first["draws"] == 500
    assert list(first["quantiles"].values()) == sorted(first["quantiles"].values())
    assert first["quantiles"]["worst"] == first["error"] == family["error"]
    assert first["textbook_quantiles"]["median"] > 1000.0


def test_families_show_their_distribution(capsysbinary: pytest.CaptureFixture) -> None:
    assert main(["check", "A12", "D13", "--explain"]) == 0
    said = capsysbinary.readouterr().out.decode()
    for heading in ("median", "90 %", "99 %", "worst"):
        assert said.count(f"  {heading}") == 2
    assert "spheres: t, worst of 500" in said
    assert "spheres: t, one of 500" in said
    assert re.search(r"smaller than ours in \d+ of 500, equal in \d+", said)


def test_both_errors_have_one_unit_and_a_better_textbook_is_marked(
    monkeypatch: pytest.MonkeyPatch, capsysbinary: pytest.CaptureFixture
) -> None:
    up = 2.0**-52  # two units
    readings = [
        Reading("ours is worst", 1, 1.0 + 2 * up, textbook=1.0 + up),
        Reading("theirs is worst", 1, 1.0 + up, textbook=1.0 + 500 * up),
        Reading("both the same", 1, 1.0 + up, textbook=1.0 + up),
        Reading("no formula", 1, 1.0),
    ]
    monkeypatch.setattr("viewer.cli.check.CASES", [replace(check.CASES[0], read=lambda: readings)])
    assert main(["check"]) == 0
    said = " ".join(capsysbinary.readouterr().out.decode().split())
    assert "ours is worst 1 1 2 1 4 of 4 ok better" in said
    assert "theirs is worst 1 1 1000 1 2 of 4 ok" in said
    assert "both the same" not in said
    assert "3 settings. Its error is larger than ours at 1, equal at 1, and smaller at 1." in said
    assert "It is smaller at settings of A1." in said
    assert main(["check", "--explain"]) == 0
    said = " ".join(capsysbinary.readouterr().out.decode().split())
    assert "both the same 1 1 2 1 2 of 4 ok as good" in said
    assert "no formula 1 – – 1 0 of 4 ok" in said


def test_a_case_and_a_group_can_be_asked_for(capsysbinary: pytest.CaptureFixture) -> None:
    assert main(["check", "a3", "F", "--explain"]) == 0
    said = capsysbinary.readouterr().out.decode()
    for case in check.CASES:
        assert (f"{case.id}  {case.title}" in said) == (case.id == "A3" or case.id[0] == "F")
    (a3,) = (case for case in check.CASES if case.id == "A3")
    assert " ".join(a3.wrong.split(".")[0].split()) in " ".join(said.split())
    assert "R = 1e+12" in said


def test_unknown_case_is_one_line(capsys: pytest.CaptureFixture) -> None:
    assert main(["check", "A33"]) == 2
    said = capsys.readouterr().err
    assert said.startswith('raytree check: no case "A33": did you mean A3')
    assert len(said.splitlines()) == 1


def test_a_case_that_falls_short_is_seen_and_told_by_the_exit_status(
    monkeypatch: pytest.MonkeyPatch, capsysbinary: pytest.CaptureFixture
) -> None:
    short = replace(check.CASES[0], read=lambda: [Reading("too far", 1, 1.0 + 1e-9, allowed=4.0, textbook=1.0)])
    monkeypatch.setattr("viewer.cli.check.CASES", [short, check.CASES[1]])
    assert main(["check"]) == 1
    said = capsysbinary.readouterr().out.decode()
    assert said.count("FAILED") == 1
    assert said.rstrip().endswith("A1 failed")
    assert main(["check", "--json"]) == 1
    assert [case["ok"] for case in json.loads(capsysbinary.readouterr().out)["cases"]] == [False, True]


def test_numbers_and_words_are_judged_as_what_they_are() -> None:
    assert Reading("", 1, 1.0 + 2.0**-52).error == 2.0
    assert Reading("", "hit", "hit", 0.0, 0.0).ok
    assert not Reading("", "hit", "miss", 0.0, 0.0).ok
    assert not Reading("", 3, 4, 0.0, 0.0).ok
    assert Reading("", 1, math.nan).error == math.inf
    assert not Reading("", 1, math.inf).ok

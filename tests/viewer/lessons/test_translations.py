"""A translation has the texts; data, steps and live pieces are those of lesson.md."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.viewer.driver import viewer
from viewer.cli.main import main
from viewer.lessons.check import check
from viewer.lessons.language import choose, wanted
from viewer.lessons.lesson import read_file
from viewer.lessons.moments import Moment
from viewer.lessons.skeleton import write_skeleton
from viewer.window.lesson_room import room_faults

GERMAN = """\
+++
title = "Eine Spiegelkugel"
question = "Warum zeigt die Kugel den Boden?"
+++
## Was zeigt dieses Pixel?

Das Pixel liegt auf der Kugel. **Wessen Farbe** siehst du dort?

???

Die des Bodens: dorthin geht der [reflektierte Strahl](#R).

## Der Winkel

Der Strahl trifft die Kugel unter {theta1}.

```notes
Andere Pixel anklicken.
```
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"):
        monkeypatch.delenv(name, raising=False)
    write_skeleton(tmp_path / "ball")
    (tmp_path / "ball" / "lesson.de.md").write_text(GERMAN, "utf-8")
    return tmp_path / "ball"


def test_the_environment_chooses_the_language(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def title() -> str:
        return read_file(folder / "lesson.md").title

    assert wanted() == [] and title() == "A mirror ball"
    monkeypatch.setenv("LANG", "de_AT.UTF-8@euro")
    assert wanted() == ["de_AT", "de"] and title() == "Eine Spiegelkugel"
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    assert wanted() == [] and title() == "A mirror ball"
    monkeypatch.setenv("LANGUAGE", "fr:de:en")
    assert title() == "Eine Spiegelkugel"
    monkeypatch.setenv("LANGUAGE", "en_GB:de")
    assert title() == "A mirror ball"
    choose("de")
    assert wanted() == ["de", "en_GB", "en"] and title() == "Eine Spiegelkugel"


def test_only_the_texts_are_others(folder: Path) -> None:
    original, german = read_file(folder / "lesson.md", ()), read_file(folder / "lesson.md", ["de"])
    assert german.question == "Warum zeigt die Kugel den Boden?" and german.objectives == original.objectives
    assert [step.title for step in german.steps] == ["Was zeigt dieses Pixel?", "Der Winkel"]
    assert [step.state for step in german.steps] == [step.state for step in original.steps]
    assert german.steps[1].notes == "Andere Pixel anklicken." and original.steps[0].notes == german.steps[0].notes
    for one, other in zip(german.steps, original.steps, strict=True):
        texts = {"title": other.title, "line": other.line, "parts": other.parts, "notes": other.notes}
        assert one.parts != other.parts and replace(one, **texts) == other
    assert german.files == [folder / "lesson.md", folder / "lesson.de.md"]
    assert check(folder / "lesson.md") == [] and room_faults(folder / "lesson.md") == []


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("## Der Winkel", "", "line 5: a translation must have the 2 steps of lesson.md, got 1"),
        ("???", "", "line 5: the step must have 2 parts between ???, as in lesson.md, got 1"),
        ("Das Pixel", "```live\nhit\n```\nDas Pixel", "line 7: the blocks live and source must be those of"),
        ("title", "minutes = 3\ntitle", 'line 2: unknown key "minutes": a translation has title, question, objectives'),
        ("pixel?", "pixel?\n```step\ndepth = 1\n```", "line 5: a translation has no block step"),
        ("{theta1}", "{theta9}", 'line 15: {theta9}: unknown value "theta9"'),
        ("(#R)", "(#T)", "line 11: link #T: this pixel has no such ray"),
        ("Das Pixel", "Wort " * 41, "words appear at once; at most 40 are allowed"),
    ],
)  # fmt: skip
def test_a_fault_of_a_translation_has_its_file_and_line(folder: Path, old: str, new: str, said: str) -> None:
    text = GERMAN.replace("Pixel?", "pixel?").replace(old, new, 1)
    assert text != GERMAN
    (folder / "lesson.de.md").write_text(text, "utf-8")
    faults = check(folder / "lesson.md")
    assert faults and faults[0].startswith(f"{folder / 'lesson.de.md'}: line ") and said in faults[0], faults


def test_the_option_shows_it(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("LANGUAGE", "")
    assert main(["view", str(folder), "--language", "fr", "--screenshot", str(folder / "a.png")]) == 2
    assert capsys.readouterr().err == f"{folder / 'lesson.md'}: --language must be one of en, de, got fr\n"
    monkeypatch.setenv("LANGUAGE", "")
    assert main(["view", str(folder), "--language", "de", "--screenshot", str(folder / "a.png"), "--at", "1"]) == 0
    with pytest.raises(SystemExit):
        main(["view", str(folder), "--language", "german"])
    assert "the code of a language, like de or pt_BR" in capsys.readouterr().err


def test_a_saved_translation_is_shown_at_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "de")
    with viewer() as driver:
        session = driver.session
        session.player.show(read_file(folder / "lesson.md"), Moment())
        driver.app.settle()
        text = GERMAN.replace("Spiegelkugel", "Kugel")
        (folder / "lesson.de.md").write_text(text, "utf-8")
        while not (session.lesson and session.lesson.title == "Eine Kugel"):
            session.loader.watch.last = 0.0  # the next look is not to be waited for
            driver.frames(1)
        assert session.lesson_step and session.lesson_step.title == "Was zeigt dieses Pixel?"

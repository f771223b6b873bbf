"""A translation has the texts; data, steps and live pieces are those of lesson.md."""

import os
import subprocess
from dataclasses import replace
from pathlib import Path

import html5lib
import pytest

from tests.viewer.driver import viewer
from viewer.cli.main import main
from viewer.lessons import lesson
from viewer.lessons.check import check
from viewer.lessons.language import wanted
from viewer.lessons.lesson import read_file
from viewer.lessons.moments import Moment
from viewer.lessons.skeleton import write_skeleton
from viewer.session.actions import open_lesson
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
    assert wanted("de") == ["de", "en_GB", "en"]
    assert read_file(folder / "lesson.md", wanted("de")).title == "Eine Spiegelkugel" and title() == "A mirror ball"


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
    """And the environment stays as it is."""
    before, pictures = dict(os.environ), []
    for language in ("en", "de_AT"):
        out = folder / f"{language}.png"
        assert main(["view", str(folder), "--language", language, "--screenshot", str(out), "--at", "1"]) == 0
        pictures.append(out.read_bytes())
    assert pictures[0] != pictures[1] and dict(os.environ) == before
    file = str(folder / "lesson.md")
    for words in (["view", file, "--screenshot", str(folder / "a.png")], ["lessons", "--check", file],
                  ["export", file, "--lesson", "-o", str(folder / "a.html")]):  # fmt: skip
        capsys.readouterr()
        assert main([*words, "--language", "fr"]) == 2
        assert capsys.readouterr().err == f"{file}: --language must be one of en, de, got fr\n"
    with pytest.raises(SystemExit):
        main(["view", file, "--language", "german"])
    assert "the code of a language, like de or pt_BR" in capsys.readouterr().err
    assert main(["export", file, "--language", "de", "-o", str(folder / "a.svg")]) == 2
    assert capsys.readouterr().err == (
        "raytree export: --language is for --lesson: a figure has no text of its lesson\n"
    )


def test_lessons_that_are_opened_later_are_in_that_language(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lesson, "folder", lambda: folder.parent)
    (folder.parent / "ORDER").write_text("ball", "utf-8")
    with viewer(languages=["de"]) as driver:
        session = driver.session
        session.lesson_list.read()
        assert [entry.title for entry in session.lesson_list.entries] == ["Eine Spiegelkugel"]
        open_lesson(session, "ball")
        driver.app.settle()
        assert session.lesson and session.lesson.title == "Eine Spiegelkugel"
        session.loader.reload()
        driver.app.settle()
        assert session.lesson.language == "de"


def test_a_check_of_one_language_leaves_out_the_others(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "lesson.fr.md").write_text(GERMAN.replace("???", ""), "utf-8")
    assert main(["lessons", "--check", str(folder), "--language", "de"]) == 0
    assert main(["lessons", "--check", str(folder), "--language", "fr"]) == 1
    assert "lesson.fr.md: line 5: the step must have 2 parts" in capsys.readouterr().out
    assert main(["lessons", "--new", str(folder / "more"), "--language", "de"]) == 2
    monkeypatch.setattr(lesson, "folder", lambda: folder.parent)
    (folder.parent / "ORDER").write_text("ball", "utf-8")
    capsys.readouterr()
    assert main(["lessons", "--language", "de"]) == 0
    assert capsys.readouterr().out.split(maxsplit=1)[1] == "Eine Spiegelkugel\n"


def test_what_is_taken_home_names_its_language(folder: Path) -> None:
    """The program's own words in a page are marked as English."""
    words = ["export", str(folder), "--lesson", "--language", "de"]
    for kind in ("html", "pdf", "pptx"):
        assert main([*words, "-o", str(folder / f"a.{kind}")]) == 0
    tree = html5lib.HTMLParser(namespaceHTMLElements=False).parse((folder / "a.html").read_text("utf-8"))
    assert tree.get("lang") == "de"
    ours = {id(inner) for element in tree.iter() if element.get("lang") == "en" for inner in element.iter()}
    texts = {"".join(e.itertext()).strip(): id(e) in ours for e in tree.iter() if e.tag in ("summary", "p", "h2", "h1")}
    assert texts["Show the answer"] and texts["Rays"] and not texts["Eine Spiegelkugel"] and not texts["2/2Der Winkel"]
    assert "--language de" in (folder / "a.html").read_text("utf-8")
    assert subprocess.run(["pdfinfo", "-struct-text", folder / "a.pdf"], capture_output=True, text=True).stdout.count(
        "Winkel"
    )
    assert b"/Lang (de)" in (folder / "a.pdf").read_bytes()
    from pptx import Presentation

    deck = Presentation(str(folder / "a.pptx"))
    runs = [run for slide in deck.slides for run in slide._element.xpath(".//a:r/a:rPr")]
    assert runs and {run.get("lang") for run in runs if run.getparent().xpath("ancestor::p:sp")} >= {"de"}


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

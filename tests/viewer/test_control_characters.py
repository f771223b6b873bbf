"""Names, titles and paths with control characters: no text that leaves the program has them."""

import csv
import io
import json
import subprocess
import unicodedata
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest

import tracer
from tests.scenes import named_scene
from tests.viewer.cli.test_cli import raytree
from tests.viewer.driver import Driver
from tracer.measure.conditions import Moment
from tracer.printable import json_text, printable
from viewer.base.cells import csv_text
from viewer.figures.catalogue import FORMATS
from viewer.report.chapter import Chapter
from viewer.report.conditions import Conditions
from viewer.report.page import as_html
from viewer.session.view_state import Notice, Request
from viewer.window.menu import save_image

EVIL = "a\x1b[2J\x07\x08\x7f\x9b31m\u202e\u2066\u200e\r\n\u2028\u2029\x85z"
SHOWN = r"a\x1b[2J\x07\x08\x7f\x9b31m\u202e\u2066\u200e\r\n\u2028\u2029\x85z"
FILE = "f\x1b[2J\n\u202e\udcff.toml"  # the last is a byte that is not UTF-8


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / FILE).write_text(named_scene(EVIL), "utf-8")
    return tmp_path


def forbidden(text: str) -> set[str]:
    """The characters of a text that a terminal or a reader's eye could be misled by. Line ends are ours."""
    kinds = ("Cc", "Cf", "Cs", "Zl", "Zp")
    return {c for c in text if unicodedata.category(c) in kinds} - {"\n", "\u200c", "\u200d"}


@pytest.mark.parametrize("form", ["text", "json", "csv", "dot"])
def test_trace(form: str, folder: Path) -> None:
    found = raytree("trace", FILE, "--pixel", "20,15", "--format", form, cwd=folder)
    assert found.returncode == 0
    assert forbidden(found.stdout) == set()
    rows = found.stdout.splitlines()
    match form:
        case "json":
            nodes = json.loads(found.stdout)["nodes"]
            assert {node["object"] for node in nodes} == {EVIL, None}
            assert {node["light"] for node in nodes} == {EVIL, None}
        case "csv":
            assert {row["object"] for row in csv.DictReader(rows)} == {SHOWN, ""}
        case "text":
            assert rows[0].startswith(f"{SHOWN}: pixel 20,15 of 40x30")
            assert f'because of the material "{SHOWN}"' in rows[1]
            assert rows[4].removeprefix("E camera").strip().startswith(SHOWN)


@pytest.mark.parametrize(
    "arguments",
    [
        ["plan", FILE],
        ["plan", FILE, "--json"],
        ["render", FILE, "-o", "i.npy", "--until-error", "0.1"],
        ["render", FILE, FILE, "-o", "i/"],
        ["render", FILE, "-o", "i.png", "--missing", "0.1"],
        ["trace", FILE, "--pixel", "99,99"],
        ["trace", FILE + EVIL, "--pixel", "1,1"],
        ["view", EVIL],
        [EVIL],
        ["export", FILE, "--pixel", "20,15", "--figure", "hit", "--node", EVIL, "-o", "x/"],
        ["export", FILE, "--pixel", "20,15", "-o", f"{EVIL}/"],
    ],
    ids=lambda arguments: " ".join(map(ascii, arguments))[:60],
)
def test_what_commands_say(arguments: list[str], folder: Path) -> None:
    found = raytree(*arguments, cwd=folder)
    assert found.returncode in (0, 2)
    assert "Traceback" not in found.stderr
    assert found.stdout + found.stderr
    assert forbidden(found.stdout + found.stderr) == set()
    assert len(found.stderr.splitlines()) <= 2


def test_faults_are_a_line_each(folder: Path) -> None:
    text = (folder / FILE).read_text("utf-8").replace("radius = 1", "radius = -1\n" + json.dumps(EVIL) + " = 2")
    (folder / FILE).write_text(text.replace("diffuse = 0.5", "diffuse = -5"), "utf-8")
    found = raytree("trace", FILE, "--pixel", "1,1", cwd=folder)
    assert found.returncode == 2
    lines = found.stderr.splitlines()
    assert len(lines) == 3
    assert all(line.startswith(r"f\x1b[2J\n\u202e\udcff.toml: ") for line in lines)
    assert forbidden(found.stderr) == set()


@pytest.mark.parametrize("figure", ["tree", "both", "hit"])
def test_figures(figure: str, folder: Path) -> None:
    names = [name for name, kind in FORMATS.items() if kind.figures]
    options = ["--pixel", "20,15", "--figure", figure, "--depth", "2", "--format", ",".join(names), "-o", "out/"]
    found = raytree("export", FILE, *options, cwd=folder)
    assert (found.returncode, forbidden(found.stdout + found.stderr)) == (0, set())
    for path in (folder / "out").iterdir():
        match path.suffix:
            case ".svg" | ".tex" | ".html":
                said = [path.read_text("utf-8")]
            case ".pptx":
                with zipfile.ZipFile(path) as archive:
                    said = [archive.read(n).decode("utf-8") for n in archive.namelist() if n.endswith("1.xml")]
            case ".pdf":
                run = subprocess.run(["pdftotext", path, "-"], capture_output=True, text=True, check=True)
                said = [run.stdout.replace("\f", "")]
            case _:
                said = [
                    path.read_bytes().decode("latin-1").split("IDAT")[0].encode("latin-1").decode("utf-8", "ignore")
                ]
                said = [said[0].partition("Title")[2].replace("\0", "")[:200].partition("\n")[0][:100]]
        assert path.suffix == ".png" or forbidden("".join(said)) <= {"\r"}, path
        assert any(r"\x1b[2J" in text or r"\textbackslash{}x1b[2J" in text for text in said), path


def test_the_report_page() -> None:
    chapters = [Chapter(EVIL, EVIL, []), Chapter("b", EVIL, [], [EVIL])]
    page = as_html(EVIL, chapters, Conditions(EVIL, Moment(), Moment())).decode("utf-8")
    assert forbidden(page) == set()
    assert page.count(SHOWN) >= 6


def test_the_window(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    driver = Driver()
    try:
        driver.open_file(Path(FILE))
        title = getattr(driver.app.surface, "title", "")
        assert title == f"{SHOWN} – raytree"
        save_image(driver.session)
        assert driver.session.notice.text.startswith("wrote ")
        assert forbidden(driver.session.notice.text) == set()
        driver.session.requests.append(Request.OPEN_DIALOG)  # in a folder with a file whose name no encoding has
        driver.frames(4)
    finally:
        driver.app.close()


def test_a_notice() -> None:
    notice = Notice()
    notice.say(EVIL)
    assert notice.text == SHOWN


def test_names_of_python_scenes() -> None:
    """Names from Python, without a file: lone surrogates are possible, too."""
    from tests.scenes import ball, world_of

    world = world_of(replace(ball((0, 0, 0), 1), name="a\ud800\u200db"))
    tree = tracer.trace(world, ray=((0, 0, 5), (0, 0, -1)))
    assert tree.object_name(0) == "a\\ud800\u200db"
    assert json.loads(tree.to_json().encode("utf-8"))["nodes"][0]["object"] == "a\ud800\u200db"
    assert "a\\ud800\u200db" in tree.to_text()


def test_json_has_its_own_escapes_and_is_read_back() -> None:
    text = json_text({EVIL: [EVIL, "\U000e0001", "\ud800", "plain é → 😀", 0.1]})
    assert forbidden(text) == set()
    assert "plain é → 😀" in text
    assert json.loads(text) == {EVIL: [EVIL, "\U000e0001", "\ud800", "plain é → 😀", 0.1]}


def test_cells_that_a_spreadsheet_would_run() -> None:
    formulas = ["=1+1", "+1", "-1", "@SUM(A1)", "-ball"]
    others = ["", "a=1", " =1", "'=1", "1-1"]
    numbers = [-0.5, -1, +1, 1e-300, float("-1e5")]
    rows = list(csv.reader(io.StringIO(csv_text([formulas, others, numbers, [None, "\t=1", "a\n=b"]]))))
    assert rows[0] == [f"'{text}" for text in formulas]
    assert rows[1] == others
    assert [float(cell) for cell in rows[2]] == numbers
    assert rows[3] == ["", "\\t=1", "a\\n=b"]


def test_printable_leaves_what_is_printed() -> None:
    for text in ("", "plain", "é ü ß → θ₁ 😀", "a\u200db", "\xa0", SHOWN):
        assert printable(text) == text
    assert printable(EVIL) == SHOWN

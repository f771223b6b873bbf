"""Views in figures: a round trip for each format, and figures that are damaged or were made to do harm."""

import base64
import io
import json
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from fpdf import FPDF
from hypothesis import HealthCheck, given, settings, strategies as st

import tracer
from viewer.base.files import Unusable
from viewer.cli.main import main
from viewer.lessons import lesson
from viewer.reopen import embedded
from viewer.reopen.embedded import Damaged, Embedded, pack, unpack
from viewer.reopen.places import ATTACHMENT, CARRYING, NAMESPACE, as_xml, read_figure
from viewer.reopen.scene_files import SceneFile, SceneFiles, scene_files
from viewer.reopen.view_state import ViewState
from viewer.session.restore.figure_scene import FigureScenes

STATE = ViewState(pixel=(248, 180), depth=2, select="TR", camera=(0.1, 0.2, 3.3), theme="light", filter=("shadow",))


def of_lesson(name: str) -> Embedded:
    scene = tracer.load(lesson.read(name).scene)
    files = scene_files(scene, lesson.read(name).path)
    assert files
    return Embedded("0.1.0", STATE, files)


def test_an_archive_is_read_back_and_is_the_same_each_time() -> None:
    own = of_lesson("glass-ball")
    data, notes = pack(own)
    assert not notes and unpack(data) == own and pack(own)[0] == data
    assert {file.name for file in own.files.files} == {"scene.toml", "stone.obj", "lesson.md"}
    assert len(data) < 6000


@pytest.fixture(scope="module")
def figures(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("figures")
    names = ",".join(suffix[1:] for suffix in CARRYING)
    assert main(["export", "glass-ball", "--format", names, "--node", "TR", "--figure", "hit", "-o", f"{folder}/"]) == 0
    return {path.suffix: path for path in folder.iterdir()}


@pytest.mark.parametrize("suffix", CARRYING)
def test_each_format_carries_the_same_view(figures: dict[str, Path], suffix: str) -> None:
    found = read_figure(figures[suffix])
    assert found.state == ViewState(pixel=(248, 180), depth=3, select="TR")
    assert found.is_lesson_of_program and found.files.folder == Path("glass-ball")
    assert found == read_figure(figures[".svg"])
    assert found.files.are_in(lesson.read("glass-ball").path.parent)


def test_a_figure_of_a_lesson_names_no_folder_of_this_computer(figures: dict[str, Path]) -> None:
    data, _ = pack(read_figure(figures[".svg"]))
    table = zipfile.ZipFile(io.BytesIO(data)).read("view.json").decode()
    assert str(Path.home()) not in table and str(lesson.folder().parent) not in table


@pytest.mark.parametrize("suffix", CARRYING)
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damage_is_one_line(figures: dict[str, Path], suffix: str, data: st.DataObject, tmp_path: Path) -> None:
    """Bytes are changed, cut out and put in, also where the view is: it is read as it was, or refused in one line."""
    content = bytearray(figures[suffix].read_bytes())
    starts = [0, len(content) // 2, len(content) - 300, max(content.find(b"raytree"), 0), max(content.find(b"PK"), 0)]
    for _ in range(data.draw(st.integers(1, 6))):
        at = min(data.draw(st.sampled_from(starts)) + data.draw(st.integers(0, 4000)), len(content) - 1)
        length = data.draw(st.sampled_from((0, 1, 1, 8, 300)))
        content[at : at + length] = data.draw(st.binary(max_size=8))
    path = tmp_path / f"a{suffix}"
    path.write_bytes(content)
    scenes = FigureScenes()
    try:
        scenes.find(path)
    except Unusable as unusable:
        assert len(unusable.faults) == 1 and unusable.faults[0].startswith(f"{path}: ")
        assert unusable.faults[0].isprintable()
    finally:
        scenes.close()


@pytest.mark.parametrize("encoding", ["U-TF-8", "rot13", "uu", "punycode", "utf-16"])
def test_an_encoding_that_is_not_that_of_the_file_is_one_line(
    figures: dict[str, Path], encoding: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.svg"
    path.write_bytes(figures[".svg"].read_bytes().replace(b'encoding="UTF-8"', f'encoding="{encoding}"'.encode(), 1))
    assert encoding.encode() in path.read_bytes()
    scenes = FigureScenes()
    try:
        scenes.find(path)
    except Unusable as unusable:
        assert len(unusable.faults) == 1 and unusable.faults[0].startswith(f"{path}: ")
    finally:
        scenes.close()


@settings(max_examples=300, deadline=None)
@given(data=st.data())
def test_a_damaged_table_is_refused(data: st.DataObject) -> None:
    """Values of any type in any place of the table."""
    table = json.loads(zipfile.ZipFile(io.BytesIO(pack(of_lesson("drop"))[0])).read("view.json"))
    anything = st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
        lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=9), inner, max_size=3),
        max_leaves=6,
    )
    where = data.draw(st.sampled_from([table, table["view"], *table["files"]]))
    where[data.draw(st.sampled_from(sorted(where)))] = data.draw(anything)
    try:
        unpack(archive_of(table))
    except Damaged as damaged:
        assert str(damaged).isprintable()


def archive_of(table: dict, contents: dict[str, bytes] | None = None) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("view.json", json.dumps(table))
        for name, content in (contents or {}).items():
            archive.writestr(name, content)
    return buffer.getvalue()


def figure_of(path: Path, data: bytes) -> Path:
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg"><metadata>{as_xml(data)}</metadata></svg>')
    return path


def refused(path: Path) -> str:
    with pytest.raises(Unusable) as caught:
        FigureScenes().find(path)
    (fault,) = caught.value.faults
    return fault.removeprefix(f"{path}: ")


@pytest.mark.parametrize(
    "name", ["../escaped.toml", "/tmp/escaped.toml", "a/../../b.toml", "a//b.toml", "./a.toml", ".", "", "a\0b"]
)
def test_no_file_leaves_the_temporary_folder(tmp_path: Path, name: str) -> None:
    files = SceneFiles(tmp_path / "gone", name, "", (SceneFile(name, "", None),))
    data, _ = pack(Embedded("1", STATE, files))
    assert "name that is not allowed" in refused(figure_of(tmp_path / "a.svg", data))
    assert [path.name for path in tmp_path.iterdir()] == ["a.svg"]


def test_bombs_are_refused_before_they_are_unpacked(tmp_path: Path) -> None:
    zeros = archive_of({"format": "raytree-view/1"}, {"0": bytes(embedded.MOST_UNPACKED)})
    assert len(zeros) < 200_000
    assert "must have at most 67108864 bytes unpacked" in refused(figure_of(tmp_path / "a.svg", zeros))
    many = archive_of({}, {str(k): b"" for k in range(embedded.MOST_FILES + 1)})
    assert "must have at most" in refused(figure_of(tmp_path / "a.svg", many))
    laughs = "".join(f'<!ENTITY a{k + 1} "{f"&a{k};" * 10}">' for k in range(12))
    (tmp_path / "a.svg").write_text(
        f'<!DOCTYPE s [<!ENTITY a0 "ha">{laughs}]><s xmlns:r="{NAMESPACE}"><r:view>&a12;</r:view></s>'
    )
    assert refused(tmp_path / "a.svg") == "it defines entities, which are not read"
    with zipfile.ZipFile(tmp_path / "a.pptx", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("customXml/item1.xml", bytes(70 * 2**20))
    assert "customXml/item1.xml must have at most" in refused(tmp_path / "a.pptx")
    deck = FPDF()
    deck.embed_file(bytes=bytes(8 * 2**20), basename=ATTACHMENT, compress=True)
    deck.output(str(tmp_path / "a.pdf"))
    assert "raytree-view.zip must have at most 4194304 bytes, got 8388608" in refused(tmp_path / "a.pdf")


@pytest.mark.parametrize("suffix", CARRYING)
def test_a_file_without_a_view_says_so(tmp_path: Path, suffix: str, figures: dict[str, Path]) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"")
    assert refused(path)
    if suffix == ".svg":
        path.write_text(re.sub(r"<metadata>.*</metadata>", "", figures[suffix].read_text(), flags=re.DOTALL))
    elif suffix == ".png":
        from PIL import Image

        Image.new("RGB", (3, 3)).save(path)
    elif suffix == ".pdf":
        FPDF().output(str(path))
    else:
        from pptx import Presentation

        Presentation().save(str(path))
    assert refused(path) == "it carries no view: raytree did not write it, or another program has removed the view"
    path.unlink()
    assert refused(path) == "file not found"
    path.mkdir()
    assert refused(path) == "must be a file, got a folder"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            lambda table: table.update(format="raytree-view/2"),
            "its view must have the format raytree-view/1, got raytree-view/2",
        ),
        (
            lambda table: table["files"][0].update(sha256="0" * 64),
            "its view is damaged: the checksum of scene.toml is another",
        ),
        (
            lambda table: table["view"].update(pixel="x"),
            'its view: pixel must be two whole numbers like 320,240, got "x"',
        ),
        (lambda table: table["view"].update(camera="nan,0,1"), "its view: camera must be azimuth"),
        (lambda table: table.update(scene="other.toml"), "its files must have different names"),
    ],
)
def test_a_wrong_table_is_said(tmp_path: Path, change: Callable[[dict], None], said: str) -> None:
    data, _ = pack(of_lesson("drop"))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        table = json.loads(archive.read("view.json"))
        contents = {name: archive.read(name) for name in archive.namelist() if name != "view.json"}
    change(table)
    assert said in refused(figure_of(tmp_path / "a.svg", archive_of(table, contents)))


def test_a_view_is_found_after_another_program_has_saved_the_figure(figures: dict[str, Path], tmp_path: Path) -> None:
    """Another prefix for the namespace, other white space; another number of the part in PPTX."""
    import xml.etree.ElementTree as ElementTree

    tree = ElementTree.parse(figures[".svg"])
    tree.write(tmp_path / "a.svg")
    assert b"xmlns:raytree" not in (tmp_path / "a.svg").read_bytes()
    assert read_figure(tmp_path / "a.svg") == read_figure(figures[".svg"])
    from pptx import Presentation

    deck = Presentation(str(figures[".pptx"]))
    deck.slides.add_slide(deck.slide_layouts[0])
    deck.save(str(tmp_path / "a.pptx"))
    assert read_figure(tmp_path / "a.pptx") == read_figure(figures[".svg"])


def test_a_figure_grows_by_little(figures: dict[str, Path]) -> None:
    """By the compressed files of its scene, and in text formats a third more."""
    data, _ = pack(read_figure(figures[".svg"]))
    in_svg = re.search(r"<raytree:view.*</raytree:view>", figures[".svg"].read_text(), re.DOTALL)
    assert in_svg and len(in_svg[0]) < 1.4 * len(data) + 200
    assert base64.b64decode("".join(in_svg[0].split(">")[1].split("<")[0].split())) == data
    assert len(data) < 6000

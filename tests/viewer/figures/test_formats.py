"""Files of figures, read back by independent programs."""

import io
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import tracer
from tests.conftest import LESSONS
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame, initial_orbit
from viewer.base.theme import DARK, LIGHT
from viewer.figures.catalogue import FIGURE_NAMES, FORMATS
from viewer.figures.font import FONT
from viewer.figures.marks import Figure, Text
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.lessons import lesson

SVG = "{http://www.w3.org/2000/svg}"


def trees(worlds: dict[str, tracer.World], name: str) -> list[RayTree]:
    return [tracer.trace(worlds[name], lesson.read(name).first.state.pixel, depth=d) for d in range(4)]


def words(figure: Figure) -> list[str]:
    return [mark.content for mark in figure.marks if isinstance(mark, Text)]


def written(name: str, figures: list[Figure], across: int = 960) -> bytes:
    return FORMATS[name].write(figures, across)


@pytest.fixture(
    scope="module", params=[(name, kind) for name in LESSONS for kind in FIGURE_NAMES], ids=lambda pair: "-".join(pair)
)
def figures(request: pytest.FixtureRequest, worlds: dict[str, tracer.World]) -> list[Figure]:
    """Each figure of each shipped scene, from depth 0 to 3."""
    name, kind = request.param
    found = lesson.read(name)
    orbit = initial_orbit(worlds[name], Frame.of(worlds[name]), found.first.state.view)
    subject = Subject(by_depth(trees(worlds, name)), worlds[name], orbit)
    return pages(kind, subject, FigureStyle(DARK, swatches=True, ground=True), "raytree export ...")


def test_svg_has_its_text_as_text(figures: list[Figure], tmp_path: Path) -> None:
    for figure in figures:
        root = ElementTree.fromstring(written("svg", [figure]))
        assert [node.text for node in root.iter(f"{SVG}text")] == words(figure)
        assert root.findtext(f"{SVG}title") == figure.title
        assert root.findtext(f"{SVG}metadata") == "raytree export ..."
        names = [group.get("id") for group in root.iter(f"{SVG}g") if group.get("id")]
        assert len(set(names)) == len(names)
        assert {mark.name for mark in figure.marks} == set(names)


def test_svg_and_png_are_the_same_picture(figures: list[Figure], tmp_path: Path) -> None:
    """librsvg's picture of the SVG and PDFium's of the PDF differ by antialiasing only: no mark is missing in one."""
    (tmp_path / "a.svg").write_bytes(written("svg", figures[-1:]))
    fonts = f"<fontconfig><dir>{FONT.parent}</dir><cachedir>{tmp_path}</cachedir></fontconfig>"
    (tmp_path / "fonts.conf").write_text(fonts)
    only_ours = {**os.environ, "FONTCONFIG_FILE": str(tmp_path / "fonts.conf")}
    command = ["rsvg-convert", "-w", "960", "-o", tmp_path / "a.png", tmp_path / "a.svg"]
    subprocess.run(command, check=True, env=only_ours)
    ours = np.asarray(Image.open(io.BytesIO(written("png", figures[-1:], 960))).convert("RGB"), float)
    theirs = np.asarray(Image.open(tmp_path / "a.png").convert("RGB"), float)
    assert ours.shape == theirs.shape
    coarse = [image[:528].reshape(22, 24, 40, 24, 3).mean(axis=(1, 3)) for image in (ours, theirs)]
    assert np.abs(coarse[0] - coarse[1]).max() < 24.0  # a missing box of text gives 60 and more


def test_pdf_has_a_page_a_depth_and_its_words_can_be_selected(figures: list[Figure], tmp_path: Path) -> None:
    path = tmp_path / "a.pdf"
    path.write_bytes(written("pdf", figures))
    said = subprocess.run(["pdftotext", "-raw", path, "-"], capture_output=True, text=True, check=True).stdout
    texts = said.split("\f")
    assert len(texts) == len(figures) + 1
    for figure, text in zip(figures, texts, strict=False):
        flat = re.sub(r"\s+", "", text)
        for word in words(figure):
            assert re.sub(r"\s+", "", word) in flat, word
    fonts = subprocess.run(["pdffonts", path], capture_output=True, text=True, check=True).stdout.splitlines()[2:]
    assert fonts
    assert all(re.search(r"\byes yes yes\b", line) for line in fonts)  # embedded, a subset, readable as Unicode


def test_pptx_counts_what_the_tree_counts(worlds: dict[str, tracer.World]) -> None:
    from pptx import Presentation

    for name in LESSONS:
        steps = trees(worlds, name)
        deck = Presentation(io.BytesIO(written("pptx", pages("tree", Subject(by_depth(steps)), FigureStyle()))))
        assert len(deck.slides) == len(steps)
        for slide, tree in zip(deck.slides, steps, strict=True):
            kinds = tree.nodes["kind"]
            shapes = {shape.name: shape for shape in slide.shapes}
            hits = {f"hit-{i}" for i in range(len(tree)) if kinds[i] != SHADOW}
            assert hits == {n for n in shapes if re.fullmatch(r"hit-\d+", n)}
            connectors = {n: s for n, s in shapes.items() if s._element.tag.endswith("cxnSp")}
            assert set(connectors) == {f"ray-{i}" for i in range(len(tree))}
            for i in range(1, len(tree)):
                ends = connectors[f"ray-{i}"]._element.xpath(".//a:stCxn | .//a:endCxn")
                glue = {end.tag.split("}")[1]: int(end.get("id")) for end in ends}
                assert glue["stCxn"] == shapes[f"hit-{tree.nodes['parent'][i]}"].shape_id
                assert kinds[i] == SHADOW or glue["endCxn"] == shapes[f"hit-{i}"].shape_id
            for i in range(len(tree)):
                if kinds[i] != SHADOW:
                    assert "".join(shapes[f"hit-{i}"]._element.xpath(".//a:t/text()")) == (
                        tree.object_name(i) or "background"
                    )


def test_png_is_transparent_unless_asked(worlds: dict[str, tracer.World]) -> None:
    for ground in (False, True):
        figure = pages("tree", Subject(by_depth(trees(worlds, "glass-ball"))), FigureStyle(LIGHT, ground=ground))[-1]
        picture = Image.open(io.BytesIO(written("png", [figure], 640)))
        assert picture.size == (640, 360)
        assert picture.getpixel((2, 357)) == ((233, 236, 240, 255) if ground else (0, 0, 0, 0))


def test_tikz_escapes_what_tex_would_read() -> None:
    from viewer.figures.writers.tikz import escaped

    assert escaped("50 % of $a_b$ {c} \\d ~e^f #1 & g") == (
        r"50 \% of \$a\_b\$ \{c\} \textbackslash{}d \textasciitilde{}e\textasciicircum{}f \#1 \& g"
    )


def test_tikz_says_every_word(figures: list[Figure]) -> None:
    from viewer.figures.writers.tikz import escaped

    text = written("tikz", figures[-1:]).decode("utf-8")
    for word in words(figures[-1]):
        assert f"{{{escaped(word)}}};" in text
    assert text.isascii() or not re.search(r"[^\x00-\xff]", re.sub(r"^%.*$", "", text, flags=re.M))


def test_same_input_same_bytes(tmp_path: Path) -> None:
    """In separate processes, in which sets iterate in another order."""
    found = []
    for seed in ("1", "2"):
        folder = tmp_path / seed
        command = [Path(sys.executable).parent / "raytree", "export", "glass-ball", "--depth", "0..3", "--swatches"]
        command += ["--format", ",".join(FORMATS), "-o", f"{folder}/"]
        subprocess.run(command, check=True, capture_output=True, env={**os.environ, "PYTHONHASHSEED": seed})
        found.append({path.name: path.read_bytes() for path in folder.iterdir()})
    assert len(found[0]) == sum(1 if kind.many_pages else 4 for kind in FORMATS.values())
    assert found[0] == found[1]


def test_every_file_says_which_command_made_it(worlds: dict[str, tracer.World], tmp_path: Path) -> None:
    from pptx import Presentation

    command = "raytree export glass-ball --theme light"
    found = pages("tree", Subject(by_depth(trees(worlds, "glass-ball"))), FigureStyle(), command)
    assert ElementTree.fromstring(written("svg", found)).findtext(f"{SVG}metadata") == command
    assert Image.open(io.BytesIO(written("png", found))).info["Source"] == command
    assert f"% {command}" in written("tikz", found).decode("utf-8").splitlines()
    assert Presentation(io.BytesIO(written("pptx", found))).core_properties.comments == command
    (tmp_path / "a.pdf").write_bytes(written("pdf", found))
    said = subprocess.run(["pdfinfo", tmp_path / "a.pdf"], capture_output=True, text=True, check=True).stdout
    assert re.search(rf"^Keywords:\s+{command}$", said, re.MULTILINE)
    assert re.search(rf"^Title:\s+{re.escape(found[0].title)}$", said, re.MULTILINE)

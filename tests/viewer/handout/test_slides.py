"""A lesson as PPTX and as PDF, read with other programs."""

import io
import subprocess
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from tests.viewer.handout.sample import EVIL
from viewer.figures.marks import HEIGHT, WIDTH
from viewer.handout import pdf, pptx
from viewer.handout.document import Handout, paper
from viewer.handout.slides import Slide, slides_of
from viewer.lessons.moments import count_presses

COMMAND = "raytree export glass --lesson"


@pytest.fixture(scope="module")
def slides(handout: Handout) -> list[Slide]:
    return slides_of(handout, paper("light"))


@pytest.fixture(scope="module")
def deck(handout: Handout) -> Any:
    from pptx import Presentation

    return Presentation(io.BytesIO(pptx.write_slides(handout, COMMAND, "light")))


def shapes(parent: Any) -> Iterator[Any]:
    for shape in parent:
        yield shape
        if hasattr(shape, "shapes"):
            yield from shapes(shape.shapes)


def words(parent: Any) -> str:
    return "\n".join(shape.text_frame.text for shape in shapes(parent) if shape.has_text_frame)


def test_there_is_a_slide_for_the_cover_and_each_moment(handout: Handout, slides: list[Slide], deck: Any) -> None:
    moments = sum(count_presses(page.step, len(page.stages)) + 1 for page in handout.pages)
    assert len(slides) == len(deck.slides) == 1 + moments
    for slide, made in zip(slides, deck.slides, strict=True):
        assert made.shapes.title.text == slide.title != ""
        assert made._element.xpath(".//*[local-name()='morph']")
        texts = " ".join(words(made.shapes).split())
        for block in slide.text.blocks:
            if block.kind != "formula":
                said = "".join(f" {w.style.text}" if w.is_formula else f" {w.content}" for w in block.words)
                assert "".join(said.split()) in "".join(texts.split())
    assert deck.slides[1].notes_slide.notes_text_frame.text == "Say *nothing* yet."


def test_a_piece_before_a_sweep_is_about_its_beginning_and_then_about_its_end(
    handout: Handout, slides: list[Slide]
) -> None:
    page = handout.pages[2]
    first, second, *_ = ((p for p in slide.pictures if p.kind == "snell") for slide in slides if slide.page is page)
    (before,), (after,) = first, second
    assert before.tree is page.show.shown[0].tree and after.tree is page.show.shown[-1].tree
    assert before.where == after.where and before.marks != after.marks


def test_every_shape_has_a_name_of_its_own_and_a_ray_has_the_same_on_all_slides(
    handout: Handout, slides: list[Slide], deck: Any
) -> None:
    named = [[shape.name for shape in shapes(made.shapes)] for made in deck.slides]
    for names in named:
        assert len(set(names)) == len(names) and all(name.startswith("!!") for name in names)
    page = handout.pages[0]
    stages = [(k, slide) for k, slide in enumerate(slides) if slide.page is page][: len(page.stages)]
    for (k, _), (j, _) in pairwise(stages):
        before = {name for name in named[k] if name.startswith(("!!tree ray", "!!tree hit", "!!scene ray"))}
        assert before < set(named[j])  # the tree grows
        places = [
            {shape.name: (shape.left, shape.top, shape.width, shape.height) for shape in deck.slides[n].shapes}
            for n in (k, j)
        ]
        boxes = {name for name in before & set(places[0]) if name.startswith("!!tree hit") and " " not in name[11:]}
        assert all(places[0][name] == places[1][name] for name in boxes)
    assert page.parts[0].shown.tree
    assert {
        f"!!tree hit {page.parts[0].shown.tree.path(i)}"
        for i in range(len(page.parts[0].shown.tree))
        if page.parts[0].shown.tree.kind(i) != "shadow"
    } <= set(named[stages[-1][0]])


def test_nothing_leaves_a_slide_and_the_text_is_above_the_pictures(slides: list[Slide]) -> None:
    for slide in slides:
        left, top, _, bottom = slide.text_box
        for placed in slide.pictures:
            a, b, c, d = placed.where
            assert 0.0 <= a < c <= WIDTH and 0.0 <= b < d <= HEIGHT
            assert b >= bottom or a >= left + slide.text.width
        for block in slide.text.blocks:
            assert block.bottom <= bottom - top + 20.0
        assert all(placed.said for placed in slide.pictures)


def test_the_pdf_is_tagged_in_the_order_of_reading(handout: Handout, slides: list[Slide], tmp_path: Path) -> None:
    path = tmp_path / "glass.pdf"
    path.write_bytes(pdf.write_slides(handout, COMMAND, "light"))
    assert path.read_bytes() == pdf.write_slides(handout, COMMAND, "light")

    def said(*options: str) -> str:
        return subprocess.run(["pdfinfo", *options, path], capture_output=True, text=True, check=True).stdout

    info = dict(line.split(":", 1) for line in said().splitlines() if ":" in line)
    assert info["Tagged"].strip() == "yes" and info["Title"].strip() == f"Glass {EVIL}"
    assert int(info["Pages"]) == len(slides)
    kinds = [line.split()[0] for line in said("-struct").splitlines() if line.startswith("  ") and line[2] != " "]
    expected = []
    for slide in slides:
        expected.append("H2" if slide.page else "H1")
        expected += ["Formula" if block.kind == "formula" else "P" for block in slide.text.blocks]
        expected += ["Figure"] * len(slide.pictures)
    assert kinds == expected
    text = "".join(said("-struct-text").split())
    for slide in slides:
        for block in slide.text.blocks:
            if block.kind != "formula":
                plain = "".join(word.style.text if word.is_formula else word.content for word in block.words)
                assert "".join(plain.split()) in text.replace('"', "") or '"' in plain

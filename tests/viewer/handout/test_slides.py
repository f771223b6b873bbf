"""A lesson as PPTX and as PDF, read with other programs."""

import io
import subprocess
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from tests.viewer.handout.sample import EVIL
from viewer.base.wording import format_angle
from viewer.figures.marks import HEIGHT, WIDTH, Text
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
    presses = sum(count_presses(page.step, len(page.stages)) + 1 for page in handout.pages)
    moments = presses + sum(len(page.on_the_way) for page in handout.pages)
    assert len(slides) == len(deck.slides) == 1 + moments
    for slide, made in zip(slides, deck.slides, strict=True):
        assert made.shapes.title.text == slide.title != ""
        assert made._element.xpath(".//*[local-name()='morph']")
        texts = " ".join(words(made.shapes).split())
        for block in slide.text.blocks:
            if block.kind != "formula":
                said = "".join(f" {w.style.text}" if w.is_formula else f" {w.content}" for w in block.words)
                assert "".join(said.split()) in "".join(texts.split())


def test_each_slide_of_a_step_has_its_notes_or_its_text(slides: list[Slide], deck: Any) -> None:
    for slide, made in zip(slides, deck.slides, strict=True):
        said = made.notes_slide.notes_text_frame.text
        if slide.page and slide.page.number == 1:
            assert said == "Say *nothing* yet."
        elif slide.page and slide.page.number == 3:
            assert said.startswith("Snell\nn₁ sin θ₁ = n₂ sin θ₂\na")
        assert said.strip() == said != ""


def test_a_sweep_has_slides_where_the_tree_changes_and_live_pieces_go_along(
    handout: Handout, slides: list[Slide]
) -> None:
    page = handout.pages[2]
    trees = [shown.tree for shown in page.show.shown]
    paths = [[(tree.path(i), tree.object_name(i)) for i in range(len(tree))] for tree in trees if tree]
    changes = [k for k in range(1, len(paths)) if paths[k] != paths[k - 1]]
    expected = sorted({j for k in changes for j in (k - 1, k)} & set(range(1, len(paths) - 1)))
    assert list(page.on_the_way) == (expected[:4] or [6]) and len(page.stages) == 2
    own = [slide for slide in slides if slide.page is page]
    places = [0, *page.on_the_way, len(trees) - 1]
    for frame, slide in zip(places, own, strict=False):
        (snell,) = (placed for placed in slide.pictures if placed.kind == "snell")
        tree = trees[frame]
        assert tree
        angle = format_angle(float(tree.nodes["theta1"][0]))
        assert any(isinstance(mark, Text) and angle in f"{mark.content} {mark.title}" for mark in snell.marks), frame


def test_text_of_pictures_is_readable_from_the_last_row_and_inside_of_its_picture(slides: list[Slide]) -> None:
    """16 points on a slide of 540: the height of its letters is above 2 percent of the picture's."""
    for slide in slides:
        for placed in slide.pictures:
            left, top, right, bottom = placed.where
            for mark in placed.marks:
                if isinstance(mark, Text):
                    assert mark.size >= 14.0 or placed.kind in ("ray", "difference"), (placed.kind, mark)
                    a, b, c, d = mark.box()
                    assert left - 1 <= a and top - 1 <= b and c <= right + 1 and d <= bottom + 1, (placed.kind, mark)


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

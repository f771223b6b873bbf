"""Typeset formulas: their geometry, their text, and that every writer writes them."""

import itertools
import json
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pypdfium2
import pytest
from hypothesis import given, strategies as st
from PIL import Image

from viewer.base.theme import DARK, LIGHT
from viewer.explain.formulas import Lecture
from viewer.explain.plain_formula import COMMANDS, FormulaError, broken, joined, plain
from viewer.figures.font import has
from viewer.figures.formula import shipping
from viewer.figures.formula.coverage import coverage
from viewer.figures.formula.typeset import SHIPPED, Outline, typeset
from viewer.figures.marks import Figure, Formula
from viewer.figures.writers.pdf import write_pdf
from viewer.figures.writers.png import write_png
from viewer.figures.writers.pptx import write_pptx
from viewer.figures.writers.svg import write_svg
from viewer.figures.writers.tikz import write_tikz

SVG = "{http://www.w3.org/2000/svg}"
OF_LESSONS = r"\frac{d}{v_1} + \sqrt{\frac{a^2 + b^2}{v_2}} \geq \vec{d}\cdot\mathbf{n} \times \Omega_{12}"


def box_of(outline: Outline) -> tuple[float, float, float, float]:
    places = [place for contour in outline for segment in contour for place in segment]
    return min(places[::2]), min(places[1::2]), max(places[::2]), max(places[1::2])


def page_of(*marks: Formula) -> Figure:
    return Figure("formulas", "as on the slide", "raytree export", marks, LIGHT.panel, True, 480.0, 270.0)


def formula(source: str, anchor: str = "start") -> Formula:
    return Formula(
        "formulas", source, (240.0 if anchor != "start" else 60.0, 140.0), 24.0, (0.0, 0.0, 0.0, 1.0), anchor
    )


# --- text ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("source", "text"),
    [
        (Lecture.SNELL, "n₁ sin θ₁ = n₂ sin θ₂"),
        (Lecture.CRITICAL, "θc = arcsin(n₂ / n₁)"),
        (Lecture.TRANSMISSION, "t = n v + (n c₁ − c₂) n"),
        (Lecture.REFLECTION, "r = v − 2 (n·v) n"),
        (Lecture.FRESNEL, "R = (rₛ² + rₚ²) / 2"),
        (Lecture.AMPLITUDE_S, "rₛ = (n₁ c₁ − n₂ c₂) / (n₁ c₁ + n₂ c₂)"),
        (Lecture.COSINE_2, "c₂ = √(1 − n²(1 − c₁²))"),
        (Lecture.RADIANCE, "I = local + Σ factor × child"),
        (r"x^{10} + x^{ab} - e^{-2}", "x¹⁰ + x^ab − e⁻²"),
        (r"\cos^2\theta + \sin(2\theta)", "cos²θ + sin(2θ)"),
        (OF_LESSONS, "d / v₁ + √((a² + b²) / v₂) ≥ d·n × Ω₁₂"),
    ],
)
def test_the_plain_text_of_a_formula(source: str, text: str) -> None:
    assert plain(source) == text


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (r"\foo + 1", "\\foo is not known"),
        (r"\frac{a", "a { has no }"),
        ("a}", "a } has no {"),
        (r"\frac{a}", "its end is missing"),
        ("a_", "its end is missing"),
        ("a__b", "a _ has nothing before it"),
        ("50 % of $a$", "'%' is not allowed"),
        ("π", "'π' is not allowed"),
    ],
)
def test_what_is_not_in_our_part_of_latex_is_named(source: str, message: str) -> None:
    for use in (plain, typeset):
        with pytest.raises(FormulaError, match=re.escape(message)) as caught:
            use(source)
        assert repr(source) in str(caught.value) and "\n" not in str(caught.value)


@given(st.lists(st.sampled_from([*"ab12+-=()_^{} ", *(f"\\{command} " for command in COMMANDS)]), max_size=12))
def test_any_source_has_a_plain_text_or_one_line_about_its_fault(tokens: list[str]) -> None:
    try:
        text = plain("".join(tokens))
    except FormulaError as fault:
        assert "\n" not in str(fault)
    else:
        assert "\\" not in text and "{" not in text and "_" not in text


@pytest.mark.parametrize("source", ("", " ", r"\quad", r"\left(", r"\right)", "x_1_2"))
def test_what_cannot_be_typeset_is_one_line(source: str) -> None:
    with pytest.raises(FormulaError, match=r"^[^\n]*$") as caught:
        typeset(source)
    assert repr(source.strip()) in str(caught.value)


def test_figures_have_the_letters_of_all_formulas() -> None:
    assert [letter for source in Lecture for letter in plain(source) if not has(letter)] == []


# --- geometry -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("source", [*Lecture, OF_LESSONS], ids=lambda source: plain(source))
def test_the_box_of_a_formula_holds_its_outlines_and_glyphs_do_not_overlap(source: str) -> None:
    made = typeset(source)
    left, top, right, bottom = made.box
    boxes = [box_of(outline) for outline in made.outlines]
    for box in boxes:
        assert left <= box[0] and top <= box[1] and box[2] <= right and box[3] <= bottom
    assert min(box[1] for box in boxes) == top and max(box[3] for box in boxes) == bottom
    if r"\sqrt" in source or r"\frac" in source:
        return  # a root's sign is around what stands in it
    inks = [coverage(type(made)(made.box, (outline,)), 60.0, 9, 120, 1400, 200) > 127 for outline in made.outlines]
    for a, b in itertools.combinations(inks, 2):
        assert not (a & b).any()


def test_the_bar_of_a_fraction_stands_between_numerator_and_denominator() -> None:
    *glyphs, bar = typeset(r"\frac{n_2}{n_1}").outlines
    left, top, right, bottom = box_of(bar)
    boxes = [box_of(glyph) for glyph in glyphs]
    over, under = [box for box in boxes if box[3] < top], [box for box in boxes if box[1] > bottom]
    assert len(over) == len(under) == 2 and len(boxes) == 4
    for part in (over, under):  # each as wide as the bar at most, and in its middle
        start, end = min(box[0] for box in part), max(box[2] for box in part)
        assert left <= start and end <= right
        assert abs(start + end - left - right) < 0.1
    assert top < -0.2 < bottom or abs(0.5 * (top + bottom) + 0.258) < 0.01  # on the axis of the font


def test_subscripts_are_smaller_and_lower_superscripts_higher() -> None:
    (n, one), (eta, two) = ([box_of(o) for o in typeset(source).outlines] for source in (r"n_1", r"n^1"))
    assert one[3] > n[3] + 0.05 and one[1] > n[1]  # below the baseline, and below the letter's top
    assert two[3] < eta[3] and two[1] < eta[1] - 0.1
    (alone,) = (box_of(o) for o in typeset("1").outlines)
    assert 0.6 < (one[3] - one[1]) / (alone[3] - alone[1]) < 0.8


def test_a_root_covers_what_stands_below_it() -> None:
    bar = box_of(typeset(Lecture.COSINE_2).outlines[-1])
    below = [box_of(outline) for outline in typeset(Lecture.COSINE_2).outlines[:-1]]
    inside = [box for box in below if box[0] > bar[0]]
    assert len(inside) >= 8
    assert all(bar[0] <= box[0] and box[2] <= bar[2] and box[1] >= bar[1] for box in inside)


def test_variables_are_italic_functions_and_digits_upright_vectors_bold() -> None:
    """By the glyphs' shapes: an italic letter leans, so its ink moves to the right towards its top."""

    def lean(source: str) -> float:
        made = typeset(source)
        ink = coverage(made, 400.0, 100, 400, 600, 600) > 127
        rows = np.flatnonzero(ink.any(axis=1))
        first, last = rows[len(rows) // 10], rows[-len(rows) // 10]
        return float(np.flatnonzero(ink[first]).mean() - np.flatnonzero(ink[last]).mean())

    assert lean("l") > 20.0 and abs(lean(r"\mathrm{l}")) < 20.0
    thin, bold = (coverage(typeset(s), 400.0, 100, 400, 600, 600).sum() for s in (r"\mathrm{n}", r"\mathbf{n}"))
    assert bold > 1.3 * thin


def test_a_long_formula_has_a_place_where_it_is_broken() -> None:
    first, second = broken(Lecture.LOCAL)
    whole, parts = typeset(joined(Lecture.LOCAL)), [typeset(first), typeset(second)]
    assert max(part.box[2] for part in parts) < 0.65 * whole.box[2]
    assert typeset(Lecture.LOCAL) == whole


# --- shipped ------------------------------------------------------------------------------------------------------


def test_shipped_outlines_are_up_to_date() -> None:
    """If this fails: `make formulas`."""
    assert SHIPPED.read_bytes() == shipping.content()


def test_shipped_formulas_need_no_typesetter_others_do() -> None:
    program = (
        "import sys\nfrom viewer.explain.formulas import Lecture\nfrom viewer.figures.formula.typeset import typeset\n"
        "from viewer.explain.plain_formula import broken, left_side\n"
        "all(typeset(line) for source in Lecture for line in (source, left_side(source), *broken(source)))\n"
        "print('ziamath' in sys.modules)\ntypeset('a_2 + b')\nprint('ziamath' in sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False", "True"]


def test_a_shipped_formula_is_what_the_typesetter_makes_of_it() -> None:
    from viewer.figures.formula.typeset import make_typeset, outline
    from viewer.figures.formula.ziamath_paths import paths

    for source in (Lecture.SNELL, Lecture.FRESNEL, Lecture.COSINE_2):
        width, found = paths(source)
        made, shipped = make_typeset(width, map(outline, found)), typeset(source)
        assert np.allclose(made.box, shipped.box, atol=2e-4)  # shipped in tenths of a thousandth of an em
        assert [len(o) for o in made.outlines] == [len(o) for o in shipped.outlines]


# --- writers ------------------------------------------------------------------------------------------------------


def raster(mark: Formula, scale: float = 4.0) -> np.ndarray:
    """The coverage of a page of `page_of`."""
    x, y = mark.origin()
    size = (round(480.0 * scale), round(270.0 * scale))
    canvas = np.zeros(size[::-1])
    left, top = round(x * scale), round(y * scale)
    assert (left, top) == (x * scale, y * scale), "no rounding in these tests"
    return canvas + coverage(typeset(mark.source), mark.size * scale, left, top, *size) / 255.0


def darkness(picture: Image.Image) -> np.ndarray:
    return 1.0 - np.asarray(picture.convert("L"), dtype=float) / np.asarray(picture.convert("L")).max()


@pytest.mark.parametrize("source", (Lecture.FRESNEL, Lecture.TRANSMISSION, Lecture.COSINE_2, OF_LESSONS), ids=plain)
def test_svg_pdf_png_and_the_window_have_the_same_ink(source: str, tmp_path: Path) -> None:
    """librsvg, PDFium and our coverage agree, up to antialiasing at the edges."""
    mark = formula(source)
    (tmp_path / "page.svg").write_bytes(write_svg(page_of(mark)))
    subprocess.run(["rsvg-convert", "-w", "1920", "-o", tmp_path / "page.png", tmp_path / "page.svg"], check=True)
    (tmp_path / "pdf.png").write_bytes(write_png(page_of(mark), 1920))
    ours = raster(mark)
    assert 0.002 < ours.mean() < 0.1
    for name in ("page.png", "pdf.png"):
        with Image.open(tmp_path / name) as picture:
            other = darkness(picture)
        assert other.shape == ours.shape
        assert np.abs(other - ours).max() < 0.75  # of a pixel at an edge
        assert np.abs(other - ours).sum() < 0.05 * ours.sum(), name


def test_svg_says_the_formula_and_keeps_its_source() -> None:
    root = ElementTree.fromstring(write_svg(page_of(formula(Lecture.FRESNEL))))
    (path,) = (element for element in root.iter(f"{SVG}path") if element.get("role") == "img")
    assert path.get("aria-label") == plain(Lecture.FRESNEL) and path.get("data-tex") == Lecture.FRESNEL
    assert path.get("d", "").count("M") == sum(len(o) for o in typeset(Lecture.FRESNEL).outlines)


def test_a_pdf_can_be_searched_for_a_formula() -> None:
    marks = [formula(Lecture.SNELL), Formula("f", Lecture.FRESNEL, (60.0, 220.0), 18.0, LIGHT.text, "start")]
    with pypdfium2.PdfDocument(write_pdf([page_of(*marks)])) as document:
        page = document[0].get_textpage()
        assert {plain(mark.source) for mark in marks} <= set(page.get_text_bounded().splitlines())


def test_pptx_has_a_group_of_curves_with_the_formula_as_its_text() -> None:
    import io

    from pptx import Presentation

    mark = formula(Lecture.COSINE_2)
    deck = Presentation(io.BytesIO(write_pptx([page_of(mark)])))
    (group,) = deck.slides[0].shapes
    assert group.name == "formulas formula"
    assert group._element.xpath("./p:nvGrpSpPr/p:cNvPr")[0].get("descr") == plain(Lecture.COSINE_2)
    glyphs = list(group.shapes)  # type: ignore[attr-defined]
    assert len(glyphs) == len(typeset(mark.source).outlines)
    box = tuple(side / 12_700 for side in (group.left, group.top, group.left + group.width, group.top + group.height))
    assert np.allclose(box[1:], mark.box()[1:], atol=0.2) and box[0] >= mark.box()[0] - 0.2
    curves = [path for glyph in glyphs for path in glyph._element.xpath(".//a:quadBezTo")]
    assert len(curves) > 50 and all(len(curve) == 2 for curve in curves)
    for glyph in glyphs:  # in the units of each path's own box
        (path,) = glyph._element.xpath(".//a:path")
        for point in path.xpath(".//a:pt"):
            assert 0 <= int(point.get("x")) <= int(path.get("w")) and 0 <= int(point.get("y")) <= int(path.get("h"))


def test_tikz_has_real_mathematics() -> None:
    text = write_tikz(page_of(formula(Lecture.FRESNEL, "end"))).decode("utf-8")
    assert rf"{{\(\displaystyle {Lecture.FRESNEL}\)}};" in text and "anchor=base east" in text


@pytest.mark.parametrize("anchor", ("start", "middle", "end"))
def test_a_formula_stands_where_its_anchor_says(anchor: str) -> None:
    mark = formula(Lecture.SNELL, anchor)
    left, _, right, _ = mark.box()
    share = {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor]
    assert left + share * (right - left) == pytest.approx(mark.at[0])


def test_the_window_draws_what_the_outlines_say() -> None:
    """At three sizes, on a light and a dark ground; the images are kept, and forgotten with imgui's context."""
    from imgui_bundle import imgui

    from viewer.figures.writers.imgui import draw_marks
    from viewer.figures.writers.imgui_atlas import images
    from viewer.window.backend import Offscreen

    for _ in range(2):  # the second context has an atlas of its own
        surface = Offscreen((480, 270))
        for scale, theme in ((1.0, LIGHT), (1.25, DARK), (0.75, LIGHT)):
            mark = Formula("f", Lecture.FRESNEL, (60.0, 140.0), 24.0, theme.text, "start")
            for _ in range(3):
                surface.begin()
                pad = imgui.get_background_draw_list()
                pad.add_rect_filled((0, 0), (480, 270), imgui.get_color_u32(theme.panel))
                draw_marks(pad, [mark], (0.0, 0.0), scale)
                surface.present()
            picture = surface.grab().astype(float).mean(axis=2)
            ink = (picture - picture[0, 0]) / (255.0 * np.mean(theme.text[:3]) - picture[0, 0])
            place = round(60.0 * scale), round(140.0 * scale)
            ours = coverage(typeset(mark.source), 24.0 * scale, *place, 480, 270) / 255.0
            assert np.abs(ink - ours).max() < 0.03
        assert len(images.found) == 3
        surface.close()
        assert not images.found


def test_old_images_make_room_for_new_ones() -> None:
    from imgui_bundle import imgui

    from viewer.figures.writers import imgui_atlas, imgui_formula
    from viewer.window.backend import Offscreen

    surface = Offscreen((480, 270))
    for k in range(2):
        surface.begin()
        pad = imgui.get_background_draw_list()
        for step in range(imgui_atlas.MOST + 40):
            mark = Formula("f", Lecture.SNELL, (10.0, 100.0), 6.0 + 0.25 * (step + k), LIGHT.text, "start")
            imgui_formula.draw_formula(pad, mark, (0.0, 0.0), 1.0)
        surface.present()
        assert len(imgui_atlas.images.found) == imgui_atlas.MOST
    surface.close()


def test_the_shipped_file_is_small() -> None:
    shipped = json.loads(SHIPPED.read_text("utf-8"))
    assert SHIPPED.stat().st_size < 100_000 and len(shipped["formulas"]) >= len(Lecture)

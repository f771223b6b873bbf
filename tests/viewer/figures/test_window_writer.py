"""The window draws a figure's marks where the other writers draw them."""

import io
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
import PIL.Image
import pytest
from imgui_bundle import imgui

import tracer
from viewer.base.theme import DARK, LIGHT, Theme
from viewer.figures.marks import Figure, Formula, Shape, Stroke, Text
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.figures.writers.imgui import draw_marks
from viewer.figures.writers.png import write_png
from viewer.lessons import lesson
from viewer.window.backend import Offscreen

SIZE = (960, 540)
INK = 40  # difference of a pixel from the paper


@pytest.fixture(scope="module")
def surface() -> Iterator[Offscreen]:
    made = Offscreen(SIZE)
    yield made
    made.close()


def in_window(surface: Offscreen, figure: Figure) -> np.ndarray:
    surface.begin()
    pad = imgui.get_background_draw_list()
    pad.add_rect_filled((0.0, 0.0), SIZE, imgui.get_color_u32(figure.paper))
    draw_marks(pad, figure.marks, (0.0, 0.0), 1.0)
    surface.present()
    return surface.grab().astype(int)


def in_file(figure: Figure) -> np.ndarray:
    return np.asarray(PIL.Image.open(io.BytesIO(write_png(figure, SIZE[0]))).convert("RGB")).astype(int)


def ink(picture: np.ndarray) -> np.ndarray:
    return np.abs(picture - picture[0, 0]).max(axis=2) > INK


def grown(mask: np.ndarray) -> np.ndarray:
    """The mask with all pixels beside it."""
    padded = np.pad(mask, 1)
    height, width = mask.shape
    return np.any([padded[dy : dy + height, dx : dx + width] for dy in range(3) for dx in range(3)], axis=0)


def without_texts(figure: Figure) -> Figure:
    """The figure without letters, which are those of other fonts."""
    return replace(figure, marks=tuple(mark for mark in figure.marks if not isinstance(mark, Text | Formula)))


def figures(world: tracer.World, name: str, theme: Theme) -> Iterable[Figure]:
    pixel = lesson.read(name).first.state.pixel
    steps = by_depth([tracer.trace(world, pixel, depth=3)])
    for figure in ("tree", "hit"):
        style = FigureStyle(theme, text_size=16.0, swatches=True, ground=True, levels=True, selected=0)
        yield from pages(figure, Subject(steps, world), style)


@pytest.mark.parametrize("name", ("glass-ball", "mirror-balls", "underwater", "two-lights"))
def test_lines_and_signs_stand_where_they_do_in_a_file(
    surface: Offscreen, worlds: dict[str, tracer.World], name: str
) -> None:
    """Each pixel with ink has one in the other picture, itself or beside it."""
    for theme in (DARK, LIGHT):
        for figure in figures(worlds[name], name, theme):
            bare = without_texts(figure)
            window, file = ink(in_window(surface, bare)), ink(in_file(bare))
            assert file.sum() > 2000
            assert (window & ~grown(file)).sum() <= 0.002 * window.sum()
            assert (file & ~grown(window)).sum() <= 0.002 * file.sum()


def test_texts_begin_end_and_stand_where_they_do_in_a_file(surface: Offscreen) -> None:
    """The letters are narrower, so the side of the anchor agrees; capitals stand on one line and are as high."""
    for anchor, side in (("start", 0), ("end", 1)):
        text = Text("t", (400.0, 200.0), "HEIM H", 30.0, DARK.text, anchor)
        figure = Figure("", "", "", (text,), DARK.ground, ground=True)
        ends = []
        for picture in (in_window(surface, figure), in_file(figure)):
            rows, columns = np.nonzero(ink(picture))
            ends.append(((columns.min(), columns.max())[side], rows.min(), rows.max()))
        assert np.abs(np.subtract(*ends)).max() <= 2.0, ends


def test_outlines_with_holes_are_filled_around_them(surface: Offscreen) -> None:
    ring = Shape(
        "s", ((100.0, 100.0), (300.0, 100.0), (300.0, 300.0), (100.0, 300.0)), DARK.accent, Stroke(DARK.text, 2.0),
        holes=(((150.0, 150.0), (150.0, 250.0), (250.0, 250.0), (250.0, 150.0)),),
    )  # fmt: skip
    figure = Figure("", "", "", (ring,), DARK.ground, ground=True)
    window, file = ink(in_window(surface, figure)), ink(in_file(figure))
    assert window[200, 120] and not window[200, 200]
    assert (window & ~grown(file)).sum() == 0 and (file & ~grown(window)).sum() == 0


@pytest.mark.parametrize("order", [1, -1])
def test_concave_outlines_are_filled_inside_only(surface: Offscreen, order: int) -> None:
    corners = ((100.0, 100.0), (300.0, 300.0), (500.0, 100.0), (300.0, 500.0))
    figure = Figure("", "", "", (Shape("s", corners[::order], DARK.accent, None),), DARK.ground, ground=True)
    window, file = ink(in_window(surface, figure)), ink(in_file(figure))
    assert window[400, 300] and not window[200, 300]
    assert (window & ~grown(file)).sum() == 0 and (file & ~grown(window)).sum() == 0


@pytest.mark.parametrize("size", [115.0, 250.0, 300.0])
def test_a_formula_that_is_wider_than_the_atlas_is_drawn_all_the_same(surface: Offscreen, size: float) -> None:
    """The atlas is at most 2048 pixels wide here. The ink ends where that of a file does, also at the border."""

    def figure(size: float) -> Figure:
        mark = Formula("f", r"n_1 \sin \theta_1 = n_2 \sin \theta_2", (20.0, 300.0), size, DARK.text, "start")
        return Figure("", "", "", (mark,), DARK.ground, ground=True, width=float(SIZE[0]), height=float(SIZE[1]))

    imgui.get_io().fonts.tex_max_width = 2048
    edges = []
    for picture in (in_window(surface, figure(size)), in_file(figure(size))):
        rows, columns = np.nonzero(ink(picture))
        edges.append((columns.min(), rows.min(), columns.max(), rows.max()))
    assert np.abs(np.subtract(*edges)).max() <= 3

"""The image of a raster mark is the same in the window and in every format, pixel by pixel."""

import io
import re
import zipfile
from base64 import b64decode
from collections.abc import Callable

import numpy as np
import PIL.Image
import pytest
from imgui_bundle import imgui

from viewer.base.pdfium import render_page
from viewer.base.theme import LIGHT, rgb_bytes
from viewer.figures.catalogue import FORMATS
from viewer.figures.marks import Figure, Raster
from viewer.figures.writers.imgui import draw_marks
from viewer.figures.writers.raster import raster_runs
from viewer.window.backend import Offscreen

SHAPE, PLACE, SCALE = (5, 4), (40, 24), 8  # the size in pixels; the left and upper end; points for each pixel
PIXELS = np.random.default_rng(3).integers(0, 256, (SHAPE[1], SHAPE[0], 3), np.uint8)
PIXELS[1, 1:4] = PIXELS[1, 1]  # a run
CENTER = (PLACE[0] + 0.5 * SCALE * SHAPE[0], PLACE[1] + 0.5 * SCALE * SHAPE[1])
MARK = Raster("picture", CENTER, (SCALE * SHAPE[0], SCALE * SHAPE[1]), SHAPE, PIXELS.tobytes())
SIZE = (160, 96)
FIGURE = Figure("title", "description", "command", (MARK,), LIGHT.panel, True, float(SIZE[0]), float(SIZE[1]))


def picture_of(file: bytes) -> np.ndarray:
    return np.asarray(PIL.Image.open(io.BytesIO(file)).convert("RGB"))


def of_page(page: np.ndarray) -> np.ndarray:
    """The middles of the pixels in a picture of the page, one pixel for each point."""
    half = SCALE // 2
    return page[PLACE[1] + half :: SCALE, PLACE[0] + half :: SCALE][: SHAPE[1], : SHAPE[0]]


def in_window() -> np.ndarray:
    surface = Offscreen(SIZE)
    for _ in range(2):
        surface.begin()
        pad = imgui.get_background_draw_list()
        draw_marks(pad, [MARK], (0.0, 0.0), 1.0)
        surface.present()
    page = surface.grab().copy()
    surface.close()
    (x, y), (w, h) = PLACE, MARK.size
    whole = page[y : y + int(h), x : x + int(w)]
    assert np.array_equal(whole, PIXELS.repeat(SCALE, 0).repeat(SCALE, 1))  # sharp up to its borders
    return of_page(page)


def in_svg() -> np.ndarray:
    text = FORMATS["svg"].write([FIGURE], 960).decode()
    found = re.search(r'<image x="40" y="24" width="40" height="32" .* href="data:image/png;base64,([^"]+)"/>', text)
    assert found
    return picture_of(b64decode(found[1]))


def in_tikz() -> np.ndarray:
    assert FORMATS["tikz"].write([FIGURE], 960).decode().count(r"\fill[fill={rgb") == len(list(raster_runs(MARK))) + 1
    page = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    for color, (left, top), (right, bottom) in raster_runs(MARK):
        page[round(top) : round(bottom), round(left) : round(right)] = rgb_bytes(color)
    return of_page(page)


def in_pptx() -> np.ndarray:
    with zipfile.ZipFile(io.BytesIO(FORMATS["pptx"].write([FIGURE], 960))) as archive:
        (name,) = (name for name in archive.namelist() if name.startswith("ppt/media/"))
        return picture_of(archive.read(name))


def in_pdf() -> np.ndarray:
    return of_page(np.asarray(render_page(FORMATS["pdf"].write([FIGURE], 960), 1.0).convert("RGB")))


def in_png() -> np.ndarray:
    return of_page(picture_of(FORMATS["png"].write([FIGURE], SIZE[0])))


@pytest.mark.parametrize("found", [in_window, in_svg, in_tikz, in_pptx, in_pdf, in_png], ids=lambda way: way.__name__)
def test_the_pixels_are_those_of_the_mark(found: Callable[[], np.ndarray]) -> None:
    assert np.array_equal(found(), PIXELS)

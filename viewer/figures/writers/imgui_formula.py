"""Formulas in the window: their outlines as an image in imgui's font atlas, drawn once per formula and size.

The image is white, and takes any colour.
"""

from math import ceil, floor

import numpy as np
from imgui_bundle import imgui

from viewer.figures.formula.coverage import coverage
from viewer.figures.formula.typeset import typeset
from viewer.figures.marks import Formula, Point
from viewer.figures.writers.imgui_atlas import images

STEPS = 4  # per pixel: sizes are rounded to a quarter of a pixel

Key = tuple[str, int]  # source; size in steps


def frame(key: Key) -> tuple[int, int, int, int]:
    """(left, top, right, bottom) of an image in pixels, from the left end of the formula's baseline."""
    left, top, right, bottom = (key[1] / STEPS * side for side in typeset(key[0]).box)
    return (floor(left) - 1, floor(top) - 1, ceil(right) + 1, ceil(bottom) + 1)


def _image(key: Key) -> imgui.ImFontAtlasRect | None:
    """The place of a formula's image in the atlas; None if it is too large for it."""
    left, top, right, bottom = frame(key)
    source, steps = key
    width, height = right - left, bottom - top

    def fill(pixels: np.ndarray) -> None:
        pixels[..., -1] = coverage(typeset(source), steps / STEPS, -left, -top, width, height)

    return images.rectangle(key, (width, height), fill)


def draw_formula(pad: imgui.ImDrawList, mark: Formula, corner: Point, scale: float) -> None:
    """Draw a formula of a canvas whose top left is at `corner`, in pixels. `scale` is pixels per point. As texts, it
    begins at a whole pixel. One that is too large for the atlas is drawn from a smaller image.
    """
    steps, times = max(STEPS, round(STEPS * mark.size * scale)), 1
    while (place := _image((mark.source, steps // times))) is None:
        times *= 2
        if times > steps:  # not even a dot fits
            return
    origin = mark.origin()
    x, y = (round(corner[k] + scale * origin[k]) for k in (0, 1))
    left, top, right, bottom = (times * side for side in frame((mark.source, steps // times)))
    color = imgui.get_color_u32(mark.color)
    texture = imgui.get_io().fonts.tex_data.get_tex_ref()
    pad.add_image(texture, (x + left, y + top), (x + right, y + bottom), place.uv0, place.uv1, color)

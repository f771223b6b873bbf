"""Formulas in the window: their outlines as an image in imgui's font atlas, drawn once per formula and size.

The atlas also holds the letters of the texts, so that a formula costs no change of texture, and takes any colour. A
formula's image stays until it is the one that was not drawn for longest.
"""

from collections import OrderedDict
from math import ceil, floor

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.figures.formula.coverage import coverage
from viewer.figures.formula.typeset import typeset
from viewer.figures.marks import Formula, Point

MOST = 256  # images: some windows full of formulas
STEPS = 4  # per pixel: sizes are rounded to a quarter of a pixel

Key = tuple[str, int]  # source; size in steps


class _Images:
    """The images in the atlas of the current imgui context."""

    def __init__(self) -> None:
        self.found: OrderedDict[Key, int] = OrderedDict()  # the number of the image's rectangle in the atlas

    def rectangle(self, key: Key) -> imgui.ImFontAtlasRect | None:
        """The place in the atlas, which may change from call to call, when the atlas grows. None if the image is too
        large for it.
        """
        fonts, place = imgui.get_io().fonts, imgui.ImFontAtlasRect()
        number = self.found.pop(key, None)
        if number is None:
            while len(self.found) >= MOST:
                fonts.remove_custom_rect(self.found.popitem(last=False)[1])
            number = self._add(key)
        if number is None:
            return None
        self.found[key] = number
        fonts.get_custom_rect(number, place)
        return place

    def _add(self, key: Key) -> int | None:
        source, steps = key
        left, top, right, bottom = frame(key)
        fonts, place = imgui.get_io().fonts, imgui.ImFontAtlasRect()
        number = fonts.add_custom_rect(right - left, bottom - top, place)
        if not place.w:
            return None
        texture = fonts.tex_data
        pixels = texture.get_pixels_array().reshape(texture.height, texture.width, texture.bytes_per_pixel)
        image = pixels[place.y : place.y + place.h, place.x : place.x + place.w]
        image[...] = 255
        image[..., -1] = coverage(typeset(source), steps / STEPS, -left, -top, right - left, bottom - top)
        internal.im_font_atlas_texture_block_queue_upload(fonts, texture, place.x, place.y, place.w, place.h)
        return number


_images = _Images()  # as imgui's context, of which there is one at a time


def forget_images() -> None:
    """To be called when imgui's context ends: the images end with its atlas."""
    _images.found.clear()


def frame(key: Key) -> tuple[int, int, int, int]:
    """(left, top, right, bottom) of an image in pixels, from the left end of the formula's baseline."""
    left, top, right, bottom = (key[1] / STEPS * side for side in typeset(key[0]).box)
    return (floor(left) - 1, floor(top) - 1, ceil(right) + 1, ceil(bottom) + 1)


def draw_formula(pad: imgui.ImDrawList, mark: Formula, corner: Point, scale: float) -> None:
    """Draw a formula of a canvas whose top left is at `corner`, in pixels. `scale` is pixels per point. As texts, it
    begins at a whole pixel. One that is too large for the atlas is drawn from a smaller image.
    """
    steps, times = max(STEPS, round(STEPS * mark.size * scale)), 1
    while (place := _images.rectangle((mark.source, steps // times))) is None:
        times *= 2
        if times > steps:  # not even a dot fits
            return
    origin = mark.origin()
    x, y = (round(corner[k] + scale * origin[k]) for k in (0, 1))
    left, top, right, bottom = (times * side for side in frame((mark.source, steps // times)))
    color = imgui.get_color_u32(mark.color)
    texture = imgui.get_io().fonts.tex_data.get_tex_ref()
    pad.add_image(texture, (x + left, y + top), (x + right, y + bottom), place.uv0, place.uv1, color)

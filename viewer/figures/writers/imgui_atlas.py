"""Images in imgui's font atlas: outlines of formulas, rasters. An image stays until it is the one that was not drawn
for longest.

The atlas also holds the letters of the texts, so that an image costs no change of texture.
"""

from collections import OrderedDict
from collections.abc import Callable, Hashable

import numpy as np
from imgui_bundle import imgui
from imgui_bundle.imgui import internal

MOST = 256  # images: some windows full of formulas


class Images:
    """The images in the atlas of the current imgui context."""

    def __init__(self) -> None:
        self.found: OrderedDict[Hashable, int] = OrderedDict()  # the number of the image's rectangle in the atlas

    def rectangle(
        self, key: Hashable, size: tuple[int, int], fill: Callable[[np.ndarray], object]
    ) -> imgui.ImFontAtlasRect | None:
        """The place in the atlas, which may change from call to call, when the atlas grows. None if an image of this
        size in pixels is too large for it. A new one is made by `fill`, from white and opaque pixels (height, width,
        channels) uint8; the last channel is the opacity.
        """
        fonts, place = imgui.get_io().fonts, imgui.ImFontAtlasRect()
        number = self.found.pop(key, None)
        if number is None:
            while len(self.found) >= MOST:
                fonts.remove_custom_rect(self.found.popitem(last=False)[1])
            number = self._add(size, fill)
        if number is None:
            return None
        self.found[key] = number
        fonts.get_custom_rect(number, place)
        return place

    def _add(self, size: tuple[int, int], fill: Callable[[np.ndarray], object]) -> int | None:
        fonts, place = imgui.get_io().fonts, imgui.ImFontAtlasRect()
        number = fonts.add_custom_rect(*size, place)
        if not place.w:
            return None
        texture = fonts.tex_data
        pixels = texture.get_pixels_array().reshape(texture.height, texture.width, texture.bytes_per_pixel)
        image = pixels[place.y : place.y + place.h, place.x : place.x + place.w]
        image[...] = 255
        fill(image)
        internal.im_font_atlas_texture_block_queue_upload(fonts, texture, place.x, place.y, place.w, place.h)
        return number


images = Images()  # as imgui's context, of which there is one at a time


def forget_images() -> None:
    """To be called when imgui's context ends: the images end with its atlas."""
    images.found.clear()

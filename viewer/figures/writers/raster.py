"""The image of a raster mark, for formats that have images, and as rectangles for those that have none."""

from collections.abc import Iterator
from itertools import groupby

import numpy as np

from viewer.base.pictures import png
from viewer.base.theme import Color
from viewer.figures.marks import Point, Raster


def raster_pixels(mark: Raster) -> np.ndarray:
    """The pixels, (height, width, 3) uint8."""
    width, height = mark.shape
    return np.frombuffer(mark.pixels, np.uint8).reshape(height, width, 3)


def raster_png(mark: Raster) -> bytes:
    """The image as a PNG file."""
    return png(raster_pixels(mark))


def raster_runs(mark: Raster) -> Iterator[tuple[Color, Point, Point]]:
    """(colour, first corner, opposite corner) of rectangles that cover the image: runs of equal pixels in a row."""
    (x, y), (w, h), (width, height) = mark.center, mark.size, mark.shape
    left, top, across, down = x - 0.5 * w, y - 0.5 * h, w / width, h / height
    for k, row in enumerate(raster_pixels(mark).tolist()):
        begin = 0
        for (r, g, b), run in groupby(row):
            end = begin + len(list(run))
            first, last = (left + begin * across, top + k * down), (left + end * across, top + (k + 1) * down)
            yield (r / 255.0, g / 255.0, b / 255.0, 1.0), first, last
            begin = end

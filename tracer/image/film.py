"""The film: the pixels of an image in progress, and totals over all that was traced for them."""

import math
from typing import NamedTuple

import numpy as np

from tracer.compile.jit import kernel
from tracer.compile.rows import Numbers, Rows
from tracer.formulas.double_double import dd_add
from tracer.formulas.vector import store, vector
from tracer.image.tiles import Tile
from tracer.kernel.entry import Counts, PixelRow
from tracer.kernel.nodes import KINDS


class Traced(NamedTuple):
    """A finished tile. `colors` is set for a plain image, `sums` in adaptive sampling."""

    tile: Tile
    counts: Counts
    residual: tuple[float, float] = (0.0, 0.0)  # of the weight that was cut: the largest of a pixel, and the total
    colors: np.ndarray | None = None  # (height, width, 3) of the tile; None if they are on the film already
    sums: np.ndarray | None = None  # (n, 4) of its list of pixels


class Totals:
    """Total numbers of rays, of intersection tests, and of trees that the limit of rows ended."""

    def __init__(self) -> None:
        self.rays = np.zeros(len(KINDS), np.int64)  # by kind
        self.tests = 0  # ray-surface intersection tests
        self.limited = 0  # trees

    def add(self, counts: Counts) -> None:
        """Add the counts of a tile."""
        self.rays += counts.rays
        self.tests += int(counts.tests[0])
        self.limited += int(counts.limited[0])


class Film:
    """An image in progress. Linear RGB."""

    def __init__(self, width: int, height: int) -> None:
        self.pixels = np.zeros((height, width, 3))
        self.totals = Totals()
        self.residuals: list[tuple[float, float]] = []

    def add(self, traced: Traced) -> None:
        """Add a finished tile."""
        self.totals.add(traced.counts)
        self.residuals.append(traced.residual)
        if traced.colors is not None:
            self.pixels[traced.tile.part] = traced.colors

    def residual(self) -> dict[str, float]:
        """The weight that was cut: the largest of a pixel, and the mean over the pixels."""
        height, width, _ = self.pixels.shape
        total = math.fsum(total for _, total in self.residuals)
        return {"max": max(largest for largest, _ in self.residuals), "mean": total / (width * height)}


@kernel
def write_pixels(
    pixels: Rows[PixelRow], sums: Numbers, step: int, left: int, top: int, image: Numbers
) -> tuple[float, float]:
    """Write the mean over each pixel's samples into `image`, on the square of `step` pixels that it stands for.

    (left, top) is the pixel that is first in `image`. Returns the largest and the total of the pixels' residuals.
    """
    largest, total = 0.0, (0.0, 0.0)
    for k in range(len(pixels)):
        count = pixels[k].end - pixels[k].first
        color = vector(sums[k])
        residual = sums[k, 3]
        if count > 1:
            color = (color[0] / count, color[1] / count, color[2] / count)
            residual /= count
        if residual > 0.0:
            largest = max(largest, residual)
            total = dd_add(total, (residual, 0.0))
        x, y = pixels[k].x - left, pixels[k].y - top
        if step == 1:
            store(image[y, x], color)
            continue
        for j in range(y, min(y + step, image.shape[0])):
            for i in range(x, min(x + step, image.shape[1])):
                store(image[j, i], color)
    return (largest, total[0] + total[1])

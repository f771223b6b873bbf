"""Tiles of an image, and the list of pixels that the kernel traces for each.

An image that is watched is traced in several passes, coarse to fine: in a coarse pass, each traced pixel stands for
a square. Tiles write disjoint pixels, and no sum crosses a tile's border. So an image has the same bits for any
number of threads and any order of tiles.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tracer.compile.rows import Rows, as_rows
from tracer.kernel.entry import PIXEL, PixelRow

SIDE = 64  # pixels: some milliseconds of work, so that cancelling is fast and threads finish together
SMALL_SIDE = 16  # where trees may be so deep that a pixel takes a second
SHALLOW = 8  # the largest depth of trees for which the tiles are large
BLOCK = 4  # pixels are listed in blocks of 4x4, whose rays are close together
R2 = (0.7548776662466927, 0.5698402909980532)  # 1/g and 1/g^2, where g^3 = g + 1
COARSE_TO_FINE = (8, 4, 2, 1)  # steps of the passes of an image that is watched


class Tile(NamedTuple):
    """The pixels from (left, top) to before (right, bottom), every `step`-th of each row and column.

    Pixels on the coarser grid of every `traced`-th one were traced in an earlier pass; 0 if there was none.
    """

    left: int
    top: int
    right: int
    bottom: int
    step: int = 1
    traced: int = 0

    @property
    def part(self) -> tuple[slice, slice]:
        """The tile's part of an array (height, width, ...)."""
        return (slice(self.top, self.bottom), slice(self.left, self.right))


def make_tiles(width: int, height: int, side: int = SIDE, step: int = 1, traced: int = 0) -> list[Tile]:
    """The tiles of one pass, in reading order."""
    return [
        Tile(left, top, min(left + side, width), min(top + side, height), step, traced)
        for top in range(0, height, side)
        for left in range(0, width, side)
    ]


def tiles_of(width: int, height: int, depth: int) -> list[Tile]:
    """The tiles of an image that nobody watches, with trees of this depth."""
    return make_tiles(width, height, SIDE if depth <= SHALLOW else SMALL_SIDE)


def speedup(tiles: Sequence[Tile], threads: int) -> float:
    """How many times as fast so many threads are as one, at most: no two of them trace the same tile."""
    areas = [(tile.right - tile.left) * (tile.bottom - tile.top) for tile in tiles]
    return min(float(threads), sum(areas) / max(areas))


def scattered(tiles: Sequence[Tile]) -> list[Tile]:
    """The tiles of one pass in an order whose first ones, however many, are spread evenly over the image. So the share
    of the tiles that are done is about the share of the work, although one part of an image may take a thousand times
    as long as another.

    The order is that of a linear dither pattern with the constants of the R2 sequence (M. Roberts, "The Unreasonable
    Effectiveness of Quasirandom Sequences", 2018).
    """
    width, height = tiles[0].right - tiles[0].left, tiles[0].bottom - tiles[0].top
    return sorted(tiles, key=lambda tile: (R2[0] * (tile.left // width) + R2[1] * (tile.top // height)) % 1.0)


def make_passes(width: int, height: int, steps: Sequence[int] = (1,), side: int = SIDE) -> list[list[Tile]]:
    """The tiles of each pass. `steps` halve from pass to pass, down to 1.

    The tiles of a coarse pass are larger by its step, so that all tiles are about the same work.
    """
    before = (0, *steps)
    return [make_tiles(width, height, side * step, step, traced) for step, traced in zip(steps, before, strict=False)]


def pixel_list(tile: Tile, first: np.ndarray | int = 0, end: np.ndarray | int = 1) -> Rows[PixelRow]:
    """The pixels that a tile still has to trace, with their samples from `first` to before `end`.

    `first` and `end` are numbers, or arrays (height, width) of the tile's pixels; then pixels without new samples are
    left out.
    """
    offsets = _offsets(tile.right - tile.left, tile.bottom - tile.top, tile.step, tile.traced)
    if isinstance(first, np.ndarray) and isinstance(end, np.ndarray):
        x, y = offsets[:, 0], offsets[:, 1]
        has_new = end[y, x] > first[y, x]
        offsets, x, y = offsets[has_new], x[has_new], y[has_new]
        samples = np.stack([first[y, x], end[y, x]], axis=1)
        pixels = offsets + np.pad(samples, ((0, 0), (2, 0))) + np.array([tile.left, tile.top, 0, 0])
    else:
        pixels = offsets + np.array([tile.left, tile.top, first, end], np.int32)
    return as_rows(pixels.astype(np.int32, copy=False).view(PIXEL)[:, 0], PixelRow)


@lru_cache(maxsize=64)
def _offsets(width: int, height: int, step: int, traced: int) -> np.ndarray:
    """The pixels of a tile of this size, relative to its corner, block by block: (n, 4) as in PIXEL, no samples."""
    y, x = (grid.ravel() for grid in np.mgrid[0:height:step, 0:width:step])
    order = np.lexsort((x, y, x // (BLOCK * step), y // (BLOCK * step)))
    x, y = x[order], y[order]
    if traced:
        new = (x % traced != 0) | (y % traced != 0)
        x, y = x[new], y[new]
    return np.stack([x, y, 0 * x, 0 * y], axis=1).astype(np.int32)

"""Outlines as an image: the share of each pixel that they cover.

The winding number is summed up along the rows from the signed areas that short pieces of the outlines leave at their
right, as fonts are rasterised by FreeType and font-rs.
"""

from itertools import pairwise

import numpy as np

from viewer.figures.formula.typeset import Typeset

STEP = 0.125  # pixels: the longest piece, which counts as inside the pixel of its middle


def coverage(formula: Typeset, size: float, left: int, top: int, width: int, height: int) -> np.ndarray:
    """8-bit coverage (height, width) of a formula whose font is `size` pixels high. Its baseline starts at (left, top)
    of the image, which must hold all of it.
    """
    starts, ends = (points + np.array((left, top)) for points in _pieces(formula, size))
    x = 0.5 * (starts[:, 0] + ends[:, 0])
    column, upper = np.floor(x).astype(int), np.floor(np.minimum(starts[:, 1], ends[:, 1])).astype(int)
    winding = np.zeros(height * (width + 1))
    for row in (upper, upper + 1):  # a piece may reach into the next row
        rise = np.clip(ends[:, 1], row, row + 1) - np.clip(starts[:, 1], row, row + 1)
        inside = rise * (column + 1 - x)  # of the pixel itself; the pixels at its right have all of `rise`
        cells = row * (width + 1) + column
        for cell, share in ((cells, inside), (cells + 1, rise - inside)):
            winding += np.bincount(cell, share, winding.size)[: winding.size]
    covered = np.abs(np.cumsum(winding.reshape(height, width + 1), axis=1))[:, :width]
    return np.rint(255.0 * np.minimum(covered, 1.0)).astype(np.uint8)


def _pieces(formula: Typeset, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Starts and ends (n, 2) of the short pieces of all outlines, in pixels."""
    a, b, c = size * _parabolas(formula)
    counts = 1 + ((np.hypot(*(b - a).T) + np.hypot(*(c - b).T)) / STEP).astype(int)
    which = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)

    def points(t: np.ndarray) -> np.ndarray:
        t = t[:, None]
        return (1 - t) ** 2 * a[which] + 2 * t * (1 - t) * b[which] + t**2 * c[which]

    return points(number / counts[which]), points((number + 1) / counts[which])


def _parabolas(formula: Typeset) -> np.ndarray:
    """All sides of all outlines as parabolas (3, n, 2): start, control point, end. That of a line is its middle."""
    found = []
    for outline in formula.outlines:
        for contour in outline:
            for before, segment in pairwise((*contour, contour[0][-2:])):
                x, y = before[-2:]
                control = segment[:2] if len(segment) == 4 else (0.5 * (x + segment[0]), 0.5 * (y + segment[1]))
                found.append(((x, y), control, segment[-2:]))
    return np.array(found).transpose(1, 0, 2)

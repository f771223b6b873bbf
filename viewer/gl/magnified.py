"""A picture seen so near that its pixels are squares: they are what is clicked on.

The panels' backend filters every texture smoothly, whatever the texture says; so the squares are made here, for as much
of the picture as is on the screen, to be drawn pixel by pixel.
"""

import math
from typing import NamedTuple

import numpy as np

NEAR = 1.5  # screen pixels to one of the picture's, from which on they are squares


class Place(NamedTuple):
    """Where a picture is on the screen, and what of the screen is its panel's; in pixels."""

    left: float
    top: float
    scale: float  # screen pixels to one of the picture's
    panel: tuple[float, float, float, float]  # left, top, right, bottom


def magnify(picture: np.ndarray, place: Place) -> tuple[np.ndarray, int, int] | None:
    """(pixels, left, top): what of the picture (height, width, 4) is in the panel, as it is seen; None for nothing."""
    height, width = picture.shape[:2]
    left, top, right, bottom = place.panel
    first = (max(math.ceil(left), round(place.left)), max(math.ceil(top), round(place.top)))
    end = (
        min(math.floor(right), round(place.left + width * place.scale)),
        min(math.floor(bottom), round(place.top + height * place.scale)),
    )
    if end[0] <= first[0] or end[1] <= first[1]:
        return None
    columns = ((np.arange(first[0], end[0]) + 0.5 - place.left) / place.scale).astype(int)
    rows = ((np.arange(first[1], end[1]) + 0.5 - place.top) / place.scale).astype(int)
    seen = picture[np.clip(rows, 0, height - 1)][:, np.clip(columns, 0, width - 1)]
    return np.ascontiguousarray(seen), *first

"""A magnified picture, whose pixels are seen as squares: they are what a click picks.

imgui's backend filters every texture linearly, whatever the texture says. So the squares are computed here, for the
visible part of the picture, and drawn pixel by pixel.
"""

import math
from typing import NamedTuple

import numpy as np

NEAR = 1.5  # screen pixels per pixel of the picture, from which on they are squares


class Place(NamedTuple):
    """The place of a picture on the screen, and its panel, in pixels."""

    left: float
    top: float
    scale: float  # screen pixels per pixel of the picture
    panel: tuple[float, float, float, float]  # left, top, right, bottom


def magnify(picture: np.ndarray, place: Place) -> tuple[np.ndarray, int, int] | None:
    """(pixels, left, top): the part of a picture (height, width, 4) inside the panel, magnified; None if empty."""
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

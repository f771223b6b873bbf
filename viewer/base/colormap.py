"""Numbers to colours, on a logarithmic scale: dark for small, bright for large.

The scale goes from blue over red to yellow and gets lighter all the way, so that it also works in greyscale and with
any colour vision.
"""

import math

import numpy as np

from viewer.base.theme import MAP, Color, rgb_bytes

RANGES = {"error": (1e-4, 1e-1), "samples": (1, 256)}  # first and last value of the scale
STEPS = 256


def gradient(count: int) -> list[Color]:
    """`count` colours from the first to the last of the scale."""
    places = np.linspace(0.0, len(MAP) - 1.0, count)
    channels = [np.interp(places, range(len(MAP)), [color[k] for color in MAP]) for k in range(3)]
    return [(float(r), float(g), float(b), 1.0) for r, g, b in zip(*channels, strict=True)]


TABLE = np.array([(*rgb_bytes(color), 255) for color in gradient(STEPS)], np.uint8)


def colorize(values: np.ndarray, shows: str) -> np.ndarray:
    """8-bit sRGB (height, width, 4) of numbers (height, width). NaN gets the darkest colour."""
    low, high = RANGES[shows]
    with np.errstate(divide="ignore"):
        share = np.log(values / low) / math.log(high / low)
    place = np.clip(np.nan_to_num(share, nan=0.0, neginf=0.0, posinf=1.0), 0.0, 1.0)
    return TABLE[(place * (STEPS - 1)).astype(np.intp)]

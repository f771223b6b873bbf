"""Linear light to 8-bit sRGB (IEC 61966-2-1)."""

import numpy as np

from viewer.base.theme import Color

LUMINANCE = (0.2126, 0.7152, 0.0722)  # of sRGB's red, green and blue (Rec. 709)
BINS = 4096  # of linear light. More than the steepest slope, 255 * 12.92, so that no bin holds two borders


def linear(encoded: np.ndarray) -> np.ndarray:
    """Linear light of sRGB values, both in 0..1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


BORDERS = np.append(linear((np.arange(255) + 0.5) / 255.0), np.inf)  # between the 8-bit values k and k + 1
FIRST = np.searchsorted(BORDERS, np.arange(BINS + 1) / BINS, "right").astype(
    np.uint8
)  # the 8-bit value at a bin's start


def srgb(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB of linear RGB, clipped to 0..1. By table: a power per pixel takes longer than tracing simple rays."""
    x = np.fmin(np.fmax(linear, 0.0), 1.0)
    value = FIRST[(x * BINS).astype(np.intp)]
    return value + (x >= BORDERS[value])


def display_color(rgb: object) -> Color:
    """Linear RGB as a colour to be drawn."""
    r, g, b = (srgb(np.asarray(rgb, float)) / 255.0).tolist()
    return (r, g, b, 1.0)

"""Measures of the difference between two images. No single one is enough.

RMSE is the root mean square. MRSE is the mean square relative to the pixel, as in pbrt's imgtool: (v - r)^2 / (r +
0.01)^2. The largest difference of any component shows what means hide. FLIP (Andersson et al., Proc. ACM Comput.
Graph. 3(2), 2020), from 0 to 1, is the difference seen by a person who flips between the images.
"""

import math
from dataclasses import dataclass

import numpy as np

DARK = 0.01  # pbrt adds this to the reference, so that the darkest pixels do not dominate
MEASURES = {
    "rmse": "root mean square error",
    "mrse": "mean relative square error",
    "largest": "largest error",
    "flip": "FLIP, the visible error",
}


@dataclass(frozen=True)
class Errors:
    """The errors of one image. `flip` is NaN if its library is not installed."""

    rmse: float
    mrse: float
    largest: float
    flip: float


NOTHING = Errors(0.0, 0.0, 0.0, 0.0)


def errors(pixels: np.ndarray, reference: np.ndarray) -> Errors:
    """The errors of linear pixels (height, width, 3) against a reference of the same size."""
    off = pixels - reference
    return Errors(
        rmse(pixels, reference),
        float(np.mean(off**2 / (reference + DARK) ** 2)),
        float(np.abs(off).max()),
        flip(encoded(pixels), encoded(reference)),
    )


def rmse(pixels: np.ndarray, reference: np.ndarray) -> float:
    return math.sqrt(float(np.mean((pixels - reference) ** 2)))


def flip(shown: np.ndarray, reference: np.ndarray) -> float:
    """The mean FLIP of sRGB pixels in 0..1 (height, width, 3), at the library's default distance."""
    try:
        import flip_evaluator  # pyright: ignore[reportMissingImports]
    except ImportError:
        return math.nan
    _, mean, _ = flip_evaluator.evaluate(
        reference.astype(np.float32), shown.astype(np.float32), "LDR", applyMagma=False
    )
    return float(mean)


def encoded(linear: np.ndarray) -> np.ndarray:
    """sRGB in 0..1 (IEC 61966-2-1), not rounded to 8 bits."""
    clipped = np.clip(linear, 0.0, 1.0)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1.0 / 2.4) - 0.055)

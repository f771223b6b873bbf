"""How far an image is from another, in the measures that are usual: none of them tells all.

RMSE is the root of the mean square, MRSE the mean square relative to the pixel's own size as pbrt's imgtool has it,
(v - r)^2 / (r + 0.01)^2; the largest difference of any component finds what means hide; FLIP (Andersson et al., Proc.
ACM Comput. Graph. 3(2), 2020) is the difference that a person sees who flips between the two, from 0 to 1.
"""

import math
from dataclasses import dataclass

import numpy as np

DARK = 0.01  # what pbrt adds to the reference, lest the darkest pixels count for everything
MEASURES = {
    "rmse": "root mean square error",
    "mrse": "mean relative square error",
    "largest": "largest error",
    "flip": "FLIP, the error that is seen",
}


@dataclass(frozen=True)
class Errors:
    """Of one image; `flip` is NaN where its library is not installed."""

    rmse: float
    mrse: float
    largest: float
    flip: float


NOTHING = Errors(0.0, 0.0, 0.0, 0.0)


def errors(pixels: np.ndarray, reference: np.ndarray) -> Errors:
    """Of linear pixels (height, width, 3) against others of the same size."""
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
    """The mean over pixels in sRGB, 0..1 (height, width, 3), seen from the library's usual distance."""
    try:
        import flip_evaluator  # pyright: ignore[reportMissingImports]
    except ImportError:
        return math.nan
    _, mean, _ = flip_evaluator.evaluate(
        reference.astype(np.float32), shown.astype(np.float32), "LDR", applyMagma=False
    )
    return float(mean)


def encoded(linear: np.ndarray) -> np.ndarray:
    """What a screen is sent, 0..1 (IEC 61966-2-1), but not rounded."""
    clipped = np.clip(linear, 0.0, 1.0)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1.0 / 2.4) - 0.055)

"""Numbers as text, with no more digits than their rounding error leaves."""

import math
from collections.abc import Sequence

import numpy as np


def significant_digits(size: float, error: float) -> int:
    """The number of correct digits of a number with this size and this error, 0 to 17; 0 for an infinite number."""
    if error <= 0.0:
        return 17
    if not error < size < math.inf:
        return 0
    return min(17, math.floor(math.log10(size) - math.log10(error)))


def degree_decimals(error: float) -> int:
    """The number of correct decimals of an angle in degrees; -1 if even the whole degrees are uncertain.

    `error` is in radians.
    """
    wrong = math.degrees(error)
    return significant_digits(1.0, wrong) if wrong < 1.0 else -1


def number_text(x: float, error: float = 0.0) -> str:
    """Five digits, or as many as are correct; "?" for none. Empty for NaN."""
    if math.isnan(x):
        return ""
    digits = 5 if x == 0.0 else min(5, significant_digits(abs(x), error))
    return f"{x:.{digits}g}" if digits > 0 else "?"


def degrees_text(radians: float, error: float = 0.0) -> str:
    """An angle in degrees with two decimals, or as many as are correct; "?" for none. Empty for NaN."""
    if math.isnan(radians):
        return ""
    decimals = min(2, degree_decimals(error))
    return f"{math.degrees(radians):.{decimals}f}°" if decimals >= 0 else "?"


def color_decimals(error: float) -> int:
    """The number of correct decimals of a colour, up to 4; -1 for none."""
    if error <= 0.0:
        return 4
    return min(4, math.floor(-math.log10(error))) if error < 1.0 else -1


def rgb_text(rgb: Sequence[float] | np.ndarray, error: float = 0.0) -> str:
    """A colour with four decimals, or as many as are correct; "?" for none."""
    decimals = color_decimals(error)
    return " ".join(f"{x:.{decimals}f}" if decimals >= 0 else "?" for x in rgb)


def weight_text(rgb: Sequence[float] | np.ndarray, error: float = 0.0) -> str:
    """A weight: one number where its three components are equal."""
    return number_text(float(rgb[0]), error) if rgb[0] == rgb[1] == rgb[2] else rgb_text(rgb, error)

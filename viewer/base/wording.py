"""Numbers as people read them, in panels and labels: with a true minus sign, and a dash for an absent value."""

import math
from collections.abc import Sequence

import numpy as np

from tracer.tree.digits import color_decimals, degree_decimals, significant_digits

NO_DIGITS = "no digit left"  # for a number that is all rounding error


def format_number(x: float, digits: int = 5, error: float = 0.0) -> str:
    """A number with at most `digits` digits, and none that `error` makes uncertain; a dash for NaN."""
    if math.isnan(x):
        return "–"
    sure = digits if x == 0.0 else min(digits, significant_digits(abs(x), error))
    return f"{x:.{sure}g}".replace("-", "−") if sure > 0 else NO_DIGITS


def format_angle(radians: float, error: float = 0.0) -> str:
    """An angle in degrees, with no decimals that `error` makes uncertain."""
    if math.isnan(radians):
        return "–"
    decimals = min(2, degree_decimals(error))
    return f"{math.degrees(radians):.{decimals}f}°" if decimals >= 0 else NO_DIGITS


def format_point(xyz: Sequence[float] | np.ndarray, error: float = 0.0) -> str:
    """A point or a direction: five digits of its largest coordinate, or as many as `error` leaves, in a scene of any
    size.
    """
    size = max(abs(float(x)) for x in xyz)
    if math.isnan(size):
        return "–"
    exponent = math.floor(math.log10(size)) if size > 0.0 else 0
    decimals = min(4, significant_digits(size, error) - 1)
    if decimals < 0:
        return NO_DIGITS
    if -3 <= exponent <= 4:
        return format_rgb(xyz, min(4, max(0, decimals - exponent)))
    unit = 10.0**exponent
    return f"{format_rgb([float(x) / unit for x in xyz], decimals)}  ·10{str(exponent).translate(RAISED)}"


RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def format_rgb(xyz: Sequence[float] | np.ndarray, decimals: int = 4, gap: str = "  ") -> str:
    """Coordinates or a colour, with this `gap` between the numbers."""
    if math.isnan(xyz[0]):
        return "–"
    return gap.join(_fixed(x, decimals) for x in xyz)


def _fixed(x: float, decimals: int) -> str:
    """A number with a fixed number of decimals. A zero has no sign."""
    text = f"{x:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0.0 else text.replace("-", "−")


def format_color(rgb: Sequence[float] | np.ndarray, error: float) -> str:
    """A colour with four decimals, or as many as `error` leaves."""
    decimals = color_decimals(error)
    return format_rgb(rgb, decimals) if decimals >= 0 else NO_DIGITS


def format_weight(rgb: np.ndarray, error: float = 0.0) -> str:
    """One number if the three are equal, otherwise all of them; with no digits that `error` makes uncertain."""
    return format_number(float(rgb[0]), error=error) if rgb[0] == rgb[1] == rgb[2] else format_color(rgb, error)


def format_pair(first: str, second: str) -> str:
    """`first → second`, or only the first if there is no second."""
    return f"{first} → {second}" if second != "–" else first

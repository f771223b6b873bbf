"""Numbers as people read them, in panels and labels: a true minus sign, a dash for what is absent."""

import math
from collections.abc import Sequence

import numpy as np

from tracer.tree.digits import degree_decimals, significant_digits

NO_DIGITS = "no digit left"  # of a number that is all rounding error


def format_number(x: float, digits: int = 5, error: float = 0.0) -> str:
    """A number for people, with no digit that its error has made; a dash for what is absent."""
    if math.isnan(x):
        return "–"
    sure = digits if x == 0.0 else min(digits, significant_digits(abs(x), error))
    return f"{x:.{sure}g}".replace("-", "−") if sure > 0 else NO_DIGITS


def format_angle(radians: float, error: float = 0.0) -> str:
    """In degrees, with no more decimals than are sure."""
    if math.isnan(radians):
        return "–"
    decimals = min(2, degree_decimals(error))
    return f"{math.degrees(radians):.{decimals}f}°" if decimals >= 0 else NO_DIGITS


def format_point(xyz: Sequence[float] | np.ndarray, error: float = 0.0) -> str:
    """A point or a direction: five digits of its largest coordinate, or as many as are sure, in a scene of any size."""
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


def format_rgb(xyz: Sequence[float] | np.ndarray, decimals: int = 4) -> str:
    """Coordinates or a colour."""
    if math.isnan(xyz[0]):
        return "–"
    return "  ".join(_fixed(x, decimals) for x in xyz)


def _fixed(x: float, decimals: int) -> str:
    """So many decimals; what they show as nothing has no sign."""
    text = f"{x:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0.0 else text.replace("-", "−")


def format_weight(rgb: np.ndarray) -> str:
    """One number where the three are equal."""
    return format_number(float(rgb[0])) if rgb[0] == rgb[1] == rgb[2] else format_rgb(rgb, 4)


def format_pair(first: str, second: str) -> str:
    """`first → second`, or the first alone where there is no second."""
    return f"{first} → {second}" if second != "–" else first

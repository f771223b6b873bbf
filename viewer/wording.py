"""Numbers as people read them, in panels and labels: a true minus sign, a dash for what is absent."""

import math
from collections.abc import Sequence

import numpy as np

GONE = "no digit left"  # of a number that is all rounding error


def shown(x: float, digits: int = 5, error: float = 0.0) -> str:
    """A number for people, with no digit that its error has made; a dash for what is absent."""
    if math.isnan(x):
        return "–"
    if error > 0.0 and x != 0.0:
        digits = min(digits, _sure(abs(x), error))
    return f"{x:.{digits}g}".replace("-", "−") if digits > 0 else GONE


def angle(radians: float, error: float = 0.0) -> str:
    """In degrees, with no more decimals than are sure."""
    if math.isnan(radians):
        return "–"
    decimals = 2 if error == 0.0 else min(2, _sure(1.0, math.degrees(error)))
    return f"{math.degrees(radians):.{decimals}f}°" if error < 1.0 else GONE


def place(xyz: Sequence[float] | np.ndarray, error: float = 0.0) -> str:
    """A point or a direction: five digits of its largest coordinate, or as many as are sure, in a scene of any size."""
    size = max(abs(float(x)) for x in xyz)
    if math.isnan(size):
        return "–"
    exponent = math.floor(math.log10(size)) if size > 0.0 else 0
    decimals = 4 if error == 0.0 else min(4, _sure(size, error) - 1)
    if decimals < 0:
        return GONE
    if -3 <= exponent <= 4:
        return triple(xyz, min(4, max(0, decimals - exponent)))
    unit = 10.0**exponent
    return f"{triple([float(x) / unit for x in xyz], decimals)}  ·10{str(exponent).translate(RAISED)}"


RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _sure(size: float, error: float) -> int:
    """How many digits of a number of this size an error of that size leaves."""
    return max(0, math.floor(math.log10(size / error))) if error < size else 0


def triple(xyz: Sequence[float] | np.ndarray, decimals: int = 4) -> str:
    """Coordinates or a colour."""
    if math.isnan(xyz[0]):
        return "–"
    return "  ".join(f"{x:.{decimals}f}".replace("-", "−") for x in xyz)


def same(rgb: np.ndarray) -> str:
    """One number where the three are equal."""
    return shown(float(rgb[0])) if rgb[0] == rgb[1] == rgb[2] else triple(rgb, 4)


def pair(first: str, second: str) -> str:
    """`first → second`, or the first alone where there is no second."""
    return f"{first} → {second}" if second != "–" else first

"""Numbers as people read them, in panels and labels: a true minus sign, a dash for what is absent."""

import math
from collections.abc import Sequence

import numpy as np


def shown(x: float, digits: int = 5) -> str:
    """A number for people; a dash for what is absent."""
    if math.isnan(x):
        return "–"
    return f"{x:.{digits}g}".replace("-", "−")


def angle(radians: float) -> str:
    """In degrees."""
    return "–" if math.isnan(radians) else f"{math.degrees(radians):.2f}°"


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

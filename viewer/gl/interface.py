"""The lines of the interface at a hit (`viewer.figures.visible.interface`), for the 3D view."""

import numpy as np

from viewer.base.theme import HALO, Arrow, Theme
from viewer.figures.visible.interface import Hit, interface_curves
from viewer.gl.lines import line_rows


def interface_lines(hit: Hit, length: float, theme: Theme) -> np.ndarray:
    """The lines at a hit (n,) of LINE. `length` of the normal in the frame."""
    found = []
    for curve in interface_curves(hit, length, theme):
        stroke, arrow = curve.stroke, Arrow.FILLED if curve.arrow_at else Arrow.NONE
        rows = line_rows(
            curve.points[:-1], curve.points[1:], stroke.color, stroke.width, dash=stroke.dash, arrow=arrow.value
        )
        if curve.arrow_at:
            rows["at"] = curve.arrow_at
        found.append(rows)
    lines = np.concatenate(found)
    # Borders first: that of one corner of a curve must not cover the line before it.
    borders = lines.copy()
    borders["tint"][:, :3] = theme.ground[:3]
    borders["width"] += 1.5 * HALO
    borders["arrow"] = Arrow.NONE.value
    return np.concatenate([borders, lines])

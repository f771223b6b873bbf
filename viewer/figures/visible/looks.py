"""The colours of objects in the figure of the scene."""

import numpy as np

from tracer.scene import Material
from viewer.base.srgb import LUMINANCE, display_color
from viewer.base.theme import Color, Theme

PALE = 0.45  # share of the background's colour in an object's colour, so that rays stand out


def surface_look(material: Material, theme: Theme) -> Color:
    """An object's own colour, paler. A grey for one that only reflects."""
    strength = min(1.0, material.ambient + material.diffuse)
    color = np.array(material.color) * strength + 0.55 * min(1.0, material.reflect)
    encoded = np.array(display_color(color)[:3])
    if theme.mono:
        encoded = np.full(3, 0.55 + 0.45 * float(encoded @ LUMINANCE))
    r, g, b = ((1.0 - PALE) * encoded + PALE * np.array(theme.ground[:3])).tolist()
    return (r, g, b, 1.0)


def between(a: Color, b: Color) -> Color:
    red, green, blue, opacity = (0.5 * (x + y) for x, y in zip(a, b, strict=True))
    return (red, green, blue, opacity)

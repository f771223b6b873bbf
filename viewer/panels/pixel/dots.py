"""The points of the picked pixel's samples, as dots in an enlarged image. A click on one chooses the sample."""

import math

from imgui_bundle import imgui

from viewer.panels import draw as d
from viewer.session.session import Session

Place = tuple[float, float, float]  # left and top of the image on the screen, and the size of one of its pixels

LEAST_PIXEL = 40.0  # logical pixels: the side of a pixel from which on its dots are shown
REACH = 8.0  # logical pixels: the largest distance of a click from a dot
GROWN, RING = 2.5, 1.3  # logical pixels: by which the chosen dot is larger, and the width of its white ring
LARGEST, SMALLEST, CROWDED = 4.0, 1.4, 0.22  # radius in logical pixels; the share of a sample's part of the pixel


def draw_dots(session: Session, pad: imgui.ImDrawList, place: Place, hovered: int | None) -> None:
    """All dots in their true places; the chosen one larger and in the accent colour, that under the mouse larger."""
    spots = dots(session, place)
    if not spots or not session.world:
        return
    unit, theme = d.unit(), session.appearance.theme
    radius = min(LARGEST * unit, max(SMALLEST * unit, CROWDED * place[2] / math.sqrt(len(spots))))
    dark, bright = d.u32((0, 0, 0, 0.85)), d.u32((1, 1, 1, 1))
    chosen = session.sample.number(session.world.scene) or 0
    last = [chosen] if hovered is None else [hovered, chosen]  # above all others
    for k in [*(k for k in range(len(spots)) if k not in last), *last]:
        size = radius + (GROWN * unit if k in last else 0.0)
        pad.add_circle_filled(spots[k], size + 1.2 * unit, dark)
        pad.add_circle_filled(spots[k], size, bright)
        if k == chosen:
            pad.add_circle_filled(spots[k], size - RING * unit, d.u32(theme.accent))


def dot_at(session: Session, place: Place, mouse: imgui.ImVec2) -> int | None:
    """The sample whose dot is nearest to the mouse, if it is near and the mouse is inside the picked pixel."""
    left, top, scale = place
    spots = dots(session, place)
    if len(spots) < 2 or (math.floor((mouse.x - left) / scale), math.floor((mouse.y - top) / scale)) != session.pixel:
        return None
    distances = [math.hypot(x - mouse.x, y - mouse.y) for x, y in spots]
    nearest = min(range(len(spots)), key=distances.__getitem__)
    return nearest if distances[nearest] <= REACH * d.unit() else None


def dots(session: Session, place: Place) -> list[tuple[float, float]]:
    """The dots of the picked pixel on the screen, by sample; none while a pixel is small."""
    left, top, scale = place
    if not session.world or not session.pixel or scale < LEAST_PIXEL * d.unit():
        return []
    return [(left + scale * x, top + scale * y) for x, y in session.sample.points(session.world.scene, session.pixel)]

"""The rays as they cross the 3D view, so that texts can keep off them."""

from collections.abc import Callable, Sequence

import numpy as np

from tracer.kernel.nodes import SHADOW
from viewer.base.theme import LABEL_TEXT
from viewer.figures.font import text_box
from viewer.figures.marks import Piece, Point, clip_shares, widened
from viewer.figures.ray_lines import RayLines

SAMPLES = 33  # points of a ray at which it is tested whether it is in the view
MOST = 60  # rays that texts keep off: the first ones of the tree
ROOM = 5.0  # logical pixels between a text and the middle of a ray

Spot = tuple[Point, str]  # the position of a text, and its anchor
At = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]  # (places (n, 2), whether they are in the view) of points


def ray_pieces(lines: RayLines, at: At) -> list[Piece]:
    """The part of each ray that is in the view, without shadow rays. `at` projects points (n, 3) of the frame."""
    rays = np.flatnonzero(lines.kinds != SHADOW)[:MOST]
    shares = np.linspace(0.0, 1.0, SAMPLES)[None, :, None]
    points = lines.starts[rays, None] + shares * (lines.ends - lines.starts)[rays, None]
    places, inside = at(points.reshape(-1, 3))
    places, inside = places.reshape(-1, SAMPLES, 2), inside.reshape(-1, SAMPLES)
    found: list[Piece] = []
    for k in np.flatnonzero(inside.any(axis=1)).tolist():
        (x0, y0), (x1, y1) = places[k][inside[k]][[0, -1]].tolist()
        found.append(((x0, y0), (x1, y1)))
    return found


def clear_first(spots: Sequence[Spot], content: str, pieces: Sequence[Piece]) -> list[Spot]:
    """The spots in their order, but first those at which a text covers none of these pieces."""

    def covers(spot: Spot) -> bool:
        box = widened(text_box(spot[0], content, LABEL_TEXT, spot[1]), ROOM)
        return any(clip_shares(piece, box) is not None for piece in pieces)

    return sorted(spots, key=covers)

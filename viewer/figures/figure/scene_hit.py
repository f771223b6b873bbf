"""The selected hit in a figure of the scene, as in the 3D view: normal, angles, media, critical cone."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from viewer.base.theme import HALO, HIDDEN, LABEL_TEXT, Arrow, Theme, faded
from viewer.figures.layout.label_placement import LabelPlacer, Spot
from viewer.figures.marks import Line, Mark, Piece, Point, Stroke, clipped
from viewer.figures.steps import Step
from viewer.figures.visible.interface import Curve, Name, hit_of, interface_curves, interface_names
from viewer.figures.visible.scene_view import NEAR, SceneView

LIFT = 1e-3  # from the surface towards the ray: there it is tested whether the hit is seen


@dataclass(frozen=True)
class SceneHit:
    """The lines and the names of a hit."""

    curves: tuple[Curve, ...]
    names: tuple[Name, ...]
    opacity: float

    @staticmethod
    def of(view: SceneView, step: Step, row: int, size: float, theme: Theme) -> "SceneHit | None":
        """The interface at the end of a ray, for a text size; None if there is none in front of the camera."""
        hit = hit_of(step.tree, row, view.frame, step)
        point = view.point_size(hit.foot) * size / LABEL_TEXT if hit else 0.0
        if hit is None or not point > 0.0:
            return None
        length = hit.length(point)
        names = interface_names(hit, length, hit.is_small(length, point))
        opacity = HIDDEN if view.hidden(hit.foot + LIFT * length * hit.normal) else 1.0
        return SceneHit(tuple(interface_curves(hit, length, theme)), tuple(names), opacity)

    def marks(self, view: SceneView, theme: Theme, share: float) -> list[Mark]:
        """The lines, with borders below all of them. `share` is the factor of their widths."""
        borders: list[Mark] = []
        lines: list[Mark] = []
        for curve in self.curves:
            stroke = curve.stroke
            ink = Stroke(faded(stroke.color, self.opacity), stroke.width, stroke.dash)
            border = Stroke(faded(theme.ground, ink.color[3]), stroke.width + 1.5 * HALO, stroke.dash)
            room = 0.5 * share * border.width
            for piece in _pieces(view, curve.points, room):
                arrow = Arrow.FILLED if curve.arrow_at else Arrow.NONE
                borders.append(Line("interface", *piece, border))
                lines.append(Line("interface", *piece, ink, arrow, curve.arrow_at or 0.5))
        return [*borders, *lines]

    def labels(self, view: SceneView, placer: LabelPlacer, theme: Theme) -> list[tuple[Name, list[Mark]]]:
        """The names with their marks, as far as there is room."""
        found: list[tuple[Name, list[Mark]]] = []
        for name in self.names:
            places = [view.place(point) for point in name.points]
            spots = [Spot(at, upon=True) for at in places if at] + [Spot(at) for at in places[:1] if at]
            color = theme.normal if name.of_normal else theme.text
            found.append((name, placer.label("interface", name.content, spots, color)))
        return found


def _pieces(view: SceneView, points: np.ndarray, room: float) -> list[Piece]:
    """The segments of a curve (n, 3) on the canvas, as far as they are inside the figure by so much."""
    places, depths = view.at(points)
    left, top, right, bottom = view.where
    box = (left + room, top + room, right - room, bottom - room)
    found = []
    corners: list[Point] = [(x, y) for x, y in places.tolist()]
    for (a, near), (b, far) in pairwise(zip(corners, depths.tolist(), strict=True)):
        if near <= NEAR or far <= NEAR:
            continue
        if piece := clipped((a, b), box):
            found.append(piece)
    return found

"""The test whether a point lies in a polygon or a triangle, in the projection along the normal's longest axis.

A ray from the point to the side crosses the outline of a polygon an odd number of times if the point is inside. In a
triangle, the barycentric coordinates of a point are the shares of three triangles in the area.
"""

import numpy as np

from viewer.base.theme import faded
from viewer.explain.intersection import (
    Flat,
    barycentric,
    flattened,
    format_share,
    hit_face,
    inside_section,
    plane_point,
    shape_tested,
    verdict,
)
from viewer.figures.marks import Disc, Line, Mark, Point, Rectangle, Shape, Stroke, widened
from viewer.lessons.live.labels import Labels
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters

KINDS = ("reflection", "refraction", "shadow")  # whose colours the three triangles have
MARGIN = 1.3  # around the outline, in text sizes
DOT = 0.28  # radius of a point, in text sizes
BEYOND = 0.06  # length of the ray beyond the outline, as a share of its width
TINT = 0.3


def inside_piece(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The picture and the numbers of the hit, or of the point where the ray meets the plane of the parameter `object`.
    ValueError for a shape without straight sides, and where the ray does not meet its plane.
    """
    tree, name, number = context.tested("inside", parameters)
    corners, met = hit_face(tree, context.row, number), plane_point(tree, context.row, number)
    section = inside_section(tree, context.row, number)
    if corners is None:
        shape = shape_tested(tree, context.row, number)
        found = shape.name if shape else "background"
        raise ValueError(f"inside: {name} is a {found}; it needs a hit on a polygon, a triangle or a mesh")
    if met is None or section is None:
        raise ValueError(f"inside: {tree.label(context.row)} does not meet the plane of {name}")
    flat = flattened(corners, met[1])
    if len(corners) == 3:
        shares = barycentric(corners, met[1])
        brief = ", ".join(f"{letter} = {format_share(share)}" for letter, share in zip("αβγ", shares, strict=True))
        picture, text = lay_out(context, [section], [f"{brief}, sum {format_share(sum(shares))}", brief])
        return [*_Picture(flat, picture, context).triangle(shares), *text]
    count = len(flat.crossings())
    picture, text = lay_out(context, [section], [f"sides crossed: {verdict(count)}", verdict(count)])
    return [*_Picture(flat, picture, context).polygon(), *text]


class _Picture:
    def __init__(self, flat: Flat, where: Rectangle, context: LiveContext) -> None:
        self.flat, self.where, self.size, self.theme = flat, where, context.size, context.theme
        left, top, right, bottom = widened(where, -MARGIN * self.size)
        outline = np.array([*flat.outline, flat.point])
        low, high = outline.min(axis=0), outline.max(axis=0)
        self.high, self.wide = float(high[0]), float(high[0] - low[0])
        high = high + np.array([2.0 * BEYOND * self.wide, 0.0])
        self.scale = min((right - left) / float(high[0] - low[0]), (bottom - top) / float(high[1] - low[1]))
        self.middle, self.center = (low + high) / 2.0, (0.5 * (left + right), 0.5 * (top + bottom))
        self.corners = tuple(map(self.at, flat.outline))
        self.p = self.at(flat.point)

    def at(self, place: Point) -> Point:
        x, y = place
        return (
            self.center[0] + self.scale * (x - float(self.middle[0])),
            self.center[1] - self.scale * (y - float(self.middle[1])),
        )

    def _dot(self, name: str, at: Point, hollow: bool = False) -> Disc:
        fill = self.theme.ground if hollow else self.theme.accent
        return Disc(name, at, DOT * self.size, fill, Stroke(self.theme.accent, 2.0))

    def polygon(self) -> list[Mark]:
        """The outline, and a ray from the point to the side with its crossings numbered."""
        theme, size = self.theme, self.size
        end = self.at((self.high + 2.0 * BEYOND * self.wide, self.flat.point[1]))
        places = [self.at(place) for place in self.flat.crossings()]
        marks: list[Mark] = [
            Shape("face", self.corners, faded(theme.glass, 0.2), Stroke(theme.text, 2.0)),
            Line("ray", self.p, end, Stroke(theme.accent, 2.2, (6.0, 4.0)), title="to the side"),
            self._dot("point", self.p),
            *(self._dot(f"crossing-{k}", place, hollow=True) for k, place in enumerate(places)),
        ]
        sides = Shape("side", self.corners, None, Stroke(theme.text, 2.0))
        labels = Labels(self.where, size, theme, [sides, *marks[1:]])
        labels.beside("point", ["p"], self.p, theme.text, most=1)
        for k, place in enumerate(places):
            labels.beside(f"crossing-{k}", [str(k + 1)], place, theme.accent)
        return [*marks, *labels.marks]

    def triangle(self, shares: tuple[float, float, float]) -> list[Mark]:
        """Three triangles, each opposite of the corner whose coordinate is its share of the area."""
        theme, size = self.theme, self.size
        marks: list[Mark] = []
        middles = []
        for k, (kind, letter) in enumerate(zip(KINDS, "αβγ", strict=True)):
            part = (self.p, self.corners[(k + 1) % 3], self.corners[(k + 2) % 3])
            title = f"{letter} = {format_share(shares[k], 4)}"
            marks.append(
                Shape(f"part-{k}", part, faded(theme.ray(kind), TINT), Stroke(theme.ray(kind), 1.4), title=title)
            )
            middles.append((sum(x for x, _ in part) / 3.0, sum(y for _, y in part) / 3.0))
        marks.append(Shape("face", self.corners, None, Stroke(theme.text, 2.0)))
        marks.append(self._dot("point", self.p))
        sides = [Line("side", self.p, corner, Stroke(theme.text, 1.0)) for corner in self.corners]
        labels = Labels(self.where, size, theme, [*sides, marks[-2], marks[-1]])
        for corner, letter in zip(self.corners, "abc", strict=True):
            labels.beside("corner", [letter], corner, theme.text)
        for k, letter in enumerate("αβγ"):
            words = [f"{letter} = {format_share(shares[k])}", letter]
            labels.place(f"part-{k}", words, [(middles[k], "middle")], theme.text)
        labels.beside("point", ["p"], self.p, theme.text)
        return [*marks, *labels.marks]

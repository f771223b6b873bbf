"""Arrows in the plane of incidence of a hit, drawn as the scene is seen from the side: up is up, x runs to the right.

So the picture has the sides of a scene whose rays lie in the plane of x and y, also where the normal points aside. In a
level plane of incidence the normal points up, and the ray comes from the left.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from viewer.base.theme import Arrow, Color, Theme, faded
from viewer.explain.turned import along_surface
from viewer.figures.font import text_width
from viewer.figures.marks import Line, Mark, Point, Rectangle, Shape, Stroke
from viewer.lessons.live.labels import Labels

STEEP = 0.35  # least length of the projection of the scene's upward direction onto the plane
RIGHTWARDS = np.array([1.0, 0.0, -1e-6])  # x; without it, -z, which runs to the right if seen from x
BODY = 0.7  # width of the band behind the surface, in text sizes
TINT = 0.12  # its opacity
APART = 1e-6  # the least component out of the plane of a vector of length 1 that is said
ROOM = (1.5, 1.3)  # around the tips, for their names, in text sizes: beside and above


@dataclass(frozen=True)
class Vector:
    """An arrow from one place to another, each (along the surface, along the normal) in units of a ray's direction."""

    name: str  # of the mark
    words: str  # beside its tip, or beside its middle if it ends where another does
    start: Point
    end: Point
    ink: Color
    dash: tuple[float, float] = (0.0, 0.0)
    title: str = ""
    at: float = 1.0  # the share of its length at which the words stand


@dataclass(frozen=True)
class Drawn:
    """A drawing of arrows. `at` is the point of the picture at a place of the plane."""

    arrows: list[Mark]
    labels: Labels
    at: Callable[[Point], Point]

    @property
    def marks(self) -> list[Mark]:
        return [*self.arrows, *self.labels.marks]


class SideView:
    """The plane of a ray's direction and a normal, both (3,) and of length 1; `up` is the scene's upward direction."""

    def __init__(self, direction: np.ndarray, normal: np.ndarray, up: Sequence[float]) -> None:
        self.normal, self.along = np.array(normal), along_surface(direction, normal)
        self.across: Point = (1.0, 0.0)  # the direction along the surface in the picture, with y upwards
        self.upwards: Point = (0.0, 1.0)  # that of the normal
        high = np.array([self.along @ up, self.normal @ up]) / np.linalg.norm(up)
        length = float(np.linalg.norm(high))
        if length >= STEEP:
            a, n = (high / length).tolist()
            rightwards = n * self.along - a * self.normal
            hand = 1.0 if rightwards @ RIGHTWARDS >= 0.0 else -1.0
            self.across, self.upwards = (hand * n, a), (-hand * a, n)

    def flat(self, vector: np.ndarray) -> Point:
        """The part of a vector (3,) in the plane: along the surface, and along the normal."""
        return float(vector @ self.along), float(vector @ self.normal)

    def rotated(self, vector: np.ndarray) -> Point:
        """A vector (3,) rotated about the normal into the plane, to the side that it is on."""
        along, above = self.flat(vector)
        beside = math.sqrt(max(0.0, float(vector @ vector) - above * above))
        return math.copysign(beside, along), above

    def seen(self, place: Point) -> Point:
        """A place of the plane in the picture, to the right and downwards."""
        s, n = place
        return s * self.across[0] + n * self.upwards[0], -(s * self.across[1] + n * self.upwards[1])

    def draw(
        self, vectors: Sequence[Vector], where: Rectangle, size: float, theme: Theme, fixed: Sequence[Point] = ()
    ) -> "Drawn":
        """The surface and these arrows, as large as there is room for them and for these other places."""
        left, top, right, bottom = where
        ends = [self.seen(place) for v in vectors for place in (v.start, v.end)]
        ends += [self.seen(place) for place in ((0.0, 0.0), *fixed)]
        low, high = np.min(ends, axis=0), np.max(ends, axis=0)
        wide, tall = np.maximum(high - low, 1e-9).tolist()
        aside = max((text_width(v.words, size) + size for v in vectors if v.at < 1.0), default=0.0)
        aside = max(aside, ROOM[0] * size)
        scale = min((right - left - 2.0 * aside) / wide, (bottom - top - 2.0 * ROOM[1] * size) / tall)
        scale = max(scale, size)
        middle = 0.5 * (low + high)
        foot = (0.5 * (left + right) - scale * middle[0], 0.5 * (top + bottom) - scale * middle[1])

        def at(place: Point) -> Point:
            x, y = self.seen(place)
            return foot[0] + scale * x, foot[1] + scale * y

        marks = self._surface(foot, where, size, theme)
        tips: list[tuple[Vector, Point, Point]] = []
        for v in vectors:
            start, end = at(v.start), at(v.end)
            if math.dist(start, end) > 1.0:
                marks.append(Line(v.name, start, end, Stroke(v.ink, 2.2, v.dash), Arrow.FILLED, 0.97, title=v.title))
                tips.append((v, start, end))
        labels = Labels(where, size, theme, marks)
        for v, start, end in tips:
            if v.words:
                labels.place(v.name, [v.words], list(_beside(start, end, v.at, size)), v.ink)
        return Drawn(marks, labels, at)

    def note(self, drawn: "Drawn", vector: np.ndarray, letter: str, where: Rectangle, theme: Theme) -> None:
        """Say in a corner that a vector (3,) was rotated into the plane, if it was not in it."""
        if abs(float(np.cross(self.along, self.normal) @ vector)) <= APART:
            return
        left, top, right, bottom = where
        inset = 0.6 * drawn.labels.size
        corners = [
            ((x, y), side) for y in (top + inset, bottom - inset) for x, side in ((left, "start"), (right, "end"))
        ]
        words = [f"{letter} rotated into this plane", f"{letter} rotated"]
        drawn.labels.place("note", words, corners, theme.muted)

    def _surface(self, foot: Point, where: Rectangle, size: float, theme: Theme) -> list[Mark]:
        """The line of the surface through the whole room, and a band of the body behind it."""
        left, top, right, bottom = where
        dx, dy = self.seen((1.0, 0.0))
        nx, ny = self.seen((0.0, -1.0))
        reach = [
            min((right - foot[0] if dx * sign > 0 else foot[0] - left) / abs(dx) if abs(dx) > 1e-9 else math.inf,
                (bottom - foot[1] if dy * sign > 0 else foot[1] - top) / abs(dy) if abs(dy) > 1e-9 else math.inf)
            for sign in (-1.0, 1.0)
        ]  # fmt: skip
        a, b = (foot[0] - reach[0] * dx, foot[1] - reach[0] * dy), (foot[0] + reach[1] * dx, foot[1] + reach[1] * dy)
        corners = (a, b, *((x + BODY * size * nx, y + BODY * size * ny) for x, y in (b, a)))
        inner = tuple((min(max(x, left), right), min(max(y, top), bottom)) for x, y in corners)
        return [
            Shape("body", inner, faded(theme.text, TINT), None),
            Line("surface", a, b, Stroke(theme.text, 2.2)),
        ]


def _beside(start: Point, end: Point, share: float, size: float) -> Iterable[tuple[Point, str]]:
    """Places of a name: beyond the tip of an arrow, or on either side of a place within it."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    far = math.hypot(dx, dy)
    dx, dy = dx / far, dy / far
    x, y = start[0] + share * far * dx, start[1] + share * far * dy
    if share >= 1.0:
        for ahead, aside in ((0.8, 0.0), (0.7, 0.7), (0.7, -0.7), (0.0, 1.0), (0.0, -1.0), (0.8, 1.6), (0.8, -1.6)):
            yield (x + size * (ahead * dx - aside * dy), y + size * (ahead * dy + aside * dx)), "middle"
        return
    for aside in (0.6, -0.6, 1.0, -1.0):
        at = (x - aside * size * dy, y + aside * size * dx)
        yield at, "middle" if abs(dy) < 0.5 else "start" if at[0] > x else "end"

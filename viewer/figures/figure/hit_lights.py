"""The rays to lights in the figure of a hit: dashed, at their true angles from the normal; for many lights, and in
a small picture, a line of words.
"""

import math
from collections.abc import Sequence

from tracer.kernel.nodes import SHADOW
from viewer.base.theme import STYLES, Theme
from viewer.base.wording import format_angle
from viewer.figures import signs
from viewer.figures.labels import ray_label, ray_title
from viewer.figures.layout.formula_column import LINE
from viewer.figures.layout.hit_frame import HitFrame, is_free
from viewer.figures.layout.label_placement import LabelPlacer, Spot
from viewer.figures.lights import (
    MOST_LIGHTS,
    counted,
    fate_of,
    light_title,
    light_words,
    shadow_rays,
    turn_to_light,
)
from viewer.figures.marks import (
    Formula,
    Line,
    Mark,
    Piece,
    Point,
    Rectangle,
    Stroke,
    Text,
    clip_shares,
    point_along,
    widened,
)
from viewer.figures.picking import distance
from viewer.figures.steps import Step

REACHES = (0.6, 0.77, 0.46, 1.14, 0.31)  # lengths of rays to lights, in lengths of other rays; the first that fits
LEAST = 5.0  # length of other rays, in text sizes, below which a line of words stands for the rays to lights
SIGN = 0.6  # half the width that is kept free for the sign of a light, in text sizes
IN_PLANE = math.radians(1.0)  # a light that is out of the plane by less counts as in it


class HitLights:
    """The rays to lights from one hit, of those among `below`, the rays that it sends out."""

    def __init__(
        self, step: Step, node: int, below: Sequence[int], frame: HitFrame, reach: float, size: float, theme: Theme
    ) -> None:
        self.tree, self.node, self.frame, self.size, self.theme = step.tree, node, frame, size, theme
        self.reaches = [share * reach for share in REACHES]
        shadows = [child for child in below if self.tree.nodes["kind"][child] == SHADOW]
        is_small = reach < LEAST * size
        self.many = shadows if is_small or len(shadow_rays(self.tree, node)) > MOST_LIGHTS else []
        # Of each light that is drawn: its angle from the normal, and that out of the plane, into which it is rotated.
        self.turns = {child: turn_to_light(self.tree, child) for child in shadows if not self.many}

    @property
    def rotated(self) -> bool:
        """Whether a light lies outside the plane."""
        return any(out > IN_PLANE for _, out in self.turns.values())

    def stubs(self) -> list[Piece]:
        """The rays to lights at the shortest distance of a light."""
        return [(self.frame.center, self.frame.at(turn, min(self.reaches))) for turn, _ in self.turns.values()]

    def keeps_clear(self, box: Rectangle) -> bool:
        """Whether the shortest rays to lights, with their signs, stay outside a box."""
        near = widened(box, SIGN * self.size)
        return not any(clip_shares(stub, near) for stub in self.stubs())

    def draw(self, others: Sequence[Mark]) -> list[Mark]:
        """The marks, among the other marks of the picture."""
        names = LabelPlacer(self.frame.picture, self.size, self.theme)
        names.taken += [mark.box() for mark in others if isinstance(mark, (Text, Formula))]
        names.ways += [(mark.name, piece) for mark in others if isinstance(mark, Line) for piece in mark.pieces()]
        found = self._words(names) if self.many else []
        words, rays = list(names.taken), [mark for mark in others if isinstance(mark, Line)]
        ends: dict[int, Point] = {}
        for child, (turn, _) in self.turns.items():
            ends[child] = self._end(turn, names, words, rays)
            names.take(ends[child], 0.9 * self.size)
        names.ways += [(f"ray-{child}", (self.frame.center, end)) for child, end in ends.items()]
        color = self.theme.ray("shadow")
        for child, end in ends.items():
            name, fate = f"ray-{child}", fate_of(self.tree, child)
            title = ray_title(self.tree, child)
            out = self.turns[child][1]
            title += f"; it is out of this plane by {format_angle(out)} and rotated into it" if out > IN_PLANE else ""
            stroke = Stroke(color, STYLES["shadow"].width, fate.dash)
            center = self.frame.center
            stop = point_along((center, end), 1.0 - 0.5 * self.size / math.dist(center, end))  # up to the sign
            found.append(Line(name, center, stop, stroke, title=title))
            found += signs.light_end(fate.name, name, end, self.size, self.theme)
            taken = list(names.taken)
            label = names.label(name, ray_label(self.tree, child), [Spot(end)], color, most=0)
            leaders = [(mark.start, mark.end) for mark in label if isinstance(mark, Line)]
            if all(is_free(box, (), leaders) for box in taken):
                found += label
        return found

    def _end(self, turn: float, names: LabelPlacer, words: Sequence[Rectangle], rays: Sequence[Line]) -> Point:
        """The end point of a ray to a light: at the first of the lengths that is free of marks and rays; else, of those
        that are free of texts, at the one that is farthest from the rays; else at the shortest.
        """
        center = self.frame.center
        ends = [self.frame.at(turn, reach) for reach in self.reaches]
        free = []
        for end in ends:
            box = widened((*end, *end), SIGN * self.size)
            if names.free(box) and not any(clip_shares((center, end), other) for other in words):
                free.append(end)
                if not any(clip_shares((ray.start, ray.end), box) for ray in rays):
                    return end
        return max(free, key=lambda end: min(distance(ray, end) for ray in rays), default=ends[-1])

    def _words(self, names: LabelPlacer) -> list[Mark]:
        """The line that stands for the rays to many lights."""
        size = self.size
        x0, top, x1, bottom = self.frame.picture
        left, right = x0 + 0.5 * size, x1 - 0.5 * size
        words = light_words(counted(self.tree, self.many))

        def places(high: float) -> list[tuple[Point, str]]:
            """In the upper medium, then in the lower one, below or above what stands in the corners."""
            upper, low = top + (0.9 + 3 * LINE) * size, bottom - 0.9 * size - high
            uppers = [((left, upper), "start"), ((right, upper - LINE * size), "end")]
            lowers = [((left, low - k * LINE * size), "start") for k in (1, 2)]
            return [*uppers, *lowers, *(((right, low - k * LINE * size), "end") for k in (0, 1, 2))]

        title = light_title(self.tree, self.many)
        text = Text(f"lights-{self.node}", self.frame.center, "", size, self.theme.ray("shadow"), title=title)
        widths = (right - left, self.frame.center[0] - left - size, 0.0)
        return names.paragraph(text, [f"L: {words[0]}", *words[1:]], widths, LINE * size, places)

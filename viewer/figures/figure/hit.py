"""One hit in its plane of incidence: the normal, the incoming ray, the rays sent out, true angles, and the lecture's
formulas with this hit's numbers.

As on the slide, the normal points up, on the side of the incoming ray, which comes from the left. A light rarely
lies in this plane: it is drawn at its true angle from the normal, rotated into the plane.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.theme import STYLES, Theme, faded
from viewer.base.values import STEEPEST_INCIDENCE
from viewer.base.wording import format_number
from viewer.explain.formulas import Lecture
from viewer.explain.lighting import local_light
from viewer.explain.scattering import scattering_sections
from viewer.figures import signs
from viewer.figures.figure.hit_corners import HitCorners
from viewer.figures.figure.hit_lights import HitLights
from viewer.figures.font import fitted, text_width
from viewer.figures.labels import hit_label, ray_title
from viewer.figures.layout.formula_column import LINE, formula_columns
from viewer.figures.layout.hit_frame import BESIDE, arc_radius, has_room, hit_frame, is_free
from viewer.figures.layout.sizes import NO_RAY
from viewer.figures.lights import MOST_LIGHTS, ray_dash
from viewer.figures.marks import (
    HEIGHT,
    WIDTH,
    Formula,
    Handle,
    Line,
    Mark,
    Point,
    Rectangle,
    Shape,
    Stroke,
    Text,
    clip_shares,
    widened,
    within,
)
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Pages, Subject

LARGEST = 20.0  # points, of an exported figure
TINTS = (0.06, 0.16)  # of the medium with the lower and with the higher index
FULL, THINNEST = 150.0, 0.6  # length of rays with full line width, in points; least share of it, for shorter ones
ARROW = 0.66  # distance of an arrow from the hit, in lengths of rays
NORMAL = 1.08  # length of the normal, the same
NO_RAY_WORDS = ("no T: total internal reflection", "no T: total reflection")  # the longest that fits
SYMBOL = 1.15  # size of a symbol in the picture, in text sizes


def pages(subject: Subject, style: FigureStyle) -> Pages:
    """One hit in its plane of incidence. The page is empty before the step with the hit."""
    if style.text_size > LARGEST:
        raise ValueError(f"a hit has room for text of {LARGEST:g} points at most, got {style.text_size:g}")
    return [_marks(step, style, subject.world) if style.node in step.rows else [] for step in subject.steps]


def _marks(step: Step, style: FigureStyle, world: World | None) -> list[Mark]:
    return hit_marks(step, style.node, style.text_size, style.theme, world, style.canvas, style.is_turned)


def hit_marks(
    step: Step,
    node: int,
    size: float,
    theme: Theme,
    world: World | None = None,
    where: Rectangle = (0.0, 0.0, WIDTH, HEIGHT),
    is_turned: bool = False,
) -> list[Mark]:
    """The marks of a hit, laid out for a rectangle and a text size. `node` is its row (`hit_row`). Without a `world`,
    the local term has no numbers. A ray that `is_turned` by hand is none of the pixel's tree, and has no label.

    The incoming ray ends in the handle `turn`: the angle of incidence in degrees.
    """
    return _Drawing(step, node, size, theme, world, where, is_turned).marks


class _Drawing:
    def __init__(
        self, step: Step, node: int, size: float, theme: Theme, world: World | None, where: Rectangle, is_turned: bool
    ) -> None:
        self.tree: RayTree = step.tree
        self.step, self.node, self.size, self.theme, self.world = step, node, size, theme, world
        self.row = self.tree.nodes[node]
        self.below = [child for child in self.tree.children[node] if child in step.rows]
        self.going_on = [child for child in self.below if self.tree.nodes["kind"][child] != SHADOW]
        self.theta1, self.theta2 = float(self.row["theta1"]), float(self.row["theta2"])
        self.least = min(self.theta1, math.inf if math.isnan(self.theta2) else self.theta2)  # of the two angles
        self.frame = hit_frame(where, size)
        self.corners = HitCorners(self.tree, node, self.going_on, self.frame, size, theme, is_turned)
        self.left, self.right, self.low = self.corners.left, self.corners.right, self.corners.last
        self.marks: list[Mark] = [*self.corners.marks]
        self._media()
        self.taken = [mark.box() for mark in self.marks if isinstance(mark, Text)]
        turns = [0.0, math.pi, -self.theta1, *map(self._turn, self.going_on)]
        self.reach = self.frame.reach(turns, self.taken, size)
        self.share = min(1.0, max(THINNEST, self.reach / FULL))  # of line widths
        self._normal()
        self._rays()
        self.lights = HitLights(self.step, node, self.below, self.frame, self.reach, size, theme)
        self._no_ray()
        self._name()
        lights = self.lights.draw(self.marks)
        self.marks = [*self._uncrossed(lights), *lights]
        self._formulas()
        self._handle()

    def _handle(self) -> None:
        """The handle at the start of the incoming ray."""
        degrees, color = math.degrees(self.theta1), self.theme.ray(self.tree.kind(self.node))
        path = tuple(self.frame.at(-math.radians(angle), self.reach) for angle in range(int(STEEPEST_INCIDENCE) + 1))
        title = "drag to turn the ray"
        self.marks.append(Handle("turn", degrees, (0.0, STEEPEST_INCIDENCE), path, color, title=title))

    def _turn(self, child: int) -> float:
        """The direction of a ray that is sent out, clockwise from the normal."""
        return math.pi - self.theta2 if self.tree.kind(child) == "refraction" else self.theta1

    def _media(self) -> None:
        n1, n2 = float(self.row["n1"]), float(self.row["n2"])
        clear = not math.isnan(n2)
        (x0, top, x1, bottom), y = self.frame.picture, self.frame.center[1]
        below = TINTS[n2 > n1] if clear else 0.3
        above = TINTS[n1 > n2] if clear else TINTS[0]
        under = f"n₂ = {format_number(n2)}" if clear else "opaque"
        behind = f"the medium behind the surface, index {format_number(n2)}" if clear else "behind the opaque surface"
        grounds = []
        for name, first, last, tint, title in (
            ("medium-1", top, y, above, f"the medium the ray comes from, index {format_number(n1)}"),
            ("medium-2", y, bottom, below, behind),
        ):
            corners = ((x0, first), (x1, first), (x1, last), (x0, last))
            grounds.append(Shape(name, corners, faded(self.theme.text, tint), None, title=title))
        self.marks[:0] = grounds
        for name, y, words in (
            ("medium-1", self.corners.third, f"n₁ = {format_number(n1)}"),
            ("medium-2", self.low, under),
        ):
            self.marks.append(Text(name, (self.left, y), words, self.size, self.theme.text, "start"))

    def _normal(self) -> None:
        (x, y), color, size = self.frame.center, self.theme.normal, SYMBOL * self.size
        room = y - self.frame.picture[1] - 1.3 * self.size
        top, bottom = self.frame.at(0.0, min(NORMAL * self.reach, room)), self.frame.at(math.pi, 0.9 * self.reach)
        self.marks.append(
            Line("normal", (x, y), top, Stroke(color, 2.0 * self.share), STYLES["refraction"].arrow, 0.97)
        )
        self.marks.append(Line("normal", (x, y), bottom, Stroke(color, 1.4, (5.0, 5.0))))
        self._symbol(Formula("normal", Lecture.NORMAL, (x, top[1] - 0.35 * self.size), size, color))

    def _rays(self) -> None:
        tree, node, (x, y) = self.tree, self.node, self.frame.center
        self._ray(node, self.frame.at(-self.theta1, self.reach), (x, y), 1.0 - ARROW)
        for child in self.going_on:
            self._ray(child, (x, y), self.frame.at(self._turn(child), self.reach), ARROW)
        self._angle(f"ray-{node}", -self.theta1, 0.0, tree.kind(node), Lecture.THETA_1)
        self._vector(node, -self.theta1, -1, Lecture.INCOMING)
        for child in self.going_on:
            name, kind, turn = f"ray-{child}", tree.kind(child), self._turn(child)
            if kind == "refraction":
                self._angle(name, turn, math.pi, kind, Lecture.THETA_2)
                self._vector(child, turn, -1, Lecture.REFRACTED)
            else:
                self._angle(name, 0.0, turn, kind, Lecture.THETA_1)
                self._vector(child, turn, 1, Lecture.REFLECTED)

    def _ray(self, i: int, start: Point, end: Point, arrow_at: float) -> None:
        kind = self.tree.kind(i)
        style = STYLES[kind]
        stroke = Stroke(self.theme.ray(kind), 1.3 * style.width, ray_dash(self.tree, i)).times(self.share)
        self.marks.append(Line(f"ray-{i}", start, end, stroke, style.arrow, arrow_at, title=ray_title(self.tree, i)))

    def _angle(self, name: str, begin: float, end: float, kind: str, symbol: str) -> None:
        """An arc, with its symbol outside it if there is room between the lines at its sides."""
        color = self.theme.ray(kind)
        radius = arc_radius(self.least, self.reach, self.size)
        corners = signs.arc(self.frame.center, radius, begin, end)
        self.marks.append(Shape(f"angle-{name}", corners, None, Stroke(color, 1.8 * self.share), closed=False))
        away = radius + BESIDE * self.size
        if has_room(end - begin, radius, self.size):
            self._symbol(self._centered(f"angle-{name}", symbol, self.frame.at(0.5 * (begin + end), away), color))

    def _vector(self, row: int, turn: float, side: int, symbol: str) -> None:
        """The letter of a vector beside its ray, near its outer end: on this side of it (1: clockwise), or on the
        other.
        """
        color = self.theme.ray(self.tree.kind(row))
        for share, hand in itertools.product((0.88, 0.78, 0.68), (side, -side)):
            x, y = self.frame.at(turn, share * self.reach)
            away = hand * BESIDE * self.size
            at = (x + away * math.cos(turn), y + away * math.sin(turn))
            if self._symbol(self._centered(f"ray-{row}", symbol, at, color)):
                return

    def _centered(self, name: str, symbol: str, middle: Point, color: tuple) -> Formula:
        """A symbol around a point."""
        mark = Formula(name, symbol, middle, SYMBOL * self.size, color)
        _, top, _, bottom = mark.box()
        return replace(mark, at=(middle[0], middle[1] + middle[1] - 0.5 * (top + bottom)))

    def _symbol(self, mark: Formula) -> bool:
        """Add a symbol, if it is in the picture and free of texts, lines and other symbols."""
        box, picture = mark.box(), self.frame.picture
        lines = [(other.start, other.end) for other in self.marks if isinstance(other, Line)]
        surface = ((picture[0], self.frame.center[1]), (picture[2], self.frame.center[1]))
        if not within(box, picture) or not is_free(widened(box, 0.08 * self.size), self.taken, [*lines, surface]):
            return False
        self.taken.append(box)
        self.marks.append(mark)
        return True

    def _uncrossed(self, lights: Sequence[Mark]) -> list[Mark]:
        """The marks without symbols that rays to lights cross because there was no other way for them."""
        lines = [(light.start, light.end) for light in lights if isinstance(light, Line)]
        return [mark for mark in self.marks if not isinstance(mark, Formula) or is_free(mark.box(), (), lines)]

    def _no_ray(self) -> None:
        """Total internal reflection: a cross below the surface, or in the corner if rays to lights run there."""
        if self.row["radicand"] > 0.0 or math.isnan(self.row["radicand"]) or not self.going_on:
            return
        (x, y), size, color = self.frame.center, self.size, self.theme.ray("refraction")
        title = "total internal reflection: no ray is refracted"
        room = self.right - x - 1.9 * size
        words = next((words for words in NO_RAY_WORDS if text_width(words, size) <= room), NO_RAY)
        near = Text("bar", (x + 1.9 * size, y + 1.1 * size), words, size, color, "start", title=title)
        corner = (self.right - text_width(words, size), self.low)
        crossed = any(clip_shares(stub, near.box()) for stub in self.lights.stubs())
        text = replace(near, at=corner) if crossed else near
        self.marks += [*signs.cross("bar", (text.at[0] - 0.7 * size, text.at[1]), size, color), text]

    def _name(self) -> None:
        """The name of the object, on the side of the surface that its medium is on. That of a thin sheet, which has no
        inside, interrupts the line of the surface.
        """
        (x, y), size, left = self.frame.center, self.size, self.left
        item = self.tree.scene.objects[int(self.row["object"])]
        sheet = item.thin and item.material.transmit > 0.0
        places = [(left, y + 0.8 * size), (left, self.low - LINE * size)]
        if sheet:
            places = [(left, y)]
        elif self.tree.from_inside(self.node) and not math.isnan(self.row["n2"]):
            places = [(left, y - 0.8 * size), (left, self.corners.third + LINE * size)]
        (x0, _, x1, _), title = self.frame.picture, hit_label(self.tree, self.node)
        lines = [(mark.start, mark.end) for mark in self.marks if isinstance(mark, Line)]
        lines += [] if sheet else [((x0, y), (x1, y))]
        text = Text("surface", places[0], "", size, self.theme.text, "start", on_line=sheet)
        for share, at in itertools.product((1.0, 0.8, 0.6, 0.4), places):
            name = fitted(title, share * (x - left - 2.0 * size), size)
            text = replace(text, at=at, content=name)
            if is_free(text.box(), self.taken, lines) and self.lights.keeps_clear(text.box()):
                break
        else:  # no room for a name
            text = None
        hole = text.box() if sheet and text else None
        self.marks.append(Line("surface", (x0, y), (x1, y), Stroke(self.theme.text, 2.4), hole=hole, title=title))
        self.marks += [text] if text else []

    def _formulas(self) -> None:
        sections = scattering_sections(self.tree, self.node) if self.going_on else []
        if self.world:
            section = local_light(self.tree, self.world, self.node, MOST_LIGHTS)
            if self.lights.rotated:
                section.add("each L rotated into this plane about n")
            sections.append(section)
        last = 1 + self.lights.rotated if self.world else 0
        self.marks += formula_columns(sections, last, self.frame.formulas, self.size, self.theme)

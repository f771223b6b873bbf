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
from viewer.base.wording import format_angle, format_number
from viewer.explain.lighting import local_light
from viewer.explain.scattering import direction_error, scattering_sections
from viewer.figures import signs
from viewer.figures.font import fitted, text_width
from viewer.figures.labels import end_label, factor_label, hit_label, ray_label, ray_title
from viewer.figures.layout.formula_column import LINE, formula_column
from viewer.figures.layout.label_placement import LabelPlacer, Spot
from viewer.figures.layout.sizes import NO_RAY
from viewer.figures.lights import (
    MOST_LIGHTS,
    counted,
    fate_of,
    light_title,
    light_words,
    ray_dash,
    shadow_rays,
    turn_to_light,
)
from viewer.figures.marks import (
    HEIGHT,
    WIDTH,
    Line,
    Mark,
    Piece,
    Point,
    Rectangle,
    Shape,
    Stroke,
    Text,
    clip_shares,
    point_along,
    widened,
)
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Pages, Subject

CENTER = (262.0, 292.0)  # the hit
REACH = 195.0  # length of rays
LIGHT_REACHES = (118.0, 150.0, 90.0, REACH + 28.0, 60.0)  # lengths of rays to lights; the first that fits is used
LIGHT_SIGN = 0.6  # half the width that is kept free for the sign of a light, in text sizes
IN_PLANE = math.radians(1.0)  # a light that is out of the plane by less counts as in it
LEFT, RIGHT = 12.0, 512.0  # of the media
TOP, BOTTOM = 12.0, HEIGHT - 12.0
WORDS = 536.0  # left end of the formulas
ARC = 62.0  # radius of an angle's arc
LARGEST = 20.0  # points
LOCAL = "A ka C + Σ S L (kd C N·L + ks (R·V)ᵖ)"  # a short form, for half a slide
TINTS = (0.06, 0.16)  # of the medium with the lower and with the higher index


def pages(subject: Subject, style: FigureStyle) -> Pages:
    """One hit in its plane of incidence. The page is empty before the step with the hit."""
    return [
        hit_marks(step, style.node, style.text_size, style.theme, subject.world) if style.node in step.rows else []
        for step in subject.steps
    ]


def hit_marks(step: Step, node: int, size: float, theme: Theme, world: World | None = None) -> list[Mark]:
    """The marks of a hit. `node` is its row (`hit_row`). Without a `world`, the local term has no numbers."""
    return _Drawing(step, node, size, theme, world).marks


def hit_row(tree: RayTree, asked: str | None) -> int:
    """The row of a hit that was asked for by its ray's path (TR) or label (R3); without a request, the first.
    ValueError with a message for the user.
    """
    hits = [i for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW and tree.object_name(i)]
    if not hits:
        raise ValueError("--figure hit: the ray meets no surface")
    if asked is None:
        return 0
    for i in hits:
        if asked.upper() in (tree.path(i), tree.label(i)):
            return i
    known = ", ".join(f"{tree.path(i)} ({tree.label(i)})" if i else tree.path(i) for i in hits[:12])
    more = " ..." if len(hits) > 12 else ""
    raise ValueError(f"--node {asked} must be the path or the label of a ray that meets a surface: {known}{more}")


class _Drawing:
    def __init__(self, step: Step, node: int, size: float, theme: Theme, world: World | None) -> None:
        if size > LARGEST:
            raise ValueError(f"a hit has room for text of {LARGEST:g} points at most, got {size:g}")
        self.tree: RayTree = step.tree
        self.step, self.node, self.size, self.theme, self.world = step, node, size, theme, world
        self.row = self.tree.nodes[node]
        below = [child for child in self.tree.children[node] if child in step.rows]
        self.going_on = [child for child in below if self.tree.nodes["kind"][child] != SHADOW]
        self.theta1, self.theta2 = float(self.row["theta1"]), float(self.row["theta2"])
        shadows = [child for child in below if self.tree.nodes["kind"][child] == SHADOW]
        self.many = shadows if len(shadow_rays(self.tree, node)) > MOST_LIGHTS else []
        # Of each light that is drawn: its angle from the normal, and that out of the plane, into which it is rotated.
        self.turns = {child: turn_to_light(self.tree, child) for child in shadows if not self.many}
        self.turned = any(out > IN_PLANE for _, out in self.turns.values())
        self.marks: list[Mark] = []
        self._media()
        self._normal()
        self._rays()
        self._name()
        self._lights()
        self._formulas()

    def _at(self, turn: float, length: float = REACH) -> Point:
        """The point at a distance from the hit, in the direction `turn` clockwise from the normal."""
        return (CENTER[0] + length * math.sin(turn), CENTER[1] - length * math.cos(turn))

    def _media(self) -> None:
        n1, n2 = float(self.row["n1"]), float(self.row["n2"])
        clear = not math.isnan(n2)
        x0, x1, y = LEFT, RIGHT, CENTER[1]
        below = TINTS[n2 > n1] if clear else 0.3
        above = TINTS[n1 > n2] if clear else TINTS[0]
        under = f"n₂ = {format_number(n2)}" if clear else "opaque"
        behind = f"the medium behind the surface, index {format_number(n2)}" if clear else "behind the opaque surface"
        for name, top, bottom, tint, title in (
            ("medium-1", TOP, y, above, f"the medium the ray comes from, index {format_number(n1)}"),
            ("medium-2", y, BOTTOM, below, behind),
        ):
            corners = ((x0, top), (x1, top), (x1, bottom), (x0, bottom))
            self.marks.append(Shape(name, corners, faded(self.theme.text, tint), None, title=title))
        text, size = self.theme.text, self.size
        left, third = x0 + 0.5 * size, TOP + (0.9 + 2 * LINE) * size
        self.marks.append(Text("medium-1", (left, third), f"n₁ = {format_number(n1)}", size, text, "start"))
        low = BOTTOM - 0.9 * size
        self.marks.append(Text("medium-2", (left, low), under, size, text, "start"))

    def _normal(self) -> None:
        color = self.theme.normal
        top, bottom = self._at(0.0, REACH + 22.0), self._at(math.pi, REACH - 25.0)
        self.marks.append(Line("normal", CENTER, top, Stroke(color, 2.0), STYLES["refraction"].arrow, 0.97))
        self.marks.append(Line("normal", CENTER, bottom, Stroke(color, 1.4, (5.0, 5.0))))
        self.marks.append(Text("normal", (top[0], top[1] - 0.7 * self.size), "n", self.size, color))

    def _rays(self) -> None:
        tree, node, size = self.tree, self.node, self.size
        kind = tree.kind(node)
        turn = direction_error(tree, node)
        theta1, theta2 = format_angle(self.theta1, turn), format_angle(self.theta2, turn)
        first, second = TOP + 0.9 * size, TOP + 0.9 * size + LINE * size
        self._ray(node, kind, self._at(-self.theta1), CENTER)
        self._arc(f"ray-{node}", -self.theta1, 0.0, kind)
        left, right = LEFT + 0.5 * size, RIGHT - 0.5 * size
        self._words(f"ray-{node}", (left, first), f"v: {ray_label(tree, node)}", kind, "start")
        self._words(f"ray-{node}", (left, second), f"θ₁ = {theta1}", kind, "start")
        end = end_label(tree, node)
        if end and not self.going_on:
            self.marks.append(Text(f"ray-{node}", (right, first), end, size, self.theme.muted, "end"))
        for child in self.going_on:
            below = tree.kind(child)
            name = f"ray-{child}"
            label = f"{ray_label(tree, child)} {factor_label(tree, child)}"
            if below == "refraction":
                self._ray(child, below, CENTER, self._at(math.pi - self.theta2))
                self._arc(name, math.pi - self.theta2, math.pi, below)
                low = BOTTOM - 0.9 * size
                self._words(name, (right, low - LINE * size), f"t: {label}", below, "end")
                self._words(name, (right, low), f"θ₂ = {theta2}", below, "end")
            else:
                self._ray(child, below, CENTER, self._at(self.theta1))
                self._arc(name, 0.0, self.theta1, below)
                self._words(name, (right, first), f"r: {label}", below, "end")
                self._words(name, (right, second), f"θ₁ = {theta1}", below, "end")
        if self.row["radicand"] <= 0.0 and self.going_on:
            self._no_ray()

    def _ray(self, i: int, kind: str, start: Point, end: Point) -> None:
        style = STYLES[kind]
        stroke = Stroke(self.theme.ray(kind), 1.3 * style.width, ray_dash(self.tree, i))
        self.marks.append(Line(f"ray-{i}", start, end, stroke, style.arrow, 0.6, title=ray_title(self.tree, i)))

    def _no_ray(self) -> None:
        """Total internal reflection: a cross below the surface, or in the corner if rays to lights run there."""
        size, color = self.size, self.theme.ray("refraction")
        title = "total internal reflection: no ray is refracted"
        near = Text("bar", (CENTER[0] + 1.9 * size, CENTER[1] + 1.1 * size), NO_RAY, size, color, "start", title=title)
        corner = (RIGHT - 0.5 * size - text_width(NO_RAY, size), BOTTOM - 0.9 * size)
        crossed = any(clip_shares(stub, near.box()) for stub in self._stubs())
        text = replace(near, at=corner) if crossed else near
        self.marks += [*signs.cross("bar", (text.at[0] - 0.7 * size, text.at[1]), size, color), text]

    def _stubs(self) -> list[Piece]:
        """The rays to lights at the shortest distance of a light."""
        return [(CENTER, self._at(turn, min(LIGHT_REACHES))) for turn, _ in self.turns.values()]

    def _name(self) -> None:
        """The name of the object, on the side of the surface that its medium is on. That of a thin sheet, which has no
        inside, interrupts the line of the surface.
        """
        (x, y), size, left = CENTER, self.size, LEFT + 0.5 * self.size
        item = self.tree.scene.objects[int(self.row["object"])]
        sheet = item.thin and item.material.transmit > 0.0
        places = [(left, y + 0.8 * size), (left, BOTTOM - (0.9 + LINE) * size)]
        if sheet:
            places = [(left, y)]
        elif self.tree.from_inside(self.node) and not math.isnan(self.row["n2"]):
            places = [(left, y - 0.8 * size), (left, TOP + (0.9 + 3 * LINE) * size)]
        rays = [(mark.start, mark.end) for mark in self.marks if isinstance(mark, Line)]
        text = Text("surface", places[0], "", size, self.theme.text, "start", on_line=sheet)
        for share, at in itertools.product((1.0, 0.8, 0.6, 0.4), places):
            name = fitted(hit_label(self.tree, self.node), share * (x - left - 2.0 * size), size)
            text = replace(text, at=at, content=name)
            near = widened(text.box(), LIGHT_SIGN * size)
            if not any(clip_shares(ray, text.box()) for ray in rays) and not any(
                clip_shares(s, near) for s in self._stubs()
            ):
                break
        hole = text.box() if sheet else None
        surface = Line("surface", (LEFT, y), (RIGHT, y), Stroke(self.theme.text, 2.4), hole=hole)
        self.marks += [surface, text]

    def _lights(self) -> None:
        """Rays to lights, dashed, at their true angles from the normal; for many lights, a line of words."""
        names = LabelPlacer((LEFT, TOP, RIGHT, BOTTOM), self.size, self.theme)
        names.taken += [mark.box() for mark in self.marks if isinstance(mark, Text)]
        names.ways += [(mark.name, piece) for mark in self.marks if isinstance(mark, Line) for piece in mark.pieces()]
        if self.many:
            self.marks += self._light_words(names)
        words = list(names.taken)
        ends: dict[int, Point] = {}
        for child, (turn, _) in self.turns.items():
            ends[child] = self._light_end(turn, names, words)
            names.take(ends[child], 0.9 * self.size)
        names.ways += [(f"ray-{child}", (CENTER, end)) for child, end in ends.items()]
        color = self.theme.ray("shadow")
        for child, end in ends.items():
            name, fate = f"ray-{child}", fate_of(self.tree, child)
            title = ray_title(self.tree, child)
            out = self.turns[child][1]
            title += f"; it is out of this plane by {format_angle(out)} and rotated into it" if out > IN_PLANE else ""
            stroke = Stroke(color, STYLES["shadow"].width, fate.dash)
            stop = point_along((CENTER, end), 1.0 - 0.5 * self.size / math.dist(CENTER, end))  # up to the sign
            self.marks.append(Line(name, CENTER, stop, stroke, title=title))
            self.marks += signs.light_end(fate.name, name, end, self.size, self.theme)
            self.marks += names.label(name, ray_label(self.tree, child), [Spot(end)], color, most=0)

    def _light_end(self, turn: float, names: LabelPlacer, words: Sequence[Rectangle]) -> Point:
        """The end point of a ray to a light: at the first length in LIGHT_REACHES that is free of marks and rays, else
        at the shortest.
        """
        rays = [mark for mark in self.marks if isinstance(mark, Line)]
        for reach in LIGHT_REACHES:
            end = self._at(turn, reach)
            box = widened((*end, *end), LIGHT_SIGN * self.size)
            crossed = any(clip_shares((CENTER, end), other) for other in words)
            if names.free(box) and not crossed and not any(clip_shares((ray.start, ray.end), box) for ray in rays):
                return end
        return self._at(turn, min(LIGHT_REACHES))

    def _light_words(self, names: LabelPlacer) -> list[Mark]:
        """The line that stands for the rays to many lights."""
        size, left, right = self.size, LEFT + 0.5 * self.size, RIGHT - 0.5 * self.size
        words = light_words(counted(self.tree, self.many))

        def places(high: float) -> list[tuple[Point, str]]:
            """In the upper medium, then in the lower one, below or above what stands in the corners."""
            upper, low = TOP + (0.9 + 3 * LINE) * size, BOTTOM - 0.9 * size - high
            uppers = [((left, upper), "start"), ((right, upper - LINE * size), "end")]
            return [*uppers, ((left, low - LINE * size), "start"), ((left, low - 2 * LINE * size), "start")]

        title = light_title(self.tree, self.many)
        text = Text(f"lights-{self.node}", CENTER, "", size, self.theme.ray("shadow"), title=title)
        widths = (right - left, CENTER[0] - left - size, 0.0)
        return names.paragraph(text, [f"L: {words[0]}", *words[1:]], widths, LINE * size, places)

    def _arc(self, name: str, begin: float, end: float, kind: str) -> None:
        corners = signs.arc(CENTER, ARC, begin, end)
        self.marks.append(Shape(f"angle-{name}", corners, None, Stroke(self.theme.ray(kind), 1.8), closed=False))

    def _words(self, name: str, at: Point, content: str, kind: str, anchor: str) -> None:
        self.marks.append(Text(name, at, content, self.size, self.theme.ray(kind), anchor))

    def _formulas(self) -> None:
        sections = scattering_sections(self.tree, self.node) if self.going_on else []
        if self.world:
            section = local_light(self.tree, self.world, self.node, MOST_LIGHTS)
            section.formula = LOCAL
            if self.turned:
                section.add("each L rotated into this plane about n")
            sections.append(section)
        last = 1 + self.turned if self.world else 0
        self.marks += formula_column(sections, last, (WORDS, TOP, WIDTH - 12.0, BOTTOM), self.size, self.theme)

"""One hit in its plane of incidence: the normal, the incoming ray, the rays sent out, true angles, and the lecture's
formulas with this hit's numbers.

As on the slide, the normal points up, on the side of the incoming ray, which comes from the left. A light rarely
lies in this plane: it is drawn at its true angle from the normal, rotated into the plane.
"""

import math

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.theme import BLOCKED_DASH, STYLES, Color, Theme, faded
from viewer.base.wording import format_angle, format_number
from viewer.explain.lighting import local_light
from viewer.explain.scattering import direction_error, scattering_sections
from viewer.explain.sections import Section
from viewer.figures import signs
from viewer.figures.font import fitted, text_width
from viewer.figures.labels import end_label, factor_label, hit_label, ray_label, ray_title
from viewer.figures.layout.label_placement import LabelPlacer, Spot
from viewer.figures.layout.sizes import NO_RAY
from viewer.figures.marks import HEIGHT, WIDTH, Line, Mark, Point, Shape, Stroke, Text, clip_shares, point_along
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Pages, Subject

CENTER = (262.0, 292.0)  # the hit
REACH = 195.0  # length of rays
LIGHT_REACHES = (118.0, 150.0, 90.0, REACH + 28.0, 60.0)  # lengths of rays to lights; the first that fits is used
IN_PLANE = math.radians(1.0)  # a light that is out of the plane by less counts as in it
LEFT, RIGHT = 12.0, 512.0  # of the media
TOP, BOTTOM = 12.0, HEIGHT - 12.0
WORDS = 536.0  # left end of the formulas
ARC = 62.0  # radius of an angle's arc
LINE = 1.28  # from line to line of the formulas, in text sizes
LARGEST = 20.0  # points
BETWEEN = 0.5  # between two sections, in lines, if there is room
LOCAL = "A ka C + Σ S L (kd C N·L + ks (R·V)ᵖ)"  # a short form, for half a slide
VECTORS = ("v", "n", "r", "t")
TINTS = (0.06, 0.16)  # of the medium with the lower and with the higher index

FormulaLine = tuple[str, str, Color]  # name, value, colour of the name


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
        self.lights = [child for child in below if self.tree.nodes["kind"][child] == SHADOW]
        self.going_on = [child for child in below if child not in self.lights]
        self.theta1, self.theta2 = float(self.row["theta1"]), float(self.row["theta2"])
        # Whether a light is out of the plane, and rotated into it.
        self.turned = any(self._turn_to_light(child)[1] > IN_PLANE for child in self.lights)
        self.marks: list[Mark] = []
        self._media()
        self._normal()
        self._rays()
        self._lights()
        self._formulas()

    def _at(self, turn: float, length: float = REACH) -> Point:
        """The point at a distance from the hit, in the direction `turn` clockwise from the normal."""
        return (CENTER[0] + length * math.sin(turn), CENTER[1] - length * math.cos(turn))

    def _media(self) -> None:
        n1, n2 = float(self.row["n1"]), float(self.row["n2"])
        clear = not math.isnan(n2)
        x0, y0, x1, y1 = LEFT, TOP, RIGHT, BOTTOM
        y = CENTER[1]
        below = TINTS[n2 > n1] if clear else 0.3
        above = TINTS[n1 > n2] if clear else TINTS[0]
        for name, top, bottom, tint, title in (
            ("medium-1", y0, y, above, f"the medium the ray comes from, index {format_number(n1)}"),
            ("medium-2", y, y1, below, f"behind the surface of {hit_label(self.tree, self.node)}"),
        ):
            corners = ((x0, top), (x1, top), (x1, bottom), (x0, bottom))
            self.marks.append(Shape(name, corners, faded(self.theme.text, tint), None, title=title))
        self.marks.append(Line("surface", (x0, y), (x1, y), Stroke(self.theme.text, 2.4)))
        text, size = self.theme.text, self.size
        left, third = x0 + 0.5 * size, TOP + (0.9 + 2 * LINE) * size
        name = fitted(hit_label(self.tree, self.node), CENTER[0] - left - 2.0 * size, size)
        under = f"n₂ = {format_number(n2)}" if clear else "opaque"
        self.marks.append(Text("medium-1", (left, third), f"n₁ = {format_number(n1)}", size, text, "start"))
        low = y1 - 0.9 * size
        self.marks.append(Text("surface", (left, y + 0.8 * size), name, size, text, "start"))
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
        stroke = Stroke(self.theme.ray(kind), 1.3 * style.width, style.dash)
        self.marks.append(Line(f"ray-{i}", start, end, stroke, style.arrow, 0.6, title=ray_title(self.tree, i)))

    def _no_ray(self) -> None:
        """Total internal reflection: a cross below the surface."""
        color = self.theme.ray("refraction")
        at = (CENTER[0] + 1.2 * self.size, CENTER[1] + 1.1 * self.size)
        self.marks += signs.cross("bar", at, self.size, color)
        beside = (at[0] + 0.7 * self.size, at[1])
        title = "total internal reflection: no ray is refracted"
        self.marks.append(Text("bar", beside, NO_RAY, self.size, color, "start", title=title))

    def _lights(self) -> None:
        """Rays to lights, dashed, at their true angles from the normal."""
        names = LabelPlacer((LEFT, TOP, RIGHT, BOTTOM), self.size, self.theme)
        names.taken += [mark.box() for mark in self.marks if isinstance(mark, Text)]
        names.ways += [(mark.name, piece) for mark in self.marks if isinstance(mark, Line) for piece in mark.pieces()]
        turns = {child: self._turn_to_light(child) for child in self.lights}
        ends: dict[int, Point] = {}
        for child, (turn, _) in turns.items():
            ends[child] = self._light_end(turn, names)
            names.take(ends[child], 0.9 * self.size)
        names.ways += [(f"ray-{child}", (CENTER, end)) for child, end in ends.items()]
        style, color = STYLES["shadow"], self.theme.ray("shadow")
        for child, end in ends.items():
            name, fate = f"ray-{child}", self.tree.end(child) or ""
            title = ray_title(self.tree, child)
            out = turns[child][1]
            title += f"; it is out of this plane by {format_angle(out)} and rotated into it" if out > IN_PLANE else ""
            stroke = Stroke(color, style.width, BLOCKED_DASH if fate == "blocked" else style.dash)
            stop = point_along((CENTER, end), 1.0 - 0.5 * self.size / math.dist(CENTER, end))  # up to the sign
            self.marks.append(Line(name, CENTER, stop, stroke, title=title))
            away = self.tree.faces_away(child)
            self.marks += signs.light_end("away" if away else fate, name, end, self.size, self.theme)
            words = ray_label(self.tree, child)
            self.marks += names.label(name, words, [Spot(end)], color, most=0)

    def _light_end(self, turn: float, names: LabelPlacer) -> Point:
        """The end point of a ray to a light: at the first length in LIGHT_REACHES that is free of marks and rays, else
        at the first.
        """
        rays = [mark for mark in self.marks if isinstance(mark, Line)]
        ends = [self._at(turn, reach) for reach in LIGHT_REACHES]
        half = 0.6 * self.size
        for end in ends:
            box = (end[0] - half, end[1] - half, end[0] + half, end[1] + half)
            if names.free(box) and not any(clip_shares((ray.start, ray.end), box) for ray in rays):
                return end
        return ends[0]

    def _turn_to_light(self, child: int) -> tuple[float, float]:
        """(angle from the normal, positive to the right; angle out of the plane)."""
        v, n = np.array(self.row["direction"]), np.array(self.row["normal"])
        to_light = np.array(self.tree.nodes["direction"][child])
        along = v - float(v @ n) * n  # to the right in the figure
        up = float(to_light @ n)
        beside = float(np.linalg.norm(to_light - up * n))
        length = float(np.linalg.norm(along))
        right = float(to_light @ along) / length if length > 1e-9 else beside
        out = math.asin(min(1.0, math.sqrt(max(0.0, beside**2 - right**2))))
        return math.copysign(math.atan2(beside, up), right), out

    def _arc(self, name: str, begin: float, end: float, kind: str) -> None:
        """An arc between two directions, in steps of at most two degrees."""
        steps = max(1, math.ceil(abs(end - begin) / math.radians(2.0)))
        corners = tuple(self._at(begin + (end - begin) * k / steps, ARC) for k in range(steps + 1))
        self.marks.append(Shape(f"angle-{name}", corners, None, Stroke(self.theme.ray(kind), 1.8), closed=False))

    def _words(self, name: str, at: Point, content: str, kind: str, anchor: str) -> None:
        self.marks.append(Text(name, at, content, self.size, self.theme.ray(kind), anchor))

    # --- formulas -----------------------------------------------------------------------------------------------------

    def _formulas(self) -> None:
        """As many sections as fit: first the vectors are left out, then all of the local light but its sum."""
        sections = scattering_sections(self.tree, self.node) if self.going_on else []
        if self.world:
            sections.append(self._local(self.world))
        size = self.size
        room = (BOTTOM - TOP) / (LINE * size)
        blocks = [self._lines(section, True) for section in sections]
        if _height(blocks) > room:
            blocks = [self._lines(section, False) for section in sections]
        if _height(blocks) > room and self.world:
            blocks[-1] = [blocks[-1][0], *blocks[-1][-1 - self.turned :]]
        while _height(blocks) > room:
            blocks.pop()
        gap = min(BETWEEN, (room - sum(map(len, blocks))) / max(1, len(blocks) - 1))
        y = TOP + 0.9 * size
        for block in blocks:
            for content, value, color in block:
                if content:
                    self.marks.append(Text("formulas", (WORDS, y), content, size, color, "start"))
                if value:
                    self.marks.append(Text("formulas", (WIDTH - 12.0, y), value, size, self.theme.text, "end"))
                y += LINE * size
            y += gap * LINE * size

    def _local(self, world: World) -> Section:
        section = local_light(self.tree, world, self.node)
        section.formula = LOCAL
        if self.turned:
            section.add("each L rotated into this plane about n")
        return section

    def _lines(self, section: Section, vectors: bool) -> list[FormulaLine]:
        """The lines of a section: name and value in one line, or in two."""
        theme, wide = self.theme, WIDTH - 12.0 - WORDS
        found = [(section.formula, "", theme.accent)]
        for line in section.lines:
            if line.name in VECTORS and not vectors:
                continue
            if text_width(line.name, self.size) + text_width(line.value, self.size) + self.size <= wide:
                found.append((line.name, line.value, theme.muted))
            elif text_width(line.value, self.size) <= wide:
                found += [(fitted(line.name, wide, self.size), "", theme.muted), ("", line.value, theme.muted)]
        return found


def _height(blocks: list[list[FormulaLine]]) -> int:
    return sum(map(len, blocks))

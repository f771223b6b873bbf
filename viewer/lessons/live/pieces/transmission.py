"""The direction of the refracted ray as a construction: t = n v + (n c1 - c2) n, in the plane of incidence.

All directions have length 1, so that they end on a circle. Across the normal, v goes sin theta1, and n v goes
n sin theta1, which is sin theta2 by Snell's law. Below that place on the surface the circle has the end of t, at the
depth c2. The rest of the way from n v to t runs along the normal. Where n sin theta1 is 1 or more, there is no such
place: total internal reflection.
"""

import math
from dataclasses import dataclass

from tracer.formulas import optics
from viewer.base.theme import STYLES, Color, Theme, faded
from viewer.base.wording import format_number
from viewer.explain.formulas import Lecture
from viewer.explain.sections import Section
from viewer.figures import signs
from viewer.figures.figure.hit import TINTS
from viewer.figures.marks import Disc, Handle, Line, Mark, Point, Rectangle, Shape, Stroke
from viewer.lessons.live.interface import MOST, Interface, interface_of
from viewer.lessons.live.labels import Labels
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters

STAGES = 4  # v and n; n v; t; the way between them
FORMULAS = (Lecture.COSINE_1, Lecture.ETA, Lecture.COSINE_2, Lecture.TRANSMISSION)
ROOM, LOW = 1.2, 1.06  # above and beside the centre of the circle, and below it, in radii
DOTTED, DASHED = (2.0, 3.0), (6.0, 4.0)
BESIDE = 0.85  # from a line to its text, in text sizes


@dataclass(frozen=True)
class Construction:
    """The numbers of the construction, as the lecture names them."""

    n: float  # n1 / n2
    c1: float
    sine: float  # of theta1

    @staticmethod
    def of(media: Interface) -> "Construction":
        theta1 = math.radians(media.theta1)
        return Construction(media.n1 / media.n2, math.cos(theta1), math.sin(theta1))

    @property
    def across(self) -> float:
        """sin theta2, if it is below 1."""
        return self.n * self.sine

    @property
    def radicand(self) -> float:
        return optics.radicand(self.sine, self.n, 1.0)

    @property
    def c2(self) -> float | None:
        """None on total internal reflection, with the limit included, as on the slide."""
        return math.sqrt(self.radicand) if self.radicand > 0.0 else None


def transmission(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The construction up to the parameter `stage`, 1 to 4; by default all of it. The media are those of the hit, or
    the parameters `n1` and `n2`; the handle is `theta1`, in degrees.
    """
    stage = int(parameters.get("stage", STAGES))
    if not 1 <= stage <= STAGES:
        raise ValueError(f"transmission: stage must be from 1 to {STAGES}, got {stage}")
    media = interface_of(context, parameters, "transmission", f" {STAGES}")
    found = Construction.of(media)
    where, text = lay_out(context, [_section(found, stage)], [caption(found, stage)])
    return [*_Drawing(found, media, stage, where, context.size, context.theme).marks, *text]


def _section(found: Construction, stage: int) -> Section:
    section = Section("Transmission", FORMULAS[stage - 1])
    section.add("c₁", format_number(found.c1, 4))
    if stage > 1:
        section.add("n", format_number(found.n, 4))
        section.add("n sin θ₁", format_number(found.across, 4))
    if stage > 2:
        section.add(Lecture.RADICAND, format_number(found.radicand, 4))
        section.add("c₂", "no root" if found.c2 is None else format_number(found.c2, 4))
    return section


def caption(found: Construction, stage: int) -> str:
    """The number of a stage, in one line."""
    n, c1, across, radicand = (format_number(x, 4) for x in (found.n, found.c1, found.across, found.radicand))
    if stage == 1:
        return f"c₁ = −v·n = {c1}"
    if stage == 2 or found.c2 is None:
        limit = " ≥ 1" if found.c2 is None else ""
        return f"n sin θ₁ = {n} × {format_number(found.sine, 4)} = {across}{limit}"
    if stage == 3:
        return f"c₂ = √{radicand} = {format_number(found.c2, 4)}"
    return f"n c₁ − c₂ = {format_number(found.n * found.c1 - found.c2, 4)}"


class _Drawing:
    """The marks, at one scale in both directions. `y` is up from the surface, in lengths of a direction."""

    def __init__(
        self, found: Construction, media: Interface, stage: int, where: Rectangle, size: float, theme: Theme
    ) -> None:
        self.found, self.media, self.stage, self.size, self.theme = found, media, stage, size, theme
        self.where = left, top, right, bottom = where
        wide, deep = max(ROOM, found.across + ROOM - 1.0), max(LOW, found.n * found.c1 + 0.5 * (ROOM - 1.0))
        self.scale = min((right - left) / (ROOM + wide), (bottom - top) / (ROOM + deep))
        aside = right - left - self.scale * (ROOM + wide)
        self.center = (left + 0.5 * aside + self.scale * ROOM, top + self.scale * ROOM)
        self.marks: list[Mark] = []
        self._incoming()
        ends: list[tuple[str, str, Point, Color]] = [
            ("vector-v", Lecture.INCOMING, (-found.sine, found.c1), theme.ray("camera"))
        ]
        ends.append(("vector-n", Lecture.NORMAL, (0.0, 1.0), theme.normal))
        if stage > 1:
            ends += self._outgoing()
        self._handle()
        labels = Labels(where, size, theme, self.marks)
        for name, source, end, color in ends:
            labels.symbol(name, source, self._beyond(end), color)
        for name, words, a, b, color in self._lengths():
            labels.place(name, words, self._beside(a, b), color)
        self.marks = [*self._ground(), *self.marks, *labels.marks]

    def at(self, x: float, y: float) -> Point:
        return (self.center[0] + self.scale * x, self.center[1] - self.scale * y)

    def _line(
        self, name: str, a: Point, b: Point, color: Color, width: float = 1.6, dash: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        self.marks.append(Line(name, self.at(*a), self.at(*b), Stroke(color, width, dash)))

    def _vector(self, name: str, a: Point, b: Point, color: Color, title: str, is_dashed: bool = False) -> None:
        stroke = Stroke(color, 1.8 if is_dashed else 2.8, DASHED if is_dashed else (0.0, 0.0))
        self.marks.append(Line(name, self.at(*a), self.at(*b), stroke, STYLES["refraction"].arrow, 0.97, title=title))

    def _ground(self) -> list[Mark]:
        """The two media, and the circle, which labels may cover."""
        left, top, right, bottom = self.where
        y, theme = self.center[1], self.theme
        found: list[Mark] = []
        for name, first, last, is_denser in (
            ("medium-1", top, y, self.media.n1 > self.media.n2),
            ("medium-2", y, bottom, self.media.n2 > self.media.n1),
        ):
            corners = ((left, first), (right, first), (right, last), (left, last))
            found.append(Shape(name, corners, faded(theme.text, TINTS[is_denser]), None))
        circle = signs.arc(self.center, self.scale, 0.0, 2.0 * math.pi)
        title = "all directions of length 1 end here"
        return [*found, Shape("circle", circle, None, Stroke(theme.muted, 1.2), closed=False, title=title)]

    def _incoming(self) -> None:
        found, theme = self.found, self.theme
        start, foot = (-found.sine, found.c1), (-found.sine, 0.0)
        left, _, right, _ = self.where
        surface = Stroke(theme.text, 2.0)
        self.marks.append(Line("surface", (left, self.center[1]), (right, self.center[1]), surface))
        self._line("cosine-1", start, foot, theme.ray("camera"), dash=DOTTED)
        self._line("sine-1", foot, (0.0, 0.0), theme.ray("camera"), 3.4)
        self._vector("vector-n", (0.0, 0.0), (0.0, 1.0), theme.normal, "the normal")
        self._vector("vector-v", start, (0.0, 0.0), theme.ray("camera"), "the incoming direction")

    def _outgoing(self) -> list[tuple[str, str, Point, Color]]:
        """The construction from n v on. Returns names, symbols and ends of its vectors."""
        found, theme, color = self.found, self.theme, self.theme.ray("refraction")
        across, low = found.across, (found.across, -found.n * found.c1)
        self._line("sine-2", (0.0, 0.0), (across, 0.0), color, 3.4)
        self._line("drop", (across, 0.0), (across, -max(1.0, -low[1])), color, dash=DOTTED)
        self._vector("vector-nv", (0.0, 0.0), low, color, "n v: the incoming direction, n times as long", True)
        ends: list[tuple[str, str, Point, Color]] = [("vector-nv", Lecture.SCALED, low, color)]
        if self.stage > 2 and found.c2 is not None:
            tip = (across, -found.c2)
            if self.stage > 3:
                self._vector("rest", low, tip, theme.normal, "(n c1 - c2) n: the rest of the way")
            self._vector("vector-t", (0.0, 0.0), tip, color, "the refracted direction")
            self.marks.append(Disc("tip", self.at(*tip), 0.22 * self.size, color, None))
            ends.append(("vector-t", Lecture.REFRACTED, tip, color))
        return ends

    def _handle(self) -> None:
        turns = [math.radians(k) for k in range(int(MOST) + 1)]
        path = tuple(self.at(-math.sin(turn), math.cos(turn)) for turn in turns)
        title = "drag to turn the ray"
        self.marks.append(Handle("theta1", self.media.theta1, (0.0, MOST), path, self.theme.accent, title=title))

    def _lengths(self) -> list[tuple[str, list[str], Point, Point, Color]]:
        """Names, texts, the longest first, and the lines that they measure."""
        found, theme, color = self.found, self.theme, self.theme.ray("refraction")
        c1, sine, across = (format_number(x, 4) for x in (found.c1, found.sine, found.across))
        foot, corner = (-found.sine, 0.0), (found.across, 0.0)
        lengths = [
            ("cosine-1", [f"c₁ = {c1}", "c₁"], (-found.sine, found.c1), foot, theme.text),
            ("sine-1", [f"sin θ₁ = {sine}", "sin θ₁"], foot, (0.0, 0.0), theme.text),
        ]
        if self.stage > 1:
            more = " > 1" if found.across > 1.0 else ""
            words = [f"n sin θ₁ = {across}{more}", f"{across}{more}"]
            lengths.append(("sine-2", words, (0.0, 0.0), corner, color))
        if self.stage > 2 and found.c2 is not None:
            tip, low = (found.across, -found.c2), (found.across, -found.n * found.c1)
            lengths.append(("cosine-2", [f"c₂ = {format_number(found.c2, 4)}", "c₂"], corner, tip, color))
            if self.stage > 3:
                rest = format_number(found.n * found.c1 - found.c2, 4)
                lengths.append(("rest", [f"n c₁ − c₂ = {rest}", "n c₁ − c₂"], low, tip, theme.normal))
        elif self.stage > 2:
            lengths.append(("tip", ["misses the circle: no t", "no t"], corner, (found.across, -1.0), color))
        return lengths

    def _beyond(self, end: Point) -> list[Point]:
        """Places for the letter of a vector from the centre: past its end and beside it."""
        far = max(1e-9, math.hypot(*end))
        ux, uy = end[0] / far, end[1] / far
        step = self.size / self.scale
        shares = ((0.0, 0.9), (0.9, 0.0), (-0.9, 0.0), (0.9, -0.9), (-0.9, -0.9), (1.0, -2.0), (-1.0, -2.0))
        return [self.at(end[0] + step * (b * ux + a * uy), end[1] + step * (b * uy - a * ux)) for a, b in shares]

    def _beside(self, a: Point, b: Point) -> list[tuple[Point, str]]:
        """Places beside a line, which is level or upright."""
        (x0, y0), (x1, y1) = self.at(*a), self.at(*b)
        x, y, away = 0.5 * (x0 + x1), 0.5 * (y0 + y1), BESIDE * self.size
        if abs(y1 - y0) < 1e-6:
            return [((x, y - away), "middle"), ((x, y + away), "middle"), ((x0, y - away), "start"),
                    ((x0, y + away), "start"), ((x1, y + away), "end")]  # fmt: skip
        heights = [y, 0.7 * y0 + 0.3 * y1, 0.3 * y0 + 0.7 * y1, 0.85 * y0 + 0.15 * y1, 0.15 * y0 + 0.85 * y1]
        return [((x + side * 0.5 * away, h), "start" if side > 0 else "end") for h in heights for side in (1, -1)]

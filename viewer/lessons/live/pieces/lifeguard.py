"""The lifeguard problem: the path of least time over a beach and through the sea, and Snell's law at its minimum.

The guard is at (0, 3) on the beach, the swimmer at (7, -4) in the sea, the shore is y = 0. At 4 m/s on the beach and
3 m/s in the sea, the least time is 5/4 + 5/3 = 35/12 s, at x = 4: both parts of that path are the hypotenuse of a
triangle with sides 3, 4 and 5.
"""

import math
from dataclasses import dataclass

from viewer.base.theme import Theme, faded
from viewer.base.wording import format_number
from viewer.figures import signs
from viewer.figures.figure.hit import TINTS
from viewer.figures.font import text_width
from viewer.figures.layout.hit_frame import GAP, MARGIN
from viewer.figures.marks import Disc, Handle, Line, Mark, Point, Rectangle, Shape, Stroke, Text, widened
from viewer.lessons.live.labels import Labels
from viewer.lessons.live.piece import LiveContext, Parameters
from viewer.lessons.live.plot import Axis, Plot

GUARD, SWIMMER = (0.0, 3.0), (7.0, -4.0)  # metres
ENDS = (-1.0, 8.0)  # of the shore
HIGH = (-5.0, 4.0)  # of the picture
START = 2.0  # where the path crosses the shore at first
LINE = 1.3  # from line to line, in text sizes
APART = (0.0, 0.5, 1.0, 1.6, 2.2)  # distances of an angle's name from its arc that are tried, in text sizes
NARROW = 1.2  # ratio of width to height below which the plot stands below the picture
STEPS = 200  # of the search for the minimum: halvings of an interval, until it has no width


@dataclass(frozen=True)
class Lifeguard:
    """Speeds on the beach and in the sea, in m/s."""

    v1: float
    v2: float

    def time(self, x: float) -> float:
        """Seconds of the path that crosses the shore at x."""
        return math.dist((x, 0.0), GUARD) / self.v1 + math.dist((x, 0.0), SWIMMER) / self.v2

    def sines(self, x: float) -> tuple[float, float]:
        """sin theta1 and sin theta2, the angles from the normal of the shore; negative for a path to the left."""
        return (
            (x - GUARD[0]) / math.dist((x, 0.0), GUARD),
            (SWIMMER[0] - x) / math.dist((x, 0.0), SWIMMER),
        )

    def slope(self, x: float) -> float:
        """The derivative of the time: sin theta1 / v1 - sin theta2 / v2, which increases with x."""
        sine1, sine2 = self.sines(x)
        return sine1 / self.v1 - sine2 / self.v2

    @property
    def least(self) -> float:
        """The x of least time, by bisection to the last bit."""
        low, high = GUARD[0], SWIMMER[0]
        for _ in range(STEPS):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            low, high = (middle, high) if self.slope(middle) < 0.0 else (low, middle)
        return min(low, high, key=lambda x: abs(self.slope(x)))


def lifeguard(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The shore, the travel time against the crossing point, and both sides of Snell's law. The handle is `x`, in
    metres along the shore; `v1` and `v2` are the speeds, in m/s. With `ask` it is a question: only the time of the path
    is shown, neither the curve nor the path of least time.
    """
    given = Lifeguard(parameters.get("v1", 4.0), parameters.get("v2", 3.0))
    x = parameters.get("x", START)
    for name, speed in (("v1", given.v1), ("v2", given.v2)):
        if not 0.0 < speed < math.inf:
            raise ValueError(f"lifeguard: {name} must be a speed above 0, got {speed:g}")
    if not ENDS[0] <= x <= ENDS[1]:
        raise ValueError(f"lifeguard: x must be from {ENDS[0]:g} to {ENDS[1]:g}, got {x:g}")
    size, theme = context.size, context.theme
    left, top, right, bottom = widened(context.where, -MARGIN * size)
    asks = bool(parameters.get("ask", 0.0))
    lines = [f"time {given.time(x):.4f} s"] if asks else words(given, x, right - left, size)
    middle = 0.5 * (left + right)
    text: list[Mark] = []
    for k, content in enumerate(reversed(lines)):
        text.append(Text("time", (middle, bottom - (0.6 + LINE * k) * size), content, size, theme.text))
    bottom -= (LINE * len(lines) + 0.4) * size
    if right - left >= NARROW * (bottom - top):
        wide = min(0.5 * (right - left), bottom - top)
        shore, graph = (left, top, left + wide, bottom), (left + wide + GAP * size, top, right, bottom)
    else:
        half = top + 0.52 * (bottom - top)
        shore, graph = (left, top, right, half), (left, half + GAP * size, right, bottom)
    return [*_Shore(given, x, shore, size, theme, asks).marks, *_graph(given, x, graph, size, theme, asks), *text]


def words(given: Lifeguard, x: float, wide: float, size: float) -> list[str]:
    """Both sides of Snell's law and the time, in the longest form whose lines fit."""
    sine1, sine2 = given.sines(x)
    a, b = sine1 / given.v1, sine2 / given.v2
    left, right = format_number(a, 4), format_number(b, 4)
    equal = left == right
    sides = (
        f"sin θ₁ / v₁ = {sine1:.4f} / {format_number(given.v1)} = {left}".replace("-", "−"),
        f"sin θ₂ / v₂ = {sine2:.4f} / {format_number(given.v2)} = {right}".replace("-", "−"),
    )
    time = f"time {given.time(x):.4f} s"
    least = f"least time {given.time(given.least):.4f} s at x = {given.least:.2f}"
    said = "equal: this is the path of least time" if equal else least
    brief = f"{left} {'=' if equal else '<' if a < b else '>'} {right}"
    forms = (
        [f"{sides[0]}     {sides[1]}", f"{time},  {said}"],
        [*sides, f"{time},  {said}"],
        [f"sin θ₁/v₁, sin θ₂/v₂: {brief}", f"{time}, {said}"],
        [f"sin θ/v: {brief}", "least time" if equal else time],
    )
    return next((form for form in forms if max(text_width(line, size) for line in form) <= wide), [])


class _Shore:
    """Beach and sea with the path, at the same scale in both directions."""

    def __init__(self, given: Lifeguard, x: float, where: Rectangle, size: float, theme: Theme, asks: bool) -> None:
        self.where, self.size, self.theme, self.given, self.asks = where, size, theme, given, asks
        left, top, right, bottom = where
        self.scale = min((right - left) / (ENDS[1] - ENDS[0]), (bottom - top) / (HIGH[1] - HIGH[0]))
        self.middle = (0.5 * (left + right), 0.5 * (top + bottom))
        self.marks: list[Mark] = []
        self._media()
        self._paths(x)
        self._names(x)

    def at(self, x: float, y: float) -> Point:
        return (
            self.middle[0] + self.scale * (x - 0.5 * sum(ENDS)),
            self.middle[1] - self.scale * (y - 0.5 * sum(HIGH)),
        )

    def _media(self) -> None:
        left, top, right, bottom = self.where
        shore = self.at(0.0, 0.0)[1]
        tints = (TINTS[self.given.v1 < self.given.v2], TINTS[self.given.v2 < self.given.v1])
        for name, ink, tint, first, last in (
            ("beach", self.theme.sun, tints[0], top, shore),
            ("sea", self.theme.glass, tints[1], shore, bottom),
        ):
            corners = ((left, first), (right, first), (right, last), (left, last))
            self.marks.append(Shape(name, corners, faded(ink, 1.6 * tint), None))
        self.marks.append(Line("shore", (left, shore), (right, shore), Stroke(self.theme.text, 2.0)))

    def _paths(self, x: float) -> None:
        theme, size = self.theme, self.size
        least = self.at(self.given.least, 0.0)
        guard, swimmer, cross = self.at(*GUARD), self.at(*SWIMMER), self.at(x, 0.0)
        for start, end in () if self.asks else ((guard, least), (least, swimmer)):
            self.marks.append(Line("least", start, end, Stroke(theme.normal, 1.6, (5.0, 4.0)), title="least time"))
        high = min(0.9 * (cross[1] - self.where[1]), 2.4 * self.scale)
        self.marks.append(
            Line(
                "normal", (cross[0], cross[1] - high), (cross[0], cross[1] + high), Stroke(theme.muted, 1.2, (3.0, 3.0))
            )
        )
        ink = Stroke(theme.accent, 2.8)
        self.marks += [Line("path", guard, cross, ink), Line("path", cross, swimmer, ink)]
        for place in (guard, swimmer):
            self.marks.append(Disc("person", place, 0.3 * size, theme.text, None))
        self._angles(x, cross)
        path = (self.at(ENDS[0], 0.0), self.at(ENDS[1], 0.0))
        self.marks.append(Handle("x", x, ENDS, path, theme.accent, title="drag to cross the shore elsewhere"))

    def _angles(self, x: float, cross: Point) -> None:
        radius = 1.1 * self.scale
        turns = [math.asin(sine) for sine in self.given.sines(x)]
        ink = Stroke(self.theme.text, 1.6)
        for name, begin, end in (("theta1", -turns[0], 0.0), ("theta2", math.pi - turns[1], math.pi)):
            self.marks.append(Shape(name, signs.arc(cross, radius, begin, end), None, ink, closed=False))

    def _names(self, x: float) -> None:
        """The names, dropped where the picture is too small for them."""
        size, theme = self.size, self.theme
        left, top, right, bottom = self.where
        v1, v2 = (format_number(v) for v in (self.given.v1, self.given.v2))
        pad = 0.5 * size
        labels = Labels(self.where, size, theme, self.marks)
        (cx, cy), away = self.at(x, 0.0), 1.1 * self.scale + 0.8 * size
        for name, foot, sine in zip(("θ₁", "θ₂"), (0.0, math.pi), self.given.sines(x), strict=True):
            turn = foot - 0.5 * math.asin(sine)
            lengths = [away + share * size for share in APART]
            places = [((cx + far * math.sin(turn), cy - far * math.cos(turn)), "middle") for far in lengths]
            labels.place("angle", [name], places, theme.text)
        right_top, left_low = (right - pad, top + 0.9 * size), (left + pad, bottom - 0.9 * size)
        forms = "{0}: v{1} = {2} m/s", "v{1} = {2} m/s", "v{1} = {2}"
        labels.place("beach", [form.format("beach", "₁", v1) for form in forms], [(right_top, "end")], theme.text)
        labels.place("sea", [form.format("sea", "₂", v2) for form in forms], [(left_low, "start")], theme.text)
        labels.beside("person", ["guard"], self.at(*GUARD), theme.text)
        labels.beside("person", ["swimmer"], self.at(*SWIMMER), theme.text)
        if not self.asks:
            labels.beside("least", ["least time"], self.at(self.given.least, 0.0), theme.normal, near=True)
        self.marks += labels.marks


def _graph(given: Lifeguard, x: float, where: Rectangle, size: float, theme: Theme, asks: bool) -> list[Mark]:
    """Travel time against the crossing point: the curve with its minimum, or only the point of this path."""
    least, slowest = given.time(given.least), max(map(given.time, ENDS))
    step = next(10.0**e * m for e in range(-12, 12) for m in (1, 2, 5) if 10.0**e * m * 5 >= slowest - 0.9 * least)
    low = step * math.floor(0.97 * least / step)
    high = step * math.ceil(slowest / step)
    steps = (step, 2.0 * step, high - low)
    plot = Plot(
        where,
        Axis(("x (m)",), *ENDS, (1.0, 2.0, 4.0)),
        Axis(("travel time (s)", "time (s)", "s"), low, high, steps),
        size,
        theme,
    )
    if not asks:
        _curve(plot, given, low, theme)
    plot.line("x", (x, low), (x, given.time(x)), Stroke(theme.accent, 1.4, (2.0, 3.0)))
    plot.point("point", x, given.time(x), theme.accent)
    if not asks:
        plot.label("least", [f"least time: {least:.3f} s", "least time", "least"], given.least, least, theme.normal)
    if asks or f"{x:.3f}" != f"{given.least:.3f}":
        plot.label("point", [f"{given.time(x):.3f} s"], x, given.time(x), theme.text)
    return plot.drawn()


def _curve(plot: Plot, given: Lifeguard, low: float, theme: Theme) -> None:
    """The time of all paths, and the least of them."""
    least = given.time(given.least)
    plot.line("least", (given.least, low), (given.least, least), Stroke(theme.normal, 1.4, (5.0, 4.0)))
    plot.curve("time", given.time, ENDS, Stroke(theme.ray("refraction"), 2.6))
    plot.point("least", given.least, least, theme.normal, hollow=True, title="least time")

"""The marks that figures consist of. Layouts make marks, writers write them to a file. All their text is printable, so
no writer has to care for control characters in the names of a scene.

Lengths are points (1/72 inch) from the canvas's top left corner, y downwards. The canvas is a slide of 16:9, so a
text of 18 points is 18 points high if the figure fills the slide.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import groupby

from tracer.printable import printable
from viewer.base.theme import Arrow, Color, blend
from viewer.explain.plain_formula import plain
from viewer.explain.sections import RayDetails
from viewer.figures.font import ANCHORS, text_box
from viewer.figures.formula.typeset import Contour, typeset

WIDTH, HEIGHT = 960.0, 540.0

Point = tuple[float, float]
Rectangle = tuple[float, float, float, float]  # left, top, right, bottom
Piece = tuple[Point, Point]

CANVAS: Rectangle = (0.0, 0.0, WIDTH, HEIGHT)


def clip_shares(piece: Piece, box: Rectangle) -> tuple[float, float] | None:
    """The part of a line segment inside a rectangle, from share to share of its length; None if it is outside.

    Liang & Barsky, ACM Trans. Graph. 3(1), 1984.
    """
    (x0, y0), (x1, y1) = piece
    if max(x0, x1) < box[0] or min(x0, x1) > box[2] or max(y0, y1) < box[1] or min(y0, y1) > box[3]:
        return None  # most of them
    enters, leaves = 0.0, 1.0
    for a, b, low, high in ((x0, x1, box[0], box[2]), (y0, y1, box[1], box[3])):
        if a == b:
            if not low <= a <= high:
                return None
            continue
        near, far = sorted(((low - a) / (b - a), (high - a) / (b - a)))
        enters, leaves = max(enters, near), min(leaves, far)
    return (enters, leaves) if enters < leaves else None


def overlap(a: Rectangle, b: Rectangle) -> bool:
    if a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]:
        return False
    return a[2] > a[0] and a[3] > a[1] and b[2] > b[0] and b[3] > b[1]


def inside(point: Point, box: Rectangle) -> bool:
    return box[0] < point[0] < box[2] and box[1] < point[1] < box[3]


def within(box: Rectangle, outer: Rectangle) -> bool:
    return box[0] >= outer[0] and box[1] >= outer[1] and box[2] <= outer[2] and box[3] <= outer[3]


def widened(box: Rectangle, by: float) -> Rectangle:
    """The rectangle, wider by this length on each side."""
    return (box[0] - by, box[1] - by, box[2] + by, box[3] + by)


def point_along(piece: Piece, share: float) -> Point:
    (x0, y0), (x1, y1) = piece
    return (x0 + share * (x1 - x0), y0 + share * (y1 - y0))


def clipped(piece: Piece, box: Rectangle) -> Piece | None:
    """The part of a line segment inside a rectangle; None if it is outside."""
    shares = clip_shares(piece, box)
    return (point_along(piece, shares[0]), point_along(piece, shares[1])) if shares else None


@dataclass(frozen=True)
class Stroke:
    color: Color
    width: float
    dash: tuple[float, float] = (0.0, 0.0)  # on and off; (0, 0): solid

    def times(self, share: float) -> "Stroke":
        """The stroke `share` times as thick."""
        on, off = self.dash
        return Stroke(self.color, share * self.width, (share * on, share * off))


def make_printable(made: object, *names: str) -> None:
    """Make these texts of a new, frozen dataclass printable."""
    for name in names:
        object.__setattr__(made, name, printable(getattr(made, name)))


@dataclass(frozen=True)
class Mark:
    """`name` identifies the object that the mark shows, like `ray-3`; marks with the same name belong together. `title`
    is shown as a tooltip.
    """

    name: str
    title: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        make_printable(self, "name", "title")


@dataclass(frozen=True)
class Box(Mark):
    """A rectangle around `center`. The text in it has its name as `inside`."""

    center: Point
    size: tuple[float, float]
    radius: float  # of its corners
    fill: Color | None
    stroke: Stroke | None


@dataclass(frozen=True)
class Disc(Mark):
    center: Point
    radius: float
    fill: Color | None
    stroke: Stroke | None


@dataclass(frozen=True)
class Shape(Mark):
    """An outline through these corners. If it is not closed, it is a curve without a fill."""

    corners: tuple[Point, ...]
    fill: Color | None
    stroke: Stroke | None
    closed: bool = True
    holes: tuple[tuple[Point, ...], ...] = ()


@dataclass(frozen=True)
class Line(Mark):
    """A line between two points, interrupted by its label (`hole`: left, top, right, bottom).

    If it leaves or reaches a box, `leaves` and `reaches` are the names of these marks.
    """

    start: Point
    end: Point
    stroke: Stroke
    arrow: Arrow = Arrow.NONE
    arrow_at: float = 0.5  # place of the arrow's tip, relative to the line's length
    leaves: str = ""
    reaches: str = ""
    hole: Rectangle | None = None

    def at(self, share: float) -> Point:
        return point_along((self.start, self.end), share)

    def pieces(self) -> list[Piece]:
        """The drawn parts of the line."""
        if self.hole is None:
            return [(self.start, self.end)]
        inside = clip_shares((self.start, self.end), self.hole)
        if inside is None:
            return [(self.start, self.end)]
        enters, leaves = inside
        return [piece for piece in ((self.start, self.at(enters)), (self.at(leaves), self.end)) if piece[0] != piece[1]]


@dataclass(frozen=True)
class Text(Mark):
    """One line of text. `at` is its middle, or its left or right end."""

    at: Point
    content: str
    size: float
    color: Color
    anchor: str = "middle"  # start, middle, end
    inside: str = ""  # the box that the text stands in
    on_line: bool = False  # it interrupts the line that it stands on

    def __post_init__(self) -> None:
        make_printable(self, "name", "title", "content")

    def box(self) -> Rectangle:
        return text_box(self.at, self.content, self.size, self.anchor)


@dataclass(frozen=True)
class Formula(Mark):
    """One line of a formula. `at` is the middle, the left or the right end of its baseline, `size` the size of its
    font, `source` LaTeX, of the part that `viewer.explain.plain_formula` reads.
    """

    source: str
    at: Point
    size: float
    color: Color
    anchor: str = "middle"  # start, middle, end

    def __post_init__(self) -> None:
        make_printable(self, "name", "title", "source")

    @property
    def plain(self) -> str:
        """The formula as plain text, for readers who cannot see it."""
        return plain(self.source)

    def origin(self) -> Point:
        """The left end of the baseline."""
        left, _, right, _ = typeset(self.source).box
        return (self.at[0] - self.size * (left + ANCHORS[self.anchor] * (right - left)), self.at[1])

    def box(self) -> Rectangle:
        x, y = self.origin()
        left, top, right, bottom = (self.size * side for side in typeset(self.source).box)
        return (x + left, y + top, x + right, y + bottom)

    def outlines(self) -> list[list[Contour]]:
        """The contours of each glyph or bar, with segments as in `Typeset`."""
        origin = self.origin()

        def placed(segment: tuple[float, ...]) -> tuple[float, ...]:
            return tuple(origin[k % 2] + self.size * place for k, place in enumerate(segment))

        return [[tuple(map(placed, contour)) for contour in outline] for outline in typeset(self.source).outlines]


@dataclass(frozen=True)
class Raster(Mark):
    """An image in a rectangle around `center`. Its pixels are rectangles: nothing between them is interpolated."""

    center: Point
    size: tuple[float, float]
    shape: tuple[int, int]  # width and height in pixels
    pixels: bytes = field(repr=False)  # 8-bit sRGB, row by row from the top left


@dataclass(frozen=True)
class Handle(Mark):
    """A disc that is dragged along a path and changes a parameter of the figure, where a figure can be changed. A file
    does not show it.

    Its name is the parameter's. `path` are places at equal steps of the value, from the lowest to the highest.
    """

    value: float
    range: tuple[float, float]  # the lowest and the highest value
    path: tuple[Point, ...]
    color: Color

    @property
    def at(self) -> Point:
        """The place of its value."""
        low, high = self.range
        step = min(1.0, max(0.0, (self.value - low) / (high - low))) * (len(self.path) - 1)
        k = min(int(step), len(self.path) - 2)
        return point_along((self.path[k], self.path[k + 1]), step - k)


def with_line_width(mark: Mark, share: float) -> Mark:
    """The mark with its lines `share` times as thick."""
    stroke = getattr(mark, "stroke", None)
    return replace(mark, stroke=stroke.times(share)) if stroke else mark  # type: ignore[call-arg]


def blended(mark: Mark, share: float, paper: Color) -> Mark:
    """The mark with its colours blended with the paper's. It is as opaque as before. `share` is that of its own."""
    changed: dict[str, object] = {
        name: blend(color, share, paper) for name in ("fill", "color") if (color := getattr(mark, name, None))
    }
    stroke = getattr(mark, "stroke", None)
    if stroke:
        changed["stroke"] = replace(stroke, color=blend(stroke.color, share, paper))
    return replace(mark, **changed)  # type: ignore[arg-type]


@dataclass(frozen=True)
class Figure:
    """One page."""

    title: str
    description: str  # for readers who cannot see the figure
    command: str  # that makes the figure again
    marks: tuple[Mark, ...]
    paper: Color  # the background that it is made for
    ground: bool = False  # whether it has that background; otherwise it is transparent
    width: float = WIDTH
    height: float = HEIGHT
    embedded: bytes = b""  # the view and its scene, to be reopened (`viewer.reopen.embedded`)
    # For formats that are read on a screen (`pages.with_details`, `pages.with_upright`):
    details: tuple[RayDetails, ...] = ()  # of the rays that have marks
    upright: tuple["Figure", ...] = ()  # the same, or its parts, for a phone that is held upright

    def __post_init__(self) -> None:
        make_printable(self, "title", "description", "command")

    def groups(self) -> Iterator[tuple[str, str, list[Mark]]]:
        """(name, title, marks) for each run of marks with the same name."""
        for name, marks in groupby(self.marks, key=lambda mark: mark.name):
            group = list(marks)
            yield name, next((mark.title for mark in group if mark.title), ""), group

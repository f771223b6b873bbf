"""Figures in the window: marks drawn into an imgui draw list.

Text is drawn in the window's font, whose letters are narrower than those that figures are laid out for.
"""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from imgui_bundle import imgui

from viewer.base.theme import Color
from viewer.figures import signs
from viewer.figures.font import ANCHORS, BASELINE
from viewer.figures.marks import (
    Box,
    Disc,
    Formula,
    Handle,
    Line,
    Mark,
    Piece,
    Point,
    Raster,
    Shape,
    Stroke,
    Text,
    point_along,
)
from viewer.figures.writers.arrows import heads
from viewer.figures.writers.imgui_atlas import images
from viewer.figures.writers.imgui_formula import draw_formula
from viewer.figures.writers.raster import raster_pixels

EM = 2048 / 2400  # of the window's font, over its size for imgui, which is the distance from ascender to descender
HALF = 0.5  # pixels by which imgui moves the outline of a rectangle inwards
HANDLE = (7.0, 1.4)  # points: radius of a handle, and width of its dark rim
CORNERS = 24  # of the arcs of the smallest discs


def draw_marks(pad: imgui.ImDrawList, marks: Iterable[Mark], corner: Point, scale: float) -> None:
    """Draw marks whose canvas has its top left at `corner`, in pixels. `scale` is pixels per point."""
    writer = _Writer(pad, corner, scale)
    for mark in marks:
        writer.draw(mark)


def _ink(color: Color) -> int:
    return imgui.get_color_u32(color)


def _text_width(content: str, size: float) -> float:
    """The width of a text at this size. That at another size, times a factor, differs, since advances are rounded."""
    style = imgui.get_style()
    imgui.push_font(None, size / (style.font_scale_main * style.font_scale_dpi))
    width = imgui.calc_text_size(content).x * size / imgui.get_font_size()  # which is a whole number
    imgui.pop_font()
    return width


class _Writer:
    def __init__(self, pad: imgui.ImDrawList, corner: Point, scale: float) -> None:
        self.pad = pad
        self.corner = corner
        self.scale = scale

    def draw(self, mark: Mark) -> None:
        match mark:
            case Text():
                self._text(mark)
            case Line():
                self._line(mark)
            case Box():
                self._box(mark)
            case Disc():
                self._disc(mark)
            case Shape():
                self._shape(mark)
            case Handle():
                self._handle(mark)
            case Raster():
                self._raster(mark)
            case Formula():
                draw_formula(self.pad, mark, self.corner, self.scale)
            case _:
                raise TypeError(f"the window cannot draw a {type(mark).__name__}")

    def _at(self, point: Point) -> Point:
        return (self.corner[0] + self.scale * point[0], self.corner[1] + self.scale * point[1])

    def _text(self, text: Text) -> None:
        size = float(round(text.size * self.scale / EM))  # at a fraction of a pixel letters would be drawn resampled
        x, y = self._at(text.at)
        share, font = ANCHORS[text.anchor], imgui.get_font()
        width = _text_width(text.content, size) if share else 0.0
        top = y + BASELINE * text.size * self.scale - font.get_font_baked(size).ascent
        # Between two pixels, letters blur.
        place = (round(x - share * width), round(top))
        self.pad.add_text(font, size, place, _ink(text.color), text.content)

    def _line(self, line: Line) -> None:
        along = 0.0
        for a, b in line.pieces():
            along = self._stroke((self._at(a), self._at(b)), line.stroke, along)
        ink, width = _ink(line.stroke.color), max(1.0, line.stroke.width * self.scale)
        for corners, filled in heads(line):
            side, tip, other = map(self._at, corners)
            if filled:
                self.pad.add_triangle_filled(side, tip, other, ink)
            else:
                self.pad.add_polyline([imgui.ImVec2(*point) for point in (side, tip, other)], ink, width, 0)

    def _stroke(self, piece: Piece, stroke: Stroke, along: float = 0.0) -> float:
        """Draw a line between two places on the screen. `along` is its place in the pattern of dashes; returns that of
        its end.
        """
        ink, width = _ink(stroke.color), max(1.0, stroke.width * self.scale)
        on, off = (length * self.scale for length in stroke.dash)
        span = math.dist(*piece)
        if on + off <= 0.0 or span == 0.0:
            self.pad.add_line(*piece, ink, width)
            return 0.0
        at = -(along % (on + off))
        while at < span:
            begin, end = max(at, 0.0), min(at + on, span)
            if end > begin:
                self.pad.add_line(point_along(piece, begin / span), point_along(piece, end / span), ink, width)
            at += on + off
        return along + span

    def _box(self, box: Box) -> None:
        (x, y), (w, h) = box.center, box.size
        first, last = self._at((x - 0.5 * w, y - 0.5 * h)), self._at((x + 0.5 * w, y + 0.5 * h))
        radius = box.radius * self.scale
        if box.fill:
            self.pad.add_rect_filled(first, last, _ink(box.fill), radius)
        if box.stroke and not any(box.stroke.dash):
            first, last = (first[0] - HALF, first[1] - HALF), (last[0] + HALF, last[1] + HALF)
            self.pad.add_rect(first, last, _ink(box.stroke.color), radius, max(1.0, box.stroke.width * self.scale))
        elif box.stroke:
            self._outline(_rounded(box), box.stroke)

    def _disc(self, disc: Disc) -> None:
        at, radius = self._at(disc.center), disc.radius * self.scale
        if disc.fill:
            self.pad.add_circle_filled(at, radius, _ink(disc.fill), CORNERS if radius < CORNERS else 0)
        if disc.stroke:
            width = max(1.0, disc.stroke.width * self.scale)
            self.pad.add_circle(at, radius, _ink(disc.stroke.color), 0, width)

    def _raster(self, raster: Raster) -> None:
        """Draw an image pixel by pixel of the screen, so that its own pixels have sharp borders."""
        (x, y), (w, h) = raster.center, raster.size
        left, top = map(round, self._at((x - 0.5 * w, y - 0.5 * h)))
        right, bottom = map(round, self._at((x + 0.5 * w, y + 0.5 * h)))
        size = (max(1, right - left), max(1, bottom - top))

        def fill(pixels: np.ndarray) -> None:
            rows, columns = (np.arange(n) * of // n for n, of in zip(size[::-1], raster.shape[::-1], strict=True))
            pixels[..., :3] = raster_pixels(raster)[rows[:, None], columns[None, :]]

        place = images.rectangle((raster.pixels, raster.shape, size), size, fill)
        if place:
            texture = imgui.get_io().fonts.tex_data.get_tex_ref()
            self.pad.add_image(texture, (left, top), (left + size[0], top + size[1]), place.uv0, place.uv1)

    def _handle(self, handle: Handle) -> None:
        at, (radius, rim) = self._at(handle.at), (length * self.scale for length in HANDLE)
        self.pad.add_circle_filled(at, radius, _ink((0.0, 0.0, 0.0, 0.6)))
        self.pad.add_circle_filled(at, radius - 0.6 * rim, _ink((1.0, 1.0, 1.0, 1.0)))
        self.pad.add_circle_filled(at, radius - 1.8 * rim, _ink(handle.color))

    def _shape(self, shape: Shape) -> None:
        if shape.fill and shape.closed and shape.holes:
            self._fill_rings((shape.corners, *shape.holes), _ink(shape.fill))
        elif shape.fill and shape.closed:
            corners = shape.corners if _is_clockwise(shape.corners) else shape.corners[::-1]
            points: list[imgui.ImVec2Like] = [imgui.ImVec2(*self._at(corner)) for corner in corners]
            self.pad.add_concave_poly_filled(points, _ink(shape.fill))
        if not shape.stroke:
            return
        for ring in (shape.corners, *shape.holes):
            self._outline(ring, shape.stroke, shape.closed)

    def _outline(self, outline: Sequence[Point], stroke: Stroke, closed: bool = True) -> None:
        """Draw a curve. A pattern of dashes goes on around its corners."""
        if not any(stroke.dash):
            width = max(1.0, stroke.width * self.scale)
            flags = imgui.ImDrawFlags_.closed if closed else 0
            self.pad.add_polyline([imgui.ImVec2(*self._at(p)) for p in outline], _ink(stroke.color), width, flags)
            return
        ends = [*outline[1:], outline[0]] if closed else outline[1:]
        along = 0.0
        for a, b in zip(outline, ends, strict=False):
            along = self._stroke((self._at(a), self._at(b)), stroke, along)

    def _fill_rings(self, rings: tuple[tuple[Point, ...], ...], ink: int) -> None:
        """Fill an outline with holes."""
        import mapbox_earcut

        corners = np.array([corner for ring in rings for corner in ring], dtype=np.float64)
        ends = np.cumsum([len(ring) for ring in rings]).astype(np.uint32)
        triangles = mapbox_earcut.triangulate_float64(corners, ends).reshape(-1, 3)
        for triangle in triangles.tolist():
            a, b, c = (self._at((float(x), float(y))) for x, y in corners[triangle])
            self.pad.add_triangle_filled(a, b, c, ink)


def _is_clockwise(outline: Sequence[Point]) -> bool:
    """Whether the corners go round clockwise on the screen: imgui fills a concave outline in this order only."""
    around = zip(outline, (*outline[1:], outline[0]), strict=True)
    return sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in around) >= 0.0


def _rounded(box: Box) -> list[Point]:
    """The outline of a box with round corners, clockwise from the left end of its upper side."""
    (x, y), (w, h) = box.center, box.size
    r = min(box.radius, 0.5 * w, 0.5 * h)
    outline = [(x - 0.5 * w + r, y - 0.5 * h)]
    for quarter, (right, down) in enumerate(((1, -1), (1, 1), (-1, 1), (-1, -1))):
        middle = (x + right * (0.5 * w - r), y + down * (0.5 * h - r))
        outline += signs.arc(middle, r, 0.5 * math.pi * quarter, 0.5 * math.pi * (quarter + 1))
    return outline

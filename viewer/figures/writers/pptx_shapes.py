"""Marks as shapes on a slide of a PPTX."""

import io
from collections.abc import Sequence
from typing import Any, TypeGuard

from viewer.base.theme import Arrow, Color, rgb_bytes
from viewer.figures.font import ANCHORS, FAMILY, text_width
from viewer.figures.formula.typeset import Contour
from viewer.figures.marks import Box, Disc, Figure, Formula, Line, Mark, Point, Raster, Rectangle, Shape, Stroke, Text
from viewer.figures.writers.raster import raster_png

EMU = 12_700  # PowerPoint's units per point
HEADS = {Arrow.FILLED: "triangle", Arrow.OPEN: "arrow", Arrow.DOUBLE: "stealth"}
A = "{http://schemas.openxmlformats.org/drawingml/2006/main}"


class SlideDrawing:
    """Draws a figure on a slide. Every shape has the name of its mark."""

    def __init__(self, shapes: Any, figure: Figure) -> None:
        self.shapes, self.figure = shapes, figure
        self.boxes: dict[str, Any] = {}
        self.words: dict[str, list[Text]] = {}
        for mark in figure.marks:
            if _fills_box(mark):
                self.words.setdefault(mark.inside, []).append(mark)

    def draw(self) -> None:
        """Draw the marks, boxes first: connectors are glued to boxes, which lie on nothing but the background."""
        for mark in self.figure.marks:
            if isinstance(mark, Box):
                self._box(mark)
        for mark in self.figure.marks:
            if isinstance(mark, Line) and (mark.leaves or mark.reaches):
                self._line(mark, self.shapes)
        signs: dict[str, Any] = {}
        for mark in self.figure.marks:
            if isinstance(mark, Box) or _fills_box(mark):
                continue
            if isinstance(mark, Text):
                self._text(mark)
            elif isinstance(mark, Formula):
                self._formula(mark)
            elif not isinstance(mark, Line) or not (mark.leaves or mark.reaches):
                if mark.name not in signs:
                    signs[mark.name] = self.shapes.add_group_shape()
                    _name(signs[mark.name], f"{mark.name} sign", mark.title)
                self._piece(mark, signs[mark.name].shapes)

    def _box(self, box: Box) -> None:
        from pptx.enum.shapes import MSO_SHAPE

        (x, y), (w, h) = box.center, box.size
        made = self.shapes.add_shape(MSO_SHAPE.ROUNDED_RECTANGLE, *emu_box(x - w / 2, y - h / 2, w, h))
        made.adjustments[0] = box.radius / min(w, h)
        _name(made, box.name, box.title)
        _look(made, box.fill, box.stroke)
        words = self.words.get(box.name, [])
        if words:
            frame = made.text_frame
            aside = 2.0 * (words[0].at[0] - x)
            frame.margin_left, frame.margin_right = (emu(max(0.0, side)) for side in (aside, -aside))
            _write(frame, words, "middle")
            frame.word_wrap = False
        self.boxes[box.name] = made

    def _line(self, line: Line, shapes: Any) -> None:
        from pptx.enum.shapes import MSO_CONNECTOR

        made = shapes.add_connector(MSO_CONNECTOR.STRAIGHT, *map(emu, (*line.start, *line.end)))
        _name(made, line.name, line.title)
        _ink(made.line, line.stroke)
        if line.arrow in HEADS:
            made.line._get_or_add_ln().append(_element("tailEnd", type=HEADS[line.arrow], w="lg", len="med"))
        if line.leaves in self.boxes:
            made.begin_connect(self.boxes[line.leaves], self._side(line.leaves, line.start))
        if line.reaches in self.boxes:
            made.end_connect(self.boxes[line.reaches], self._side(line.reaches, line.end))

    def _side(self, name: str, at: Point) -> int:
        """The number of the side of a box that a point lies on: top, left, bottom, right."""
        box = next(mark for mark in self.figure.marks if isinstance(mark, Box) and mark.name == name)
        (x, y), (w, h) = box.center, box.size
        away = (abs(at[1] - (y - h / 2)), abs(at[0] - (x - w / 2)), abs(at[1] - (y + h / 2)), abs(at[0] - (x + w / 2)))
        return away.index(min(away))

    def _piece(self, mark: Mark, shapes: Any) -> None:
        match mark:
            case Disc():
                from pptx.enum.shapes import MSO_SHAPE

                (x, y), r = mark.center, mark.radius
                made = shapes.add_shape(MSO_SHAPE.OVAL, *emu_box(x - r, y - r, 2 * r, 2 * r))
                _name(made, mark.name, "")
                _look(made, mark.fill, mark.stroke)
            case Raster(center=(x, y), size=(w, h)):
                place = emu_box(x - 0.5 * w, y - 0.5 * h, w, h)
                _name(shapes.add_picture(io.BytesIO(raster_png(mark)), *place), mark.name, "")
            case Shape():
                self._outline(mark, shapes)
            case Line():
                self._line(mark, shapes)
            case _:
                raise TypeError(f"no PPTX for {type(mark).__name__}")

    def _outline(self, shape: Shape, shapes: Any) -> None:
        builder = shapes.build_freeform(*map(emu, shape.corners[0]), scale=1.0)
        builder.add_line_segments([(emu(x), emu(y)) for x, y in shape.corners[1:]], close=shape.closed)
        for hole in shape.holes:
            builder.move_to(*map(emu, hole[0]))
            builder.add_line_segments([(emu(x), emu(y)) for x, y in hole[1:]], close=True)
        made = builder.convert_to_shape()
        _name(made, shape.name, "")
        _look(made, shape.fill, shape.stroke)

    def _formula(self, formula: Formula) -> None:
        """A group with an outline for each glyph, and the formula as alternative text."""
        from pptx.oxml import parse_xml

        group = self.shapes.add_group_shape()
        _name(group, f"{formula.name} formula", formula.plain)
        for outline in formula.outlines():
            places = [place for contour in outline for segment in contour for place in segment]
            box = (min(places[::2]), min(places[1::2]), max(places[::2]), max(places[1::2]))
            builder = group.shapes.build_freeform(emu(box[0]), emu(box[1]), scale=1.0)
            builder.add_line_segments([(emu(box[2]), emu(box[3]))], close=True)
            made = builder.convert_to_shape()
            (path,) = made._element.xpath(".//a:path")
            path.getparent().replace(path, parse_xml(_curves(outline, box)))
            _name(made, formula.name, "")
            _look(made, formula.color, None)
        group._element.recalculate_extents()

    def _text(self, text: Text) -> None:
        """Draw a text in a frame a little wider than its width, since another font may be wider."""
        width, height = 1.15 * text_width(text.content, text.size) + 4.0, 1.2 * text.size
        left = text.at[0] - ANCHORS[text.anchor] * width
        made = self.shapes.add_textbox(*emu_box(left, text.at[1] - 0.5 * height, width, height))
        _name(made, f"{text.name} label", "")
        if text.on_line:
            paint(made.fill, self.figure.paper)
        made.text_frame.margin_left = made.text_frame.margin_right = 0
        _write(made.text_frame, [text], text.anchor)


def _fills_box(mark: Mark) -> TypeGuard[Text]:
    """Whether it is the text of a box; a text at one end of it is a frame of its own."""
    return isinstance(mark, Text) and bool(mark.inside) and mark.anchor == "middle"


def _curves(outline: Sequence[Contour], box: Rectangle) -> str:
    """The path of a custom geometry, which may have parabolas, relative to its box."""
    left, top, right, bottom = map(emu, box)

    def points(segment: Sequence[float]) -> str:
        pairs = zip(segment[::2], segment[1::2], strict=True)
        return "".join(f'<a:pt x="{emu(x) - left}" y="{emu(y) - top}"/>' for x, y in pairs)

    parts = []
    for start, *rest in outline:
        parts.append(f"<a:moveTo>{points(start)}</a:moveTo>")
        for segment in rest:
            kind = "lnTo" if len(segment) == 2 else "quadBezTo"
            parts.append(f"<a:{kind}>{points(segment)}</a:{kind}>")
        parts.append("<a:close/>")
    return f'<a:path xmlns:a="{A[1:-1]}" w="{right - left}" h="{bottom - top}">{"".join(parts)}</a:path>'


def _write(frame: Any, words: Sequence[Text], anchor: str) -> None:
    from pptx.enum.text import MSO_ANCHOR, PP_ALIGN
    from pptx.util import Pt

    frame.margin_top = frame.margin_bottom = 0
    frame.word_wrap = True  # otherwise programs misplace text that is not centred
    frame.vertical_anchor = MSO_ANCHOR.MIDDLE
    for k, text in enumerate(words):
        paragraph = frame.paragraphs[0] if k == 0 else frame.add_paragraph()
        paragraph.alignment = {"start": PP_ALIGN.LEFT, "middle": PP_ALIGN.CENTER, "end": PP_ALIGN.RIGHT}[anchor]
        run = paragraph.add_run()
        run.text = text.content
        run.font.size, run.font.name = Pt(text.size), FAMILY
        run.font.color.rgb = rgb_color(text.color)


def _look(shape: Any, fill: Color | None, stroke: Stroke | None) -> None:
    if fill:
        paint(shape.fill, fill)
    else:
        shape.fill.background()
    if stroke:
        _ink(shape.line, stroke)
    else:
        shape.line.fill.background()


def _ink(line: Any, stroke: Stroke) -> None:
    from pptx.util import Pt

    line.width = Pt(stroke.width)
    paint(line.fill, stroke.color)
    if any(stroke.dash):
        dash = _element("custDash")
        on, off = (round(100_000 * x / stroke.width) for x in stroke.dash)
        dash.append(_element("ds", d=str(on), sp=str(off)))
        line._get_or_add_ln().append(dash)


def paint(fill: Any, color: Color) -> None:
    """Give an area one colour."""
    fill.solid()
    fill.fore_color.rgb = rgb_color(color)
    if color[3] < 1.0:
        fill._xPr.find(f"{A}solidFill/{A}srgbClr").append(_element("alpha", val=str(round(100_000 * color[3]))))


def rgb_color(color: Color) -> Any:
    """A colour without its opacity."""
    from pptx.dml.color import RGBColor

    return RGBColor(*rgb_bytes(color))


def _element(name: str, **attributes: str) -> Any:
    from pptx.oxml.xmlchemy import OxmlElement

    element = OxmlElement(f"a:{name}")
    for key, value in attributes.items():
        element.set(key, value)
    return element


def _name(shape: Any, name: str, title: str) -> None:
    """Set the name, and the title as alternative text. Removes the template's style, which would draw shadows."""
    for style in shape._element.xpath("./p:style"):
        shape._element.remove(style)
    shape.name = name
    if title:
        shape._element.xpath(".//p:cNvPr")[0].set("descr", title)


def emu(points: float) -> int:
    """A length in PowerPoint's units."""
    return round(EMU * points)


def emu_box(left: float, top: float, width: float, height: float) -> tuple[int, int, int, int]:
    """A rectangle in PowerPoint's units."""
    return (emu(left), emu(top), emu(width), emu(height))

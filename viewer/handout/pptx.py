"""A lesson as PPTX: a slide for each moment, with its title, its text, vector figures and speaker notes.

Every shape has a name that no other shape of its slide has, and that the same thing has on the other slides. It begins
with `!!`: PowerPoint's transition Morph then pairs the shapes, so that a tree grows from slide to slide. Programs that
do not know Morph fade.
"""

import io
import re
from collections.abc import Callable, Iterator, Sequence
from itertools import count, groupby
from typing import Any

from tracer.printable import printable
from tracer.tree.raytree import RayTree
from viewer.base.pictures import png
from viewer.base.theme import Color, Theme
from viewer.figures.font import FAMILY
from viewer.figures.marks import WIDTH, Disc, Figure, Formula, Stroke
from viewer.figures.writers.pptx import new_deck, saved
from viewer.figures.writers.pptx_shapes import A, SlideDrawing, emu, emu_box, paint, rgb_color
from viewer.handout.document import Handout, paper
from viewer.handout.slides import FOOT, FOOT_SIZE, HEAD, MARGIN, RING, RINGS, TITLE, Placed, Slide, slides_of
from viewer.handout.text_lines import LINE, BlockLines
from viewer.lessons.language import web_tag

TITLE_ONLY = 5  # of the default template's layouts
MONO = "DejaVu Sans Mono"
WIDER = 6.0  # points by which a frame is wider than its text, since another font may be wider
ROW = re.compile(r"^(\w+)-(\d+)")  # the name of a mark of a ray: its kind and row
# Morph is an extension of 2015; older programs take the fallback.
TRANSITION = """
<mc:AlternateContent xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006">
  <mc:Choice xmlns:p159="http://schemas.microsoft.com/office/powerpoint/2015/09/main" Requires="p159">
    <p:transition xmlns:p="http://schemas.openxmlformats.org/presentationml/2006/main"
        xmlns:p14="http://schemas.microsoft.com/office/powerpoint/2010/main" spd="slow" p14:dur="900">
      <p159:morph option="byObject"/>
    </p:transition>
  </mc:Choice>
  <mc:Fallback>
    <p:transition xmlns:p="http://schemas.openxmlformats.org/presentationml/2006/main" spd="slow">
      <p:fade/>
    </p:transition>
  </mc:Fallback>
</mc:AlternateContent>"""


def write_slides(handout: Handout, command: str, theme: str) -> bytes:
    """The presentation. Unusable without the extra."""
    colors = paper(theme)
    lesson = handout.lesson
    deck = new_deck(Figure(lesson.title, lesson.question, command, (), colors.ground))
    for slide in slides_of(handout, colors):
        _Writer(deck, slide, colors, web_tag(lesson.language)).write()
    return saved(deck)


class _Writer:
    def __init__(self, deck: Any, slide: Slide, theme: Theme, language: str) -> None:
        self.slide, self.theme, self.language = slide, theme, language
        self.made = deck.slides.add_slide(deck.slide_layouts[TITLE_ONLY])
        self.shapes = self.made.shapes

    def write(self) -> None:
        paint(self.made.background.fill, self.theme.ground)
        self._title()
        self._text()
        for placed in self.slide.pictures:
            self._picture(placed)
        if self.slide.place:
            self._place()
        if self.slide.notes:
            notes = "\n".join(map(printable, self.slide.notes.split("\n")))
            self.made.notes_slide.notes_text_frame.text = notes
        _make_unique(self.shapes)
        from pptx.oxml import parse_xml

        self.made._element.append(parse_xml(TRANSITION))

    def _title(self) -> None:
        title = self.shapes.title
        title.left, title.top, title.width, title.height = emu_box(MARGIN, 14.0, WIDTH - 2.0 * MARGIN, HEAD - 20.0)
        title.name = "title"
        frame = title.text_frame
        _cleared(frame)
        self._run(frame.paragraphs[0], printable(self.slide.title), TITLE, self.theme.text, bold=True)
        _align_left(frame.paragraphs[0])

    def _text(self) -> None:
        """A frame for the text up to each formula in lines of its own, which is a vector."""
        text, (left, top, right, _) = self.slide.text, self.slide.text_box
        for number, group in enumerate(_groups(text.blocks), 1):
            first, last = group[0].top, group[-1].bottom
            if group[0].kind == "formula":
                words = [word for block in group for word in block.words]
                marks = [
                    Formula("formula", w.content, (left + w.at[0], top + w.at[1]), w.size, self.theme.text, "start")
                    for w in words
                ]
                SlideDrawing(self.shapes, Figure("", "", "", tuple(marks), self.theme.ground)).draw()
                continue
            box = emu_box(left, top + first, min(right - left, text.width + WIDER), last - first)
            made = self.shapes.add_textbox(*box)
            made.name = f"text {number}"
            frame = _cleared(made.text_frame)
            for k, block in enumerate(group):
                paragraph = frame.paragraphs[0] if k == 0 else frame.add_paragraph()
                self._paragraph(paragraph, block, group[k + 1] if k + 1 < len(group) else None)

    def _paragraph(self, paragraph: Any, block: BlockLines, following: BlockLines | None) -> None:
        from pptx.util import Pt

        size = block.words[0].size if block.words else self.slide.text.size
        _align_left(paragraph)
        paragraph.line_spacing = Pt(LINE * size)
        if block.left:
            _indent(paragraph, block)
        if block.columns[1:]:
            _tabs(paragraph, block.columns[1:])
        if following:
            paragraph.space_after = Pt(max(0.0, following.top - block.bottom))
        before = " "
        for word in block.words:
            content = word.style.text if word.is_formula else word.content
            if word.at[0] in block.columns[1:]:
                content = f"\t{content}"
            elif word.is_formula and not before.endswith(" "):
                content = f" {content}"
            style, color = word.style, self.slide.color(word, self.theme)
            self._run(paragraph, content, size, color, style.bold, style.italic, style.code)
            before = content

    def _run(
        self, paragraph: Any, content: str, size: float, color: Color, bold: bool = False, italic: bool = False,
        code: bool = False,
    ) -> None:  # fmt: skip
        from pptx.util import Pt

        run = paragraph.add_run()
        run.text = content
        run.font.size, run.font.name = Pt(size), MONO if code else FAMILY
        run.font.bold, run.font.italic = bold, italic
        run.font.color.rgb = rgb_color(color)
        run.font._element.set("lang", self.language)

    def _place(self) -> None:
        frame = self.shapes.add_textbox(*emu_box(MARGIN, FOOT, WIDTH - 2.0 * MARGIN, 1.5 * FOOT_SIZE))
        frame.name = "place"
        paragraph = _cleared(frame.text_frame).paragraphs[0]
        self._run(paragraph, printable(self.slide.place), FOOT_SIZE, self.theme.muted)
        from pptx.enum.text import PP_ALIGN

        paragraph.alignment = PP_ALIGN.RIGHT

    def _picture(self, placed: Placed) -> None:
        """A picture: its shapes in place, named by the rays that they show."""
        before = len(self.shapes)
        if placed.photo is not None:
            self._photo(placed)
            return
        figure = Figure(placed.title, placed.said, "", placed.marks, self.theme.ground)
        SlideDrawing(self.shapes, figure).draw()
        name = _namer(placed.kind, placed.tree)
        for shape in list(self.shapes)[before:]:
            shape.name = name(shape.name)

    def _photo(self, placed: Placed) -> None:
        assert placed.photo
        left, top, right, bottom = placed.where
        picture = self.shapes.add_picture(
            io.BytesIO(png(placed.photo.pixels)), *emu_box(left, top, right - left, bottom - top)
        )
        picture.name = "image"
        picture._element.xpath(".//p:cNvPr")[0].set("descr", printable(placed.said))
        if placed.ring:
            marks = tuple(Disc("ring", placed.ring, RING, None, Stroke(*look)) for look in RINGS)
            SlideDrawing(self.shapes, Figure("", "", "", marks, self.theme.ground)).draw()


def _groups(blocks: Sequence[BlockLines]) -> Iterator[list[BlockLines]]:
    """Neighbours that are both text, or both formulas in lines of their own."""
    for _, group in groupby(blocks, key=lambda block: block.kind == "formula"):
        yield list(group)


def _cleared(frame: Any) -> Any:
    """A text frame without margins, whose lines begin at its top left."""
    from pptx.enum.text import MSO_ANCHOR

    frame.margin_left = frame.margin_right = frame.margin_top = frame.margin_bottom = 0
    frame.vertical_anchor = MSO_ANCHOR.TOP
    frame.word_wrap = True
    return frame


def _align_left(paragraph: Any) -> None:
    from pptx.enum.text import PP_ALIGN

    paragraph.alignment = PP_ALIGN.LEFT


def _indent(paragraph: Any, block: BlockLines) -> None:
    """Indent a paragraph, with its mark on the left if it is an item of a list."""
    properties = paragraph._p.get_or_add_pPr()
    properties.set("marL", str(emu(block.left)))
    if not block.mark:
        return
    properties.set("indent", str(-emu(block.left)))
    number = block.mark.removesuffix(".")
    if number.isdecimal():
        attributes = {"type": "arabicPeriod", "startAt": number}
        sign = paragraph._p.makeelement(f"{A}buAutoNum", attributes)
    else:
        sign = paragraph._p.makeelement(f"{A}buChar", {"char": block.mark})
    properties.append(sign)


def _tabs(paragraph: Any, places: Sequence[float]) -> None:
    """Stops for tabulators, in points from the left."""
    stops = paragraph._p.makeelement(f"{A}tabLst")
    for place in places:
        stops.append(stops.makeelement(f"{A}tab", {"pos": str(emu(place)), "algn": "l"}))
    paragraph._p.get_or_add_pPr().append(stops)


def _namer(kind: str, tree: RayTree | None) -> Callable[[str], str]:
    """Names shapes by the paths of their rays, which stay the same from tree to tree: `ray-3` is `tree ray TR`."""

    def name(mark: str) -> str:
        found = ROW.match(mark)
        if not found or tree is None or int(found[2]) >= len(tree):
            return f"{kind} {mark}"
        return f"{kind} {found[1]} {tree.path(int(found[2]))}{mark[found.end() :]}"

    return name


def _make_unique(shapes: Any) -> None:
    """Give every shape a name of its own, that Morph pairs."""
    known: set[str] = set()

    def go(shapes: Any) -> None:
        for shape in shapes:
            name = next(name for k in count(1) if (name := f"!!{shape.name}{f' {k}' if k > 1 else ''}") not in known)
            known.add(name)
            shape.name = name
            if hasattr(shape, "shapes"):
                go(shape.shapes)

    go(shapes)

"""A lesson as a tagged PDF: a page for each moment, with headings, paragraphs, and figures with alternative text.

The elements of the structure are in the order of reading. The place at the foot of a page is not read out.
"""

from tracer.printable import printable
from viewer.base.theme import Theme
from viewer.figures.font import text_width
from viewer.figures.marks import HEIGHT, WIDTH, Disc, Figure, Formula, Stroke, Text
from viewer.figures.writers.pdf import PageDrawing, new_document
from viewer.handout.document import Handout, paper
from viewer.handout.slides import FOOT, FOOT_SIZE, HEAD, MARGIN, RING, RINGS, TITLE, Placed, Slide, slides_of
from viewer.handout.text_lines import BOLD as WIDER, BlockLines
from viewer.lessons.language import web_tag

BOLD = 0.016  # by which bold letters are wider on every side, in text sizes
KINDS = {"h": "H3", "li": "P", "quote": "P", "tr": "P", "formula": "Formula"}  # structure elements of blocks
MARK = 0.1  # distance of a list's mark from its text, in text sizes


def write_slides(handout: Handout, command: str, theme: str) -> bytes:
    """The document."""
    colors, lesson = paper(theme), handout.lesson
    about = Figure(lesson.title, lesson.question, command, (), colors.ground, True)
    pdf = new_document(about)
    pdf.set_lang(web_tag(lesson.language))
    titles: list[str] = []
    for slide in slides_of(handout, colors):
        page = PageDrawing(pdf, about)
        if slide.title not in titles[-1:]:
            pdf.start_section(printable(slide.title), 1 if slide.page else 0)
        titles.append(slide.title)
        _Writer(page, slide, colors).write()
    return bytes(pdf.output())


class _Writer:
    def __init__(self, page: PageDrawing, slide: Slide, theme: Theme) -> None:
        self.page, self.slide, self.theme = page, slide, theme

    def write(self) -> None:
        slide, size = self.slide, TITLE
        with self.page.tagged("H2" if slide.page else "H1"):
            at = (MARGIN, 0.5 * HEAD)
            self.page.text(Text("title", at, slide.title, size, self.theme.text, "start"), BOLD * size)
        for block in slide.text.blocks:
            with self.page.tagged(KINDS.get(block.kind, "P"), self._said(block)):
                self._block(block)
        for placed in slide.pictures:
            self._picture(placed)
        if slide.place:
            at = (WIDTH - MARGIN, 0.5 * (FOOT + HEIGHT))
            with self.page.artifact():
                self.page.text(Text("place", at, slide.place, FOOT_SIZE, self.theme.muted, "end"))

    def _said(self, block: BlockLines) -> str:
        return " ".join(word.style.text for word in block.words) if block.kind == "formula" else ""

    def _block(self, block: BlockLines) -> None:
        left, top, _, _ = self.slide.text_box
        if block.mark and block.words:
            word = block.words[0]
            at = (left + block.left - MARK * word.size, top + word.at[1])
            self.page.text(Text("mark", at, f"{block.mark} ", word.size, self.theme.text, "end"))
        for word in block.words:
            at, color = (left + word.at[0], top + word.at[1]), self.slide.color(word, self.theme)
            if word.is_formula:
                self.page.draw(Formula("formula", word.content, at, word.size, color, "start"))
            else:
                bold = word.style.bold
                wider = (WIDER - 1.0) * text_width(word.content, word.size) / max(1, len(word.content))
                mark = Text("text", at, word.content, word.size, color, "start")
                self.page.text(mark, BOLD * word.size * bold, wider * bold)

    def _picture(self, placed: Placed) -> None:
        if placed.photo is None:
            with self.page.tagged("Figure", printable(placed.said)):
                for mark in placed.marks:
                    self.page.draw(mark)
            return
        with self.page.tagged("Figure", printable(placed.said)):
            self.page.image(placed.photo.pixels, placed.where)
            if placed.ring:
                for color, width in RINGS:
                    self.page.draw(Disc("ring", placed.ring, RING, None, Stroke(color, width)))

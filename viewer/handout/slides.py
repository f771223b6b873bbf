"""A lesson as slides: one for each moment, laid out for a canvas of 16:9. PPTX and PDF show the same slides."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tracer.tree.names import kind_of
from tracer.tree.raytree import RayTree
from viewer.base.theme import Color, Theme, rgb
from viewer.figures.marks import WIDTH, Handle, Mark, Point, Rectangle
from viewer.handout.document import Handout, Page, PagePart, Photo, Picture, Room, Show
from viewer.handout.pictures import KINDS
from viewer.handout.text_lines import TextLines, Word
from viewer.lessons.moments import count_presses, shown_at
from viewer.lessons.text import Items, Paragraph, Run

MARGIN = 36.0  # points, around everything
TITLE = 30.0  # size of a title
HEAD = 62.0  # where the text below the title begins
TEXT, SMALL = 20.0, 17.0  # sizes of text; the smaller one if there is much
MUCH = 150.0  # points: height of much text
FOOT = 520.0  # where pictures end; the place in the lesson stands below
FOOT_SIZE = 12.0
GAP = 12.0  # between the text and pictures, and between two of these
SIZES, LEAST = (20.0, 18.0), 14.0  # text of pictures: of one, of two; the smallest of a tree
RING = 8.0  # radius of the rings around the pixel, which are seen on any image
RINGS = ((rgb("#000000"), 4.0), (rgb("#FFFFFF"), 1.8))  # colours and widths
HIT_SIZE = 16.0  # text of two pictures if one is a hit: larger text would have no room for its formulas
SHARES = {"scene": 1.0, "tree": 1.15, "hit": 2.1, "ray": 1.0}  # of the width, relative to each other
LIVE = 1.5  # the same, of a live piece


@dataclass(frozen=True)
class Placed:
    """A picture on a slide: its marks, or an image, and its alternative text."""

    kind: str
    title: str
    where: Rectangle
    said: str
    marks: tuple[Mark, ...] = ()
    photo: Photo | None = None
    tree: RayTree | None = None  # whose rays the marks show

    @property
    def ring(self) -> Point | None:
        """The place of the pixel on an image; None without one."""
        if self.photo is None or self.photo.ring is None:
            return None
        (left, top, right, bottom), (x, y) = self.where, self.photo.ring
        return (left + x * (right - left), top + y * (bottom - top))


@dataclass(frozen=True)
class Slide:
    """`place` says which step of how many it is. `page` is that step; None: the cover."""

    title: str
    place: str
    text: TextLines
    pictures: tuple[Placed, ...]
    notes: str
    page: Page | None = None

    @property
    def text_box(self) -> Rectangle:
        return (MARGIN, HEAD, WIDTH - MARGIN, HEAD + self.text.bottom)

    def color(self, word: Word, theme: Theme) -> Color:
        """The colour of a word: a link to a ray has that of its kind, also when a sweep has left the ray behind."""
        kind = kind_of(word.style.ray) if word.style.ray else None
        if kind:
            return theme.ray(kind)
        return theme.accent if word.style.link else theme.text


def slides_of(handout: Handout, theme: Theme) -> list[Slide]:
    """The cover, and a slide for each moment of the lesson."""
    return [_cover(handout), *(slide for page in handout.pages for slide in _of_page(handout, page, theme))]


def _cover(handout: Handout) -> Slide:
    lesson = handout.lesson
    text = TextLines(0.42 * WIDTH - MARGIN, TEXT)
    if lesson.question:
        text.add([Paragraph(0, (Run(lesson.question, bold=True),))])
    if lesson.objectives:
        text.add([Paragraph(0, (Run("After this lesson you can:"),))])
        text.add([Items(0, tuple((Paragraph(0, (Run(one),)),) for one in lesson.objectives))])
    photos = handout.pages[0].show.photos
    right = (0.45 * WIDTH, HEAD, WIDTH - MARGIN, FOOT)
    pictures = (_placed_photo(photos[-1], right),) if photos else ()
    return Slide(lesson.title, "", text, pictures, lesson.question)


def _of_page(handout: Handout, page: Page, theme: Theme) -> Iterator[Slide]:
    show = page.show
    whole = _text(page.parts)
    left, right = MARGIN, WIDTH - MARGIN
    where = (left, HEAD + whole.bottom + GAP, right, FOOT)  # with room for all text: pictures keep their places
    drawn = _Drawn(len(page.stages) if page.step.state.reveal else 1, theme)
    place = f"{handout.lesson.title}   {page.number}/{len(handout.pages)}"
    notes = page.step.notes or _spoken(page)
    for count, frame in _moments(page):
        parts = page.parts[:count]
        live = [one for part in parts for one in part.live.values()]
        pictures = _of_show(page, show, frame, live, where, drawn)
        yield Slide(page.title, place, _text(parts, whole.size), tuple(pictures), notes, page)


def _moments(page: Page) -> Iterator[tuple[int, int]]:
    """(number of parts of the text, frame) of each slide: of each press, and of places on the way of a sweep."""
    for press in range(count_presses(page.step, len(page.stages)) + 1):
        shown = shown_at(page.step, len(page.stages), press)
        yield shown.parts, page.stages[shown.stage]
        if press == 0:
            yield from ((shown.parts, frame) for frame in page.on_the_way)


def _spoken(page: Page) -> str:
    """The text of a step, for the notes of a step that has none."""
    lines = TextLines(WIDTH, TEXT)
    for part in page.parts:
        lines.add(part.blocks)
    said = [
        "".join(word.style.text if word.is_formula else word.content for word in block.words) for block in lines.blocks
    ]
    return "\n".join([page.title, *said])


def _text(parts: Sequence[PagePart], size: float | None = None) -> TextLines:
    """The text of these parts, in this size; by default, it is small if there is much."""
    text = TextLines(WIDTH - 2.0 * MARGIN, size or TEXT)
    for part in parts:
        text.add(part.blocks)
    return text if size or text.bottom <= MUCH else _text(parts, SMALL)


class _Drawn:
    """Pictures of one step. Stages at one place are drawn together, since each is laid out for the last of them."""

    def __init__(self, stages: int, theme: Theme) -> None:
        self.stages, self.theme = stages, theme
        self._made: dict[tuple[int, Rectangle], list[list[Mark]]] = {}

    def marks(self, picture: Picture, where: Rectangle, size: float, frame: int) -> list[Mark]:
        room, key = Room(where, size, self.theme, LEAST), (id(picture), where)
        if frame == 0 and self.stages > 1 and picture.kind in KINDS:
            self._made[key] = picture.draw(room, range(self.stages))
        return self._made[key][frame] if key in self._made else picture.draw(room, [frame])[0]


def _of_show(page: Page, show: Show, stage: int, live: Sequence[Show], where: Rectangle, drawn: _Drawn) -> list[Placed]:
    """The pictures of a step, and the image if it is one of its panels; beside a live piece, the first of them."""
    pictures = [(show, picture, stage) for picture in show.pictures]
    if live:
        frame = 0 if live[-1].follows is None else live[-1].follows + stage
        pictures = [*pictures[:1], *((live[-1], picture, frame) for picture in live[-1].pictures)]
    if live or "image" not in page.step.state.panels or not show.photos:
        return _pictures(pictures, where, drawn)
    photo = show.photos[stage if len(show.photos) > 1 else 0]
    left, top, right, bottom = where
    if not pictures:
        return [_placed_photo(photo, where)]
    middle = 0.5 * (left + right)
    image = _placed_photo(photo, (middle + 0.5 * GAP, top, right, bottom))
    return [*_pictures(pictures, (left, top, middle - 0.5 * GAP, bottom), drawn), image]


def _pictures(pictures: Sequence[tuple[Show, Picture, int]], where: Rectangle, drawn: _Drawn) -> list[Placed]:
    """These frames of pictures side by side."""
    left, top, right, bottom = where
    shares = [SHARES.get(picture.kind, LIVE) for _, picture, _ in pictures]
    unit = (right - left - GAP * (len(shares) - 1)) / sum(shares)
    size = SIZES[min(len(shares), len(SIZES)) - 1]
    if len(shares) > 1 and any(picture.kind == "hit" for _, picture, _ in pictures):
        size = HIT_SIZE
    found = []
    for (show, picture, frame), share in zip(pictures, shares, strict=True):
        place = (left, top, left + share * unit, bottom)
        left += share * unit + GAP
        kept = tuple(mark for mark in drawn.marks(picture, place, size, frame) if not isinstance(mark, Handle))
        if kept:
            found.append(
                Placed(picture.kind, picture.title, place, picture.says(frame, kept), kept, tree=show.shown[frame].tree)
            )
    return found


def _placed_photo(photo: Photo, where: Rectangle) -> Placed:
    """An image in the middle of a rectangle, as large as fits."""
    left, top, right, bottom = where
    height, width = photo.pixels.shape[:2]
    scale = min((right - left) / width, (bottom - top) / height)
    x, y = 0.5 * (left + right - scale * width), top
    return Placed("image", photo.title, (x, y, x + scale * width, y + scale * height), photo.description, photo=photo)

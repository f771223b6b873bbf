"""Shows in HTML: the pictures of a step, or a live piece, with what moves through their frames."""

import base64
import io
import json
from collections.abc import Iterator, Sequence

import numpy as np

from tracer.tree.text import heaviest_rows
from viewer.base.srgb import srgb
from viewer.base.theme import Theme
from viewer.explain.ray import ray_details
from viewer.explain.sections import RayDetails
from viewer.figures.marks import Box, Disc, Figure, Formula, Handle, Line, Mark, Point, Raster, Shape, Text
from viewer.figures.picking import ray_of
from viewer.figures.writers.html.frame import text
from viewer.figures.writers.html.inline_svg import Drawings
from viewer.figures.writers.html.numbers import Numbers
from viewer.handout.document import REVEALED, SWEEP, Control, Photo, Picture, Room, Show, Shown
from viewer.handout.html.colors import ColorPairs
from viewer.handout.html.frames import HANDLE, captions, frames_attribute, frames_svg
from viewer.handout.live import LIVE_ROOM

# The rooms of pictures, in points. On a phone, 390 pixels wide, the text has 12 pixels.
ROOMS = {"scene": (0.0, 0.0, 460.0, 420.0), "tree": (0.0, 0.0, 460.0, 430.0), "hit": (0.0, 0.0, 460.0, 620.0)}
EXPLAINED = 40  # rays of a tree whose numbers are on the page: the heaviest
WIDEST, QUALITY = 720, 85  # of an image: pixels, and WebP's quality
MARGIN = 0.7  # below a picture, in text sizes
RING = 0.018  # radius of the ring around the pixel, in widths of the image


class ShowWriter:
    """Writes the shows of one page."""

    def __init__(self, themes: Sequence[Theme], numbers: Numbers, drawings: Drawings, colors: ColorPairs) -> None:
        self.themes, self.numbers, self.drawings, self.colors = themes, numbers, drawings, colors
        self._trees: dict[tuple, str] = {}
        self._details: dict[tuple[int, int], RayDetails] = {}
        self._images: dict[int, str] = {}

    def tree_name(self, shown: Shown) -> str:
        """What the names of a tree's rays begin with. Trees of one pixel have common rays, at any depth."""
        tree = shown.tree
        if tree is None:
            return ""
        key = (id(shown.world), tree.pixel, tree.sample, tree.model) if tree.pixel else (id(tree),)
        return self._trees.setdefault(key, f"t{len(self._trees) + 1}-")

    def lines(self, show: Show, place: str, words: Sequence[str] = (), kind: str = "") -> Iterator[str]:
        """A show, with the words above it. `place` is its id."""
        start = show.last
        yield f'<div class="show{f" {kind}" if kind else ""}" id="{place}">'
        if words or show.photos:
            yield '<div class="lead">'
            yield '<div class="words">'
            yield from words
            yield "</div>"
            if show.photos:
                yield from self._photos(show.photos, f"{place}-image", start, "" if show.pictures else " large")
            yield "</div>"
        yield '<div class="moved">'
        if show.pictures:
            alone = " alone" if len(show.pictures) == 1 else ""
            yield '<div class="pictures">'
            for k, picture in enumerate(show.pictures):
                yield from self._picture(show, picture, f"{place}-{k + 1}", start, alone)
            yield "</div>"
        for control in show.controls:
            yield from _control(control, f"{place}-{control.name}")
        yield "</div>"
        yield "</div>"

    def _picture(self, show: Show, picture: Picture, place: str, start: int, alone: str) -> Iterator[str]:
        (_, _, width, height), size = ROOMS.get(picture.kind, LIVE_ROOM.where), LIVE_ROOM.size
        rooms = [Room((0.0, 0.0, width, height), size, theme) for theme in self.themes]
        marks = picture.draw(rooms[0], range(show.frames))
        if not any(marks):
            return
        lowest = max(low(mark) for frame in marks for mark in frame)
        height = min(height, lowest + MARGIN * size)

        def figures(k: int, frames: Sequence[int]) -> list[Figure]:
            found = picture.draw(rooms[k], frames) if k else marks
            ground = rooms[k].theme.ground
            return [Figure(picture.title, "", "", tuple(one), ground, False, width, height) for one in found]

        drawn = figures(0, ())
        trees = [self.tree_name(shown) for shown in show.shown]
        swept = bool(show.controls) and show.controls[0].name == SWEEP
        named = [
            self._named(figure, shown, k == 0 or not swept)
            for k, (figure, shown) in enumerate(zip(drawn, show.shown, strict=True))
        ]
        labelled = f'aria-labelledby="{place}-name" aria-describedby="{place}-said"'
        yield f'<figure class="picture {picture.kind}{alone}">'
        yield '<div class="canvas">'
        other = (lambda frames: figures(1, frames)) if len(rooms) > 1 else None
        yield from frames_svg(drawn, other, start, labelled, named, trees, self.drawings, self.colors)
        yield "</div>"
        yield f'<figcaption><p id="{place}-name">{text(picture.title)}</p>'
        yield f'<div id="{place}-said" class="said">'
        yield from captions([picture.says(k, one) for k, one in enumerate(marks)], start, text)
        yield "</div>"
        yield "</figcaption>"
        yield "</figure>"

    def _named(self, figure: Figure, shown: Shown, whole: bool) -> dict[int, str]:
        """The articles of the rays in a figure, by row. Without `whole`, they have numbers only, and no formulas."""
        tree = shown.tree
        if tree is None:
            return {}
        rows = {row for mark in figure.marks if (row := ray_of(mark.name)) is not None}
        if len(rows) > EXPLAINED:
            rows = set(heaviest_rows(tree, EXPLAINED, rows))
        found = {}
        for row in sorted(rows):
            key = (id(tree), row)
            if key not in self._details:
                details = ray_details(tree, shown.world, row)
                parts = details.parts if whole else details.parts[:1]
                self._details[key] = RayDetails(row, details.name, details.words, parts)
            found[row] = self.numbers.name(self._details[key])
        return found

    def _photos(self, photos: Sequence[Photo], place: str, start: int, large: str) -> Iterator[str]:
        height, width = photos[0].pixels.shape[:2]
        labelled = f'aria-labelledby="{place}-name" aria-describedby="{place}-said"'
        yield f'<figure class="photo{large}">'
        yield f'<svg role="img" {labelled} viewBox="0 0 {width} {height}">'
        for k, photo in enumerate(photos):
            own = frames_attribute([k], start) if len(photos) > 1 else ""
            image = f'<image width="{width}" height="{height}" href="{self._image(photo)}"/>'
            ring = _ring((width * photo.ring[0], height * photo.ring[1]), width) if photo.ring else ""
            yield f"<g{own}>{self.drawings.shared(image)}{ring}</g>"
        yield "</svg>"
        yield f'<figcaption><p id="{place}-name">{text(photos[0].title)}</p>'
        yield f'<div id="{place}-said" class="said">'
        said = [photo.description for photo in photos]
        yield from captions(said, start if len(photos) > 1 else 0, text)
        yield "</div>"
        yield "</figcaption>"
        yield "</figure>"

    def _image(self, photo: Photo) -> str:
        """The address of its data, made once for each image."""
        key = id(photo.pixels)  # the handout keeps them alive
        if key not in self._images:
            self._images[key] = _address(photo.pixels)
        return self._images[key]


def low(mark: Mark) -> float:
    """The lowest place of a mark, in points."""
    match mark:
        case Box() | Raster():
            return mark.center[1] + 0.5 * mark.size[1]
        case Disc():
            return mark.center[1] + mark.radius
        case Shape():
            return max(y for _, y in mark.corners)
        case Line():
            return max(mark.start[1], mark.end[1])
        case Text() | Formula():
            return mark.box()[3]
        case Handle():
            return mark.at[1] + HANDLE[0]
    return 0.0


def _address(pixels: np.ndarray) -> str:
    """An image as an address that has the data in it."""
    from PIL import Image

    height, width = pixels.shape[:2]
    picture = Image.fromarray(srgb(pixels))
    if width > WIDEST:
        picture = picture.resize((WIDEST, round(WIDEST * height / width)), Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    picture.save(buffer, "WEBP", quality=QUALITY, method=6)
    return f"data:image/webp;base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"


def _ring(at: Point, width: int) -> str:
    """Two circles, which are seen on any image."""
    r = RING * width
    circle = f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="{r:.1f}" fill="none"'
    lines = (("#000000", 0.5 * r), ("#FFFFFF", 0.22 * r))
    return "".join(f'{circle} stroke="{color}" stroke-width="{wide:.1f}"/>' for color, wide in lines)


def _control(control: Control, place: str) -> Iterator[str]:
    """A slider with two buttons. The script shows it."""
    last = len(control.positions) - 1
    said = json.dumps(control.positions, ensure_ascii=False)
    own = f'data-name="{text(control.name)}" data-first="{control.first}" data-start="{control.start}"'
    counted = "" if control.moves_handle else ' data-counted="1"'
    asked = ' data-asked="1"' if control.name in REVEALED else ""
    yield f'<div class="control" {own}{counted}{asked} data-said="{text(said)}" hidden>'
    yield f'<label for="{place}">{text(control.title)}</label>'
    yield f'<button type="button" data-by="-1" aria-label="Back: {text(control.title)}">‹</button>'
    yield f'<input type="range" id="{place}" min="0" max="{last}" step="1" value="{control.start}">'
    yield f'<button type="button" data-by="1" aria-label="On: {text(control.title)}">›</button>'
    yield f'<output for="{place}"></output>'
    yield "</div>"

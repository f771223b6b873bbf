"""Rules for every figure, checked on its marks: shared by the tests of all figures."""

import itertools

from viewer.figures.marks import Box, Figure, Formula, Line, Rectangle, Text

LESS = 1e-6  # points: overlap allowed to boxes that only touch


def rectangle(box: Box) -> Rectangle:
    (x, y), (w, h) = box.center, box.size
    return (x - w / 2, y - h / 2, x + w / 2, y + h / 2)


def overlap(a: Rectangle, b: Rectangle) -> bool:
    return min(a[2], b[2]) - max(a[0], b[0]) > LESS and min(a[3], b[3]) - max(a[1], b[1]) > LESS


def cuts(piece: tuple, box: Rectangle) -> bool:
    """True if a segment runs through the inside of a box (Liang & Barsky, 1984)."""
    (x0, y0), (x1, y1) = piece
    enters, leaves = 0.0, 1.0
    for a, b, low, high in ((x0, x1, box[0], box[2]), (y0, y1, box[1], box[3])):
        if abs(b - a) < 1e-12:
            if not low + LESS < a < high - LESS:
                return False
            continue
        near, far = sorted(((low + LESS - a) / (b - a), (high - LESS - a) / (b - a)))
        enters, leaves = max(enters, near), min(leaves, far)
    return leaves - enters > 1e-9


def lies_in(line: Line, box: Rectangle) -> bool:
    """True for a part of a sign in a box."""
    left, top, right, bottom = box
    return all(left < x < right and top < y < bottom for x, y in (line.start, line.end))


def check_texts(figure: Figure, least: float = 18.0) -> list[Text | Formula]:
    """Assert that all texts and formulas can be read, none leaves the canvas, and no two overlap. Returns them."""
    texts = [mark for mark in figure.marks if isinstance(mark, (Text, Formula))]
    for text in texts:
        left, top, right, bottom = text.box()
        assert text.size >= least and (isinstance(text, Formula) or text.content), text
        assert left >= 0.0 and top >= 0.0 and right <= figure.width and bottom <= figure.height, text
    for a, b in itertools.combinations(texts, 2):
        assert not overlap(a.box(), b.box()), (a, b)
    return texts


def check(figure: Figure, least: float = 18.0) -> None:
    """Assert that nothing overlaps, nothing leaves the canvas, and all text can be read."""
    texts = check_texts(figure, least)
    boxes = [mark for mark in figure.marks if isinstance(mark, Box)]
    # The lines of levels are faint, and lie behind everything.
    lines = [mark for mark in figure.marks if isinstance(mark, Line) and not mark.name.startswith("level-")]
    for box in boxes:
        left, top, right, bottom = rectangle(box)
        assert left >= 0.0 and top >= 0.0 and right <= figure.width and bottom <= figure.height, box
    for a, b in itertools.combinations(boxes, 2):
        assert not overlap(rectangle(a), rectangle(b)), (a, b)
    for text, box in itertools.product(texts, boxes):
        if isinstance(text, Text) and text.inside == box.name:
            inner, outer = text.box(), rectangle(box)
            assert outer[0] <= inner[0] and inner[2] <= outer[2], text
        else:
            assert not overlap(text.box(), rectangle(box)), (text, box)
    for line in lines:
        for piece in line.pieces():
            for box in boxes:
                assert lies_in(line, rectangle(box)) or not cuts(piece, rectangle(box)), (line, box)
            for text in texts:
                if line.name != text.name:
                    assert not cuts(piece, text.box()), (line, text)

"""The lines of an OBJ file as numbers, a block of lines at a time.

numpy parses all numbers of a kind in a block in one call. If that fails, the lines are parsed one by one, which also
finds the line of a fault.
"""

import math
import re
from collections.abc import Iterator

import numpy as np

from tracer.fields import LARGEST
from tracer.formats.numbers import parsed
from tracer.formats.polygons import MOST_CORNERS
from tracer.formats.source import Fault, decode, utf8

BLOCK = 1 << 22  # bytes that are parsed at a time
BLANKS = bytes.maketrans(b"\t\v\f\0", b"    ")
# Lines of which all but the last end with a backslash. A comment is not continued: it may end with a Windows path.
CONTINUED = re.compile(rb"^(?:(?!#)(?:[^\n#]|(?<=\S)#)*\\\n)+[^\n]*\n", re.MULTILINE)
CORNER = re.compile(rb"([+-]?[0-9]{1,18})(?:/[+-]?[0-9]*(?:/([+-]?[0-9]{1,18})?)?)?")


def normalised(data: bytes) -> bytes:
    """The bytes with line ends as in Unix and blanks as white space. A line that ends with a backslash is joined with
    the next one, followed by an empty line, so that line numbers stay right.
    """
    data = utf8(data).rstrip(b"\x1a\0 \r\n") + b"\n"
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").translate(BLANKS)
    if b"\\\n" not in data:
        return data
    return CONTINUED.sub(lambda m: m[0].replace(b"\\\n", b" ") + b"\n" * m[0].count(b"\\\n"), data)


def block_ends(data: bytes) -> Iterator[tuple[int, int]]:
    """(start, end) of blocks of whole lines."""
    start = 0
    while start < len(data):
        end = data.find(b"\n", min(start + BLOCK, len(data) - 1)) + 1
        yield start, end
        start = end


class Block:
    """Some lines: where the non-empty ones are, and how many words they have."""

    def __init__(self, data: bytes, first_line: int) -> None:
        self.data = data
        text = np.frombuffer(data, np.uint8)
        dark = text > 32
        begins = dark.copy()
        begins[1:] &= ~dark[:-1]
        words = np.flatnonzero(begins)
        line_of_word = np.searchsorted(np.flatnonzero(text == ord("\n")), words)
        heads = np.flatnonzero(np.diff(line_of_word, prepend=-1))
        self.numbers = first_line + line_of_word[heads]  # of the lines
        self.starts = words[heads]
        self.counts = np.diff(heads, append=len(words))  # words of each line, with the first
        padded = np.concatenate([text, np.full(3, 32, np.uint8)])
        c0, c1, c2 = (padded[self.starts + k] for k in range(3))
        self.is_vertex = (c0 == ord("v")) & (c1 <= 32)
        self.is_normal = (c0 == ord("v")) & (c1 == ord("n")) & (c2 <= 32)
        self.is_face = (c0 == ord("f")) & (c1 <= 32)
        texture = (c0 == ord("v")) & (c1 == ord("t")) & (c2 <= 32)
        self.is_other = ~(self.is_vertex | self.is_normal | self.is_face | texture)

    def text(self, lines: np.ndarray) -> bytes:
        """The text of the lines of a mask."""
        edges = np.flatnonzero(np.diff(lines, prepend=False, append=False))
        ends = np.append(self.starts, len(self.data))
        return b"".join([self.data[self.starts[a] : ends[b]] for a, b in edges.reshape(-1, 2)])

    def lines(self, which: np.ndarray) -> Iterator[tuple[int, int, bytes]]:
        """(index, line number, text) of the lines of a mask."""
        for k in np.flatnonzero(which).tolist():
            start = int(self.starts[k])
            yield k, int(self.numbers[k]), self.data[start : self.data.index(b"\n", start)]


def numbers_of(block: Block, which: np.ndarray, keyword: str, most: int) -> tuple[np.ndarray, np.ndarray]:
    """(numbers (n, 3), counts): the first three numbers of each line, and how many numbers it has, from 3 to `most`."""
    text, counts = block.text(which), block.counts[which] - 1
    values = None
    if (counts >= 3).all() and (counts <= most).all() and b"#" not in text:
        values = parsed(text.replace(keyword.encode(), b" "), np.float64, int(counts.sum()))
    if values is None or not (np.abs(values) <= LARGEST).all():
        rows = [line_numbers(text, line, keyword, most) for _, line, text in block.lines(which)]
        values, counts = np.array([x for row in rows for x in row]), np.array([len(row) for row in rows])
    first = np.cumsum(counts) - counts
    return values[first[:, None] + np.arange(3)], counts


def line_numbers(text: bytes, line: int, keyword: str, most: int) -> list[float]:
    """The numbers of one line. Raises Fault."""
    words = text.split(b"#")[0].split()[1:]
    if not 3 <= len(words) <= most:
        allowed = "3" if most == 3 else f"from 3 to {most}"
        raise Fault(f"{keyword} must have {allowed} numbers, got {len(words)}", line)
    return [number(word, keyword, line) for word in words]


def number(word: bytes, what: str, line: int) -> float:
    """A finite number. Raises Fault."""
    try:
        value = float(word) if b"_" not in word else math.nan
    except ValueError:
        value = math.nan
    if not abs(value) <= LARGEST:
        raise Fault(f'{what} must have finite numbers of at most {LARGEST:g}, got "{decode(word)[:40]}"', line)
    return value


def corners_of(block: Block) -> tuple[np.ndarray, np.ndarray]:
    """(corners, sizes): vertex and normal of each corner (n, 2) as written, normal 0 for none, and the number of
    corners of each face, 0 for a face that has fewer than three.
    """
    text, sizes = block.text(block.is_face), block.counts[block.is_face] - 1
    if (sizes >= 3).all() and b"#" not in text:
        corners = uniform_corners(text, sizes)
        if corners is not None and corners[:, 0].all():
            return corners, sizes
    rows = [line_corners(text, line) for _, line, text in block.lines(block.is_face)]
    corners = np.array([corner for row in rows for corner in row], np.int64).reshape(-1, 2)
    return corners, np.array([len(row) for row in rows])


def uniform_corners(text: bytes, sizes: np.ndarray) -> np.ndarray | None:
    """Vertex and normal of each corner (n, 2), if all corners are written in the same way."""
    count = int(sizes.sum())
    bytes_ = np.frombuffer(text, np.uint8)
    dark = bytes_ > 32
    words = np.flatnonzero(dark & ~np.concatenate([[False], dark[:-1]]))
    slashes = np.searchsorted(words, np.flatnonzero(bytes_ == ord("/")), "right") - 1
    of_corner = np.delete(np.bincount(slashes, minlength=len(words)), np.cumsum(sizes + 1) - sizes - 1)
    each = int(of_corner[0])
    doubled = text.count(b"//")
    if (of_corner != each).any() or each > 2 or doubled not in (0, count):
        return None
    columns = 1 + each - (doubled > 0)
    values = parsed(text.replace(b"f", b" ").replace(b"/", b" "), np.int64, count * columns)
    if values is None:
        return None
    values = values.reshape(count, columns)
    corners = np.zeros((count, 2), np.int64)
    corners[:, 0] = values[:, 0]
    if each == 2:
        corners[:, 1] = values[:, -1]
    return None if each == 2 and not corners[:, 1].all() else corners


def line_corners(text: bytes, line: int) -> list[tuple[int, int]]:
    """The corners of the face on one line; none if there are fewer than three. Raises Fault."""
    corners = []
    for word in text.split(b"#")[0].split()[1:]:
        found = CORNER.fullmatch(word)
        if not found:
            raise Fault(f'a corner of a face must be v, v/vt, v//vn or v/vt/vn, got "{decode(word)[:40]}"', line)
        vertex, normal = int(found[1]), int(found[2] or 0)
        if vertex == 0 or found[2] in (b"0", b"-0"):
            raise Fault(f'indices count from 1, or from -1 backwards, got 0 in "{decode(word)}"', line)
        corners.append((vertex, normal))
    if len(corners) > MOST_CORNERS:
        raise Fault(f"a face must have at most {MOST_CORNERS} corners, got {len(corners)}", line)
    return corners if len(corners) >= 3 else []

"""STL: triangles without materials, in binary or as text.

Format: 3D Systems' "Stereolithography Interface Specification", 1989. Many programs begin a binary file with the word
"solid" too, so the file's size decides: 84 bytes and 50 for each triangle.
"""

import re
import struct
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np

from tracer.formats.mesh_part import CLAY, MeshFile, make_part
from tracer.formats.notes import Notes
from tracer.formats.numbers import parsed
from tracer.formats.source import Fault, decode, read_bytes, utf8

HEADER = 84  # bytes: a comment of 80 and the number of triangles
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
# The name of a solid ends with its line, or before the first statement.
SOLID = re.compile(rb"^[ \t]*solid\b((?:(?!\bfacet\s+normal\b)[^\n])*)", re.MULTILINE | re.IGNORECASE)
LOOP = re.compile(rb"\bouter\s+loop\b", re.IGNORECASE)
VERTEX = re.compile(rb"\bvertex[ \t]([^\n]*)$", re.MULTILINE | re.IGNORECASE)
FACET = re.compile(rb"\bouter\s+loop" + 3 * rb"\s+vertex\s+(\S+[ \t]+\S+[ \t]+\S+)" + rb"\s+endloop\b", re.IGNORECASE)
ENDFACET = re.compile(rb"\bendfacet\b", re.IGNORECASE)
BLOCK = 1 << 22  # bytes of text that are read at once


def read_stl(path: Path, progress: Callable[[float], None]) -> MeshFile:
    """Read a file. Raises Fault."""
    data = read_bytes(path)
    notes = Notes()
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= HEADER else 0
    is_binary = len(data) >= HEADER and HEADER + count * RECORD.itemsize == len(data)
    text = b"" if is_binary else utf8(data)
    if is_binary or not is_text(text):
        solids = [("", binary_corners(data, count, notes))]
    elif re.match(rb"\s*solid\b", text, re.IGNORECASE):
        solids = text_solids(text, progress)
    else:
        raise Fault('must begin with "solid", as a text file, or be binary')
    parts = []
    for name, corners in solids:
        faces = np.arange(3 * len(corners)).reshape(-1, 3)
        parts.append(make_part(name, corners.reshape(-1, 3), faces, None, CLAY, notes))
    return MeshFile([part for part in parts if part], notes.lines())


def is_text(data: bytes) -> bool:
    """Whether the file has the words of a text file: a binary file's comment may begin with "solid"."""
    return re.search(rb"\b(facet|endsolid)\b", data[:10_000], re.IGNORECASE) is not None


def binary_corners(data: bytes, count: int, notes: Notes) -> np.ndarray:
    """The corners (n, 3, 3) of a binary file. Normals are not read: those of flat faces follow from the corners."""
    there = max(0, len(data) - HEADER) // RECORD.itemsize
    if len(data) < HEADER:
        raise Fault(f'must begin with "solid", or be binary with at least {HEADER} bytes, got {len(data)} bytes')
    left = len(data) - HEADER - count * RECORD.itemsize
    if count > there or (left and left % RECORD.itemsize == 0):
        raise Fault(f"must have {count} triangles, as its header says, got {there}")
    notes.count("bytes after the last triangle are not read", left)
    records = np.frombuffer(data, RECORD, count, HEADER)
    notes.count("attributes of triangles, which may be colours, are not shown", int((records["attribute"] != 0).sum()))
    return records["corners"].astype(np.float64)


def text_solids(data: bytes, progress: Callable[[float], None]) -> list[tuple[str, np.ndarray]]:
    """(name, corners (n, 3, 3)) of each solid of a text file. A missing "endsolid" does not matter."""
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    starts = list(SOLID.finditer(text))
    solids = []
    for head, end in zip(starts, [*(found.start() for found in starts[1:]), len(text)], strict=True):
        corners = [np.zeros((0, 3, 3))]
        for first, last in blocks(text, head.end(), end):
            progress(first / len(text))
            facets = FACET.findall(text, first, last)
            numbers = parsed(b" ".join(vertex for facet in facets for vertex in facet), np.float64, 9 * len(facets))
            if numbers is None or len(facets) != len(LOOP.findall(text, first, last)):
                raise fault_in(text, first, last)
            corners.append(numbers.reshape(-1, 3, 3))
        solids.append((decode(head[1]).strip(), np.concatenate(corners)))
    return solids


def blocks(text: bytes, start: int, end: int) -> Iterator[tuple[int, int]]:
    """Yield the pieces (first byte, end) of a solid, each of whole triangles."""
    while start < end:
        stop = ENDFACET.search(text, start + BLOCK, end)
        yield start, stop.start() if stop else end
        start = stop.start() if stop else end


def fault_in(text: bytes, start: int, end: int) -> Fault:
    """The first fault of a solid, which is the text from `start` to `end`."""
    loops = [found.end() for found in LOOP.finditer(text, start, end)]
    for first, last in pairwise([*loops, end]):
        vertices = list(VERTEX.finditer(text, first, last))
        for found in vertices:
            if parsed(found[1], np.float64, 3) is None:
                line = text.count(b"\n", 0, found.start(1)) + 1
                return Fault(f'a vertex must have three numbers, got "{decode(found[1]).strip()[:40]}"', line)
        if len(vertices) != 3 or FACET.search(text, first - 20, last) is None:
            line = text.count(b"\n", 0, first) + 1
            return Fault(f"a loop must have three vertices and an endloop, got {len(vertices)} vertices", line)
    return Fault("must have triangles of three vertices with three numbers each")

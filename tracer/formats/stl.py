"""STL: triangles without materials, in binary or as text.

Format: 3D Systems' "Stereolithography Interface Specification", 1989. Many programs begin a binary file with the word
"solid" too, so the file's size decides: 84 bytes and 50 for each triangle.
"""

import re
import struct
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np

from tracer.formats.mesh_part import CLAY, MeshFile, make_part
from tracer.formats.notes import Notes
from tracer.formats.numbers import parsed
from tracer.formats.source import Fault, decode, read_bytes

HEADER = 84  # bytes: a comment of 80 and the number of triangles
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
VERTEX = re.compile(rb"^\s*vertex\s([^\n]*)$", re.MULTILINE | re.IGNORECASE)
SOLID = re.compile(rb"^\s*solid\b([^\n]*)$", re.MULTILINE | re.IGNORECASE)
LOOP = re.compile(rb"^\s*outer\s+loop\b", re.MULTILINE | re.IGNORECASE)


def read_stl(path: Path, progress: Callable[[float], None]) -> MeshFile:
    """Read a file. Raises Fault."""
    data = read_bytes(path)
    notes = Notes()
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= HEADER else 0
    is_binary = len(data) >= HEADER and HEADER + count * RECORD.itemsize == len(data)
    if not is_binary and re.match(rb"(?:\xef\xbb\xbf)?\s*solid\b", data, re.IGNORECASE) and is_text(data):
        solids = text_solids(data)
    else:
        solids = [("", binary_corners(data, count, notes))]
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
    return np.frombuffer(data, RECORD, count, HEADER)["corners"].astype(np.float64)


def text_solids(data: bytes) -> list[tuple[str, np.ndarray]]:
    """(name, corners (n, 3, 3)) of each solid of a text file. A missing "endsolid" does not matter."""
    text = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    starts = list(SOLID.finditer(text))
    solids = []
    for start, end in pairwise([*(found.start() for found in starts), len(text)]):
        head = SOLID.match(text, start)
        assert head
        line = text.count(b"\n", 0, start) + 1
        vertices = VERTEX.findall(text, head.end(), end)
        triangles = len(LOOP.findall(text, head.end(), end))
        if len(vertices) != 3 * triangles:
            found = f"a solid with {triangles} triangles (outer loop) must have {3 * triangles} vertices"
            raise Fault(f"{found}, got {len(vertices)}", line)
        numbers = parsed(b" ".join(vertices), np.float64, 9 * triangles)
        if numbers is None:
            raise Fault(f"every vertex of a solid must have three numbers, got {bad_vertex(vertices)}", line)
        solids.append((decode(head[1]).strip(), numbers.reshape(-1, 3, 3)))
    return solids


def bad_vertex(vertices: list[bytes]) -> str:
    """The first vertex that has not three numbers, as written."""
    bad = next(vertex for vertex in vertices if parsed(vertex, np.float64, 3) is None)
    return f'"{decode(bad).strip()[:40]}"'

"""PLY: vertices and polygons without materials, in binary or as text.

Format: G. Turk, "The PLY Polygon File Format", 1994. Elements may be in any order. Read are `vertex` (x, y, z, and
nx, ny, nz if present) and `face` (vertex_indices or vertex_index).
"""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tracer.formats.mesh_part import CLAY, MeshFile, make_part
from tracer.formats.notes import Notes
from tracer.formats.ply_body import LINE_END, Element, Lists, Property, Table, binary_tables, text_tables
from tracer.formats.polygons import triangulated
from tracer.formats.source import Fault, decode, read_bytes, utf8

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
MOST_HEADER = 1 << 20  # bytes
INDICES = ("vertex_indices", "vertex_index")
NORMALS = ("nx", "ny", "nz")
COLORS = ("red", "green", "blue", "diffuse_red", "r")


def read_ply(path: Path, progress: Callable[[float], None]) -> MeshFile:
    """Read a file. Raises Fault."""
    data = utf8(read_bytes(path))
    notes = Notes()
    order, elements, body = header_of(data)
    if order:
        tables, end = binary_tables(data, body, order, elements)
        notes.count("bytes after the last element are not read", len(data) - end)
    else:
        tables = text_tables(data[body:], 1 + len(re.findall(LINE_END, data[:body])), elements)
    for needed in ("vertex", "face"):
        if needed not in tables:
            raise Fault(f"must have the element {needed}, got {', '.join(tables) or 'none'}")
    for element in elements:
        if element.name not in ("vertex", "face"):
            notes.count(f'elements "{element.name[:20]}" are not read', element.count)
    names = [element.name for element in elements]
    if repeated := next((name for name in names if names.count(name) > 1), None):
        raise Fault(f"must have each element once, got {repeated} {names.count(repeated)} times")
    vertex, face = tables["vertex"], tables["face"]
    if any(name in vertex for name in COLORS):
        notes.count("vertex colours are not shown", len(column(vertex, "x")))
    if any(name in face for name in COLORS):
        notes.say("the colours of faces are not shown")
    points = np.stack([column(vertex, name) for name in "xyz"], axis=1)
    counts, corners = polygons_of(face)
    notes.count("faces with fewer than three corners are left out", int((counts < 3).sum()))
    kept = np.flatnonzero(counts >= 3)
    corners, counts = corners[np.repeat(counts >= 3, counts)], counts[kept]
    beyond = (corners < 0) | (corners >= len(points))
    if beyond.any():
        k = int(beyond.argmax())
        number = kept[np.searchsorted(np.cumsum(counts), k, "right")]
        raise Fault(f"face {number} must have vertices from 0 to {len(points) - 1}, got {corners[k]}")
    triangles, _ = triangulated(points[corners], counts, notes)
    faces = corners[triangles]
    smooth = None
    if all(name in vertex for name in NORMALS):
        smooth = (np.stack([column(vertex, name) for name in NORMALS], axis=1), faces)
    part = make_part("", points, faces, smooth, CLAY, notes)
    return MeshFile([part] if part else [], notes.lines())


def header_of(data: bytes) -> tuple[str, list[Element], int]:
    """(byte order, elements, first byte of the body) of a file; the byte order of a text file is empty."""
    found = re.match(rb"ply\s*?\n(.*?)^\s*end_header[ \t]*(\r\n|\r|\n)", data[:MOST_HEADER], re.DOTALL | re.MULTILINE)
    if not found:
        found = re.match(rb"ply[ \t]*\r(.*?)\rend_header[ \t]*(\r)", data[:MOST_HEADER], re.DOTALL)
    if not found:
        raise Fault('must begin with "ply" and a header that ends with "end_header"')
    order, elements = None, []
    for line, text in enumerate(re.split(LINE_END, found[1]), 2):
        match decode(text).split():
            case ["format", name, *_]:
                if name not in FORMATS:
                    raise Fault(f'format must be one of {", ".join(FORMATS)}, got "{name[:40]}"', line)
                order = FORMATS[name]
            case ["element", name, count]:
                if not re.fullmatch("[0-9]{1,18}", count):
                    raise Fault(f'element {name} must have a number of elements, got "{count[:40]}"', line)
                if int(count) > len(data):
                    raise Fault(f"element {name} must have no more elements than the file has bytes, got {count}", line)
                elements.append(Element(name, int(count)))
            case ["property", "list", length_type, item_type, name] if elements:
                elements[-1].properties.append(Property(name, type_of(item_type, line), type_of(length_type, line)))
            case ["property", item_type, name] if elements:
                elements[-1].properties.append(Property(name, type_of(item_type, line)))
            case [] | ["comment" | "obj_info", *_]:
                pass
            case _:
                raise Fault(f'must be a format, element, property or comment, got "{decode(text)[:40]}"', line)
    if order is None:
        raise Fault("must have a format in its header, got none")
    return order, elements, found.end()


def type_of(name: str, line: int) -> str:
    if name not in TYPES:
        raise Fault(f'a property must have one of the types {", ".join(TYPES)}, got "{name[:40]}"', line)
    return TYPES[name]


def column(table: Table, name: str) -> np.ndarray:
    """The numbers of a property of the vertices."""
    values = table.get(name)
    if not isinstance(values, np.ndarray):
        shown = (f"{key} (a list)" if isinstance(column, Lists) else key for key, column in table.items())
        raise Fault(f"element vertex must have the numbers x, y and z, got {', '.join(shown) or 'none'}")
    return values


def polygons_of(table: Table) -> tuple[np.ndarray, np.ndarray]:
    """(numbers of corners, vertices of all corners) of the faces."""
    for name in INDICES:
        found = table.get(name)
        if isinstance(found, Lists):
            with np.errstate(invalid="ignore"):
                corners = found.values.astype(np.int64)
            if (corners != found.values).any():
                raise Fault(f"{name} must be whole numbers, got {found.values[(corners != found.values).argmax()]:g}")
            return found.lengths, corners
    raise Fault(f"element face must have a list {' or '.join(INDICES)}, got {', '.join(table) or 'none'}")

"""The values of a PLY file: columns of numbers, and lists.

Most files have lists of one length only (triangles). Such an element is read in one call, any other row by row.
"""

import re
import struct
from dataclasses import dataclass, field

import numpy as np

from tracer.formats.numbers import parsed
from tracer.formats.polygons import MOST_CORNERS
from tracer.formats.source import Fault, decode

LINE_END = rb"\r\n|\r|\n"

# Codes of `struct` for numpy's types.
CODES = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}
WIDTHS = {name: int(name[1]) for name in CODES}  # bytes


@dataclass
class Property:
    """A property of an element: a number, or a list that begins with its length."""

    name: str
    type: str  # as numpy names it
    length_type: str = ""  # of a list


@dataclass
class Element:
    name: str
    count: int
    properties: list[Property] = field(default_factory=list)


@dataclass(frozen=True)
class Lists:
    """A list for each row: their lengths (n,), and the values of all lists, one after another."""

    lengths: np.ndarray
    values: np.ndarray


# The values of an element, by the name of the property.
Table = dict[str, np.ndarray | Lists]


def text_tables(body: bytes, first_line: int, elements: list[Element]) -> dict[str, Table]:
    """The values of a text file, which begin on line `first_line`. Raises Fault."""
    words = body.split()
    values = parsed(b" ".join(words), np.float64, len(words))
    if values is None:
        raise fault_of_text(body, first_line, elements)
    # As a binary file in which all numbers are float64.
    wide = [
        Element(e.name, e.count, [Property(p.name, "f8", "f8" if p.length_type else "") for p in e.properties])
        for e in elements
    ]
    try:
        tables, end = binary_tables(values.tobytes(), 0, "=", wide)
    except Fault:
        raise fault_of_text(body, first_line, elements) from None
    if end < 8 * len(words):
        raise fault_of_text(body, first_line, elements)
    return tables


def fault_of_text(body: bytes, first_line: int, elements: list[Element]) -> Fault:
    """The first fault of the values of a text file, which has an element on each line."""
    lines = ((k, text.split()) for k, text in enumerate(re.split(LINE_END, body), first_line))
    filled = ((k, words) for k, words in lines if words)
    for element in elements:
        for _ in range(element.count):
            line, words = next(filled, (0, []))
            if not line:
                return too_short(element)
            values = [parsed(word, np.float64, 1) for word in words]
            bad = next((word for word, value in zip(words, values, strict=True) if value is None), None)
            if bad is not None:
                return Fault(f'element {element.name} must have numbers, got "{decode(bad)[:40]}"', line)
            wanted = 0
            for p in element.properties:
                length = values[wanted] if wanted < len(values) else None
                wanted += 1 + (size_of(float(length[0]), element, line) if p.length_type and length is not None else 0)
            if wanted != len(words):
                return Fault(f"element {element.name} must have {wanted} numbers on its line, got {len(words)}", line)
    rest = next(filled, None)
    if rest:
        return Fault("must end after the elements that its header announces, got more numbers", rest[0])
    return Fault("must have the elements that its header announces")


def binary_tables(data: bytes, at: int, order: str, elements: list[Element]) -> tuple[dict[str, Table], int]:
    """(values, next byte) of a binary file from byte `at` on. `order` is "<", ">" or "=". Raises Fault."""
    tables = {}
    for element in elements:
        found = uniform(data, at, order, element)
        tables[element.name], at = found if found else row_by_row(data, at, order, element)
    return tables, at


def uniform(data: bytes, at: int, order: str, element: Element) -> tuple[Table, int] | None:
    """(values, next byte) of an element whose lists all have the same lengths as in its first row, else None."""
    fields = []
    lengths: dict[str, int] = {}
    end = at
    for p in element.properties:
        if p.length_type:
            length = read_number(data, end, order + p.length_type, element) if element.count else 0
            lengths[p.name] = size_of(length, element)
            fields += [(f"#{p.name}", order + p.length_type), (p.name, order + p.type, (lengths[p.name],))]
        else:
            fields.append((p.name, order + p.type))
        end = at + np.dtype(fields).itemsize
    if len({name for name, *_ in fields}) < len(fields):
        raise Fault(f"element {element.name} must have properties of different names")
    row = np.dtype(fields)
    if at + row.itemsize * element.count > len(data):
        return None
    rows = np.frombuffer(data, row, element.count, at) if row.itemsize else np.zeros(element.count, row)
    if any((rows[f"#{name}"] != length).any() for name, length in lengths.items()):
        return None
    table: Table = {}
    for p in element.properties:
        values = rows[p.name].ravel().astype(np.float64)
        table[p.name] = Lists(np.full(element.count, lengths[p.name]), values) if p.length_type else values
    return table, at + row.itemsize * element.count


def row_by_row(data: bytes, at: int, order: str, element: Element) -> tuple[Table, int]:
    """(values, next byte) of any element."""
    columns: dict[str, list[float]] = {p.name: [] for p in element.properties}
    lengths: dict[str, list[int]] = {p.name: [] for p in element.properties}
    for _ in range(element.count):
        for p in element.properties:
            length = 1
            if p.length_type:
                length = size_of(read_number(data, at, order + p.length_type, element), element)
                at += WIDTHS[p.length_type]
            end = at + length * WIDTHS[p.type]
            if end > len(data):
                raise too_short(element)
            columns[p.name] += struct.unpack_from(f"{order}{length}{CODES[p.type]}", data, at)
            lengths[p.name].append(length)
            at = end
    table: Table = {}
    for p in element.properties:
        values = np.array(columns[p.name], np.float64)
        table[p.name] = Lists(np.array(lengths[p.name], np.int64), values) if p.length_type else values
    return table, at


def read_number(data: bytes, at: int, kind: str, element: Element) -> float:
    """One number of a type with its byte order."""
    if at + WIDTHS[kind[1:]] > len(data):
        raise too_short(element)
    return struct.unpack_from(kind[0] + CODES[kind[1:]], data, at)[0]


def size_of(length: float, element: Element, line: int | None = None) -> int:
    """The length of a list, as a whole number."""
    if not (0 <= length <= MOST_CORNERS and length == int(length)):
        raise Fault(
            f"a list of element {element.name} must have a length from 0 to {MOST_CORNERS}, got {length:g}", line
        )
    return int(length)


def too_short(element: Element) -> Fault:
    return Fault(f"must have {element.count} of element {element.name}, as its header says, but the file ends before")

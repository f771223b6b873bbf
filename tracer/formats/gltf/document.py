"""A glTF document: its JSON, whose every value is checked when it is read, and its buffers.

Format: Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022). A `.glb` file holds the JSON and one buffer; a
`.gltf` file is the JSON, and its buffers are files or data URIs.
"""

import base64
import json
import math
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeVar
from urllib.parse import unquote, unquote_to_bytes

from tracer import fields
from tracer.formats.notes import Notes
from tracer.formats.source import MOST_TEXT, Fault, check_regular, decode, read_bytes

T = TypeVar("T")

MAGIC, JSON_CHUNK, BINARY_CHUNK = b"glTF", 0x4E4F534A, 0x004E4942
TO_BASE64, WHITE_SPACE = bytes.maketrans(b"-_", b"+/"), b" \t\r\n"  # the alphabet for URLs is understood, too
WORDS = {dict: "an object", list: "a list", str: "a text", int: "a whole number", bool: "true or false"}


class Item:
    """A JSON object, and its place in the document for messages."""

    def __init__(self, value: Any, place: str) -> None:
        self.value: dict[str, Any] = checked(value, dict, place)
        self.place = place

    def at(self, key: str) -> str:
        """The place of a key."""
        return f"{self.place}.{key}" if self.place else key

    def has(self, key: str) -> bool:
        return key in self.value

    def item(self, key: str) -> "Item":
        """The object of a key; an empty one if the key is missing."""
        return Item(self.value.get(key, {}), self.at(key))

    def items(self, key: str) -> list["Item"]:
        """The list of objects of a key."""
        return [Item(value, f"{self.at(key)}[{k}]") for k, value in enumerate(self.entries(key))]

    def entries(self, key: str) -> list[Any]:
        return checked(self.value.get(key, []), list, self.at(key))

    def text(self, key: str, default: str = "") -> str:
        return checked(self.value.get(key, default), str, self.at(key))

    def flag(self, key: str) -> bool:
        return checked(self.value.get(key, False), bool, self.at(key))

    def whole(self, key: str, default: int | None = None, most: int = 2**53) -> int:
        """A whole number from 0 to `most`."""
        value = self.value.get(key, default)
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        value = checked(value, int, self.at(key))
        if not 0 <= value <= most:
            raise Fault(f"{self.at(key)} must be from 0 to {most}, got {value}")
        return value

    def number(self, key: str, default: float, least: float = -math.inf, most: float = math.inf) -> float:
        """A finite number in a range."""
        (value,) = self._numbers(key, [self.value.get(key, default)])
        if not least <= value <= most:
            raise Fault(f"{self.at(key)} must be from {least:g} to {most:g}, got {value:g}")
        return value

    def numbers(self, key: str, default: list[float], least: float = -math.inf) -> list[float]:
        """As many finite numbers as the default has, none below `least`."""
        values = self.entries(key) if key in self.value else default
        if len(values) != len(default):
            raise Fault(f"{self.at(key)} must have {len(default)} numbers, got {len(values)}")
        numbers = self._numbers(key, values)
        if min(numbers) < least:
            raise Fault(f"{self.at(key)} must have numbers of at least {least:g}, got {min(numbers):g}")
        return numbers

    def _numbers(self, key: str, values: list[Any]) -> list[float]:
        for value in values:
            if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= fields.LARGEST:
                raise Fault(f"{self.at(key)} must have finite numbers, got {fields.shown(value)}")
        return [float(value) for value in values]


def checked(value: Any, kind: type[T], place: str) -> T:
    """The value, if it has the type. A flag is no number."""
    if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
        raise Fault(f"{place or 'the document'} must be {WORDS[kind]}, got {found(value)}")
    return value


def found(value: Any) -> str:
    """A JSON value for a message."""
    match value:
        case None:
            return "nothing"
        case list():
            return "a list"
        case dict():
            return "an object"
        case _:
            return fields.shown(value)


def read_document(path: Path, notes: Notes) -> tuple[Item, bytes | None]:
    """(document, binary chunk or None) of a file, whatever its suffix. Raises Fault."""
    data = read_bytes(path)
    if data[:4] != MAGIC:
        if path.suffix.lower() == ".glb":
            raise Fault('must begin with "glTF" and a JSON chunk')
        check_regular(path, MOST_TEXT)
        return parsed_json(data), None
    if len(data) < 20:
        raise Fault(f"must have a header and a JSON chunk, got {len(data)} bytes")
    _, version, length = struct.unpack_from("<4sII", data)
    if version != 2:
        raise Fault(f"must be glTF 2, got version {version}")
    if length > len(data):
        raise Fault(f"must have {length} bytes, as its header says, got {len(data)}")
    notes.count("bytes after the end that the header tells are not read", len(data) - length)
    chunks = dict(reversed(list(chunks_of(data[:length]))))  # of two chunks of one kind the first counts
    if JSON_CHUNK not in chunks:
        raise Fault("must have a JSON chunk, got none")
    return parsed_json(chunks[JSON_CHUNK].rstrip(b"\0")), chunks.get(BINARY_CHUNK)


def chunks_of(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield (type, content) of the chunks of a GLB file."""
    at = 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > len(data):
            raise Fault(f"a chunk must end within the file, got one of {length} bytes with {len(data) - at - 8} left")
        yield kind, data[at + 8 : at + 8 + length]
        at += 8 + length


def parsed_json(data: bytes) -> Item:
    try:
        value = json.loads(decode(data))
    except RecursionError:
        raise Fault("must be JSON that is not nested so deeply") from None
    except ValueError as error:
        raise Fault(f"must be JSON: {str(error).splitlines()[0][:100]}") from None
    return Item(value, "")


def read_buffer(buffer: Item, folder: Path, binary: bytes | None, files: list[Path]) -> bytes:
    """The bytes of a buffer: the binary chunk, a data URI or a file, which is added to `files`."""
    length = buffer.whole("byteLength", 0)
    uri = buffer.text("uri")
    if not uri:
        data = binary
    elif uri[:5].lower() == "data:":
        data = data_of(uri, f"{buffer.place}.uri")
    else:
        path = folder / unquote(uri)
        if not path.exists() and "\\" in uri:
            path = folder / unquote(uri).replace("\\", "/")
        files.append(path)
        try:
            data = read_bytes(path)
        except FileNotFoundError:
            raise Fault("buffer file not found", file=path) from None
        except OSError as error:
            raise Fault(f"buffer file cannot be read: {error.strerror}", file=path) from None
        except Fault as fault:
            raise Fault(f"buffer file {fault}", file=path) from None
    if data is None or len(data) < length:
        raise Fault(f"{buffer.place} must have {length} bytes, got {len(data or b'')}")
    return data


def data_of(uri: str, place: str) -> bytes:
    """The bytes of a data URI (RFC 2397). Raises Fault."""
    head, _, content = uri.partition(",")
    data = unquote_to_bytes(content)
    if not head.lower().endswith(";base64"):
        return data
    try:
        return base64.b64decode(data.translate(TO_BASE64, WHITE_SPACE), validate=True)
    except ValueError as error:
        raise Fault(f"{place} must be base64: {error}") from None

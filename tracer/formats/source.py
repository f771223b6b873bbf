"""The content of a file: bytes of a regular file of limited size, or text in any encoding that programs write."""

import re
import stat
from pathlib import Path

MOST_TEXT = 256 * 2**20  # bytes of a text file
MOST_BYTES = 2**30  # bytes of a binary file

UTF_16 = (b"\xff\xfe", b"\xfe\xff")  # its byte order marks

KINDS = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))


class Fault(Exception):
    """An error in a file. The text is one line, without the file's name: what was found and what is allowed.

    `line` is the line of the error. `file` is set if it is in another file than the one that is read, for example in a
    material library.
    """

    def __init__(self, text: str, line: int | None = None, file: Path | None = None) -> None:
        super().__init__(text)
        self.line = line
        self.file = file

    def within(self, name: str) -> str:
        """The whole message, for an error in the file `name`."""
        places = [name, self.file.name if self.file else "", f"line {self.line}" if self.line else ""]
        return ": ".join([*filter(None, places), str(self)])


def check_regular(path: Path, most: int = MOST_BYTES) -> None:
    """Raises FileNotFoundError if there is no such file, and Fault if it is not a regular file of at most `most` bytes.

    Reading anything else, such as a pipe, might never end.
    """
    try:
        status = path.stat()
    except ValueError as error:  # a name with a zero byte
        raise Fault(f"not the name of a file: {error}") from None
    if not stat.S_ISREG(status.st_mode):
        kind = next((kind for test, kind in KINDS if test(status.st_mode)), "a device")
        raise Fault(f"must be a file, got {kind}")
    if status.st_size > most:
        raise Fault(f"must have at most {most} bytes, got {status.st_size}")


def read_bytes(path: Path, most: int = MOST_BYTES) -> bytes:
    """The bytes of a regular file. Raises as `check_regular`, and OSError if it cannot be read."""
    check_regular(path, most)
    return path.read_bytes()


def read_text(path: Path) -> str:
    """The text of a file; see `decode`."""
    return decode(read_bytes(path, MOST_TEXT))


def decode(data: bytes, replaced: bool = False) -> str:
    """Text in UTF-8 or UTF-16 with a byte order mark, or in UTF-8. A line that is not UTF-8 is Latin-1, which most old
    programs wrote. If `replaced`, bytes that are not UTF-8 become U+FFFD instead.

    A Control-Z at the end, from DOS, is not part of the text.
    """
    if data[:2] in UTF_16:
        text = data.decode("utf-16", "replace")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("utf-8-sig", "replace") if replaced else "\n".join(map(_line, data.split(b"\n")))
    body, end, rest = text.rpartition("\x1a")
    return body if end and not rest.strip("\x1a\0 \r\n") else text


def utf8(data: bytes) -> bytes:
    """Text in UTF-16 as UTF-8, and any text without its byte order mark."""
    if data[:2] in UTF_16:
        data = decode(data).encode("utf-8")
    return data.removeprefix(b"\xef\xbb\xbf")


def _line(line: bytes) -> str:
    try:
        return line.decode("utf-8-sig")
    except UnicodeDecodeError:
        return line.decode("latin-1")


def lines_of(text: str) -> list[str]:
    """The lines of a text, which end with CR LF, LF or CR only: other characters that Python takes for line ends may
    stand in comments.
    """
    return re.split(r"\r\n|\r|\n", text)

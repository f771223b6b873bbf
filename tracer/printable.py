"""Names and titles as they are shown: without characters that move a cursor, start a command or reorder a line.

A name may come from a file of someone else, and a terminal obeys the control characters that are printed on it. Every
place where text leaves the program calls these functions: terminal, window, figures, tables, messages. Only JSON has
the names as they are, with its own escapes for such characters.
"""

import json
import re
import unicodedata
from pathlib import Path
from typing import Any

NOT_ASCII = re.compile(r"[^\n -~]")


def printable(text: str) -> str:
    """A text on one line, with escapes like `\\x1b` in place of control characters, of line ends, of characters that
    change the direction of writing, and of those that no encoding has.
    """
    if text.isprintable():
        return text
    return "".join(ascii(c)[1:-1] if is_control(c) else c for c in text)


def printable_lines(text: str) -> str:
    """The same for a text of several lines: its line ends stay."""
    return "\n".join(map(printable, text.split("\n")))


def shown_path(path: Path | str) -> str:
    """A path that can be printed, even if its name is not valid UTF-8 or has control characters."""
    return printable(str(path))


def json_text(value: Any, indent: int | None = None) -> str:
    """JSON in UTF-8 characters, except those that `printable` replaces: they have JSON's escapes, and so are read back
    as they were. ValueError for NaN and infinite numbers.
    """
    text = json.dumps(value, indent=indent, allow_nan=False, ensure_ascii=False)
    return NOT_ASCII.sub(lambda found: json.dumps(found[0])[1:-1] if is_control(found[0]) else found[0], text)


def is_control(c: str) -> bool:
    """Whether a character is a control character, a line end or unassigned. Joiners belong to words."""
    kind = unicodedata.category(c)
    return kind in ("Zl", "Zp") or (kind.startswith("C") and c not in "\u200c\u200d")

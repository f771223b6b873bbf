"""Standard output and standard error: one place writes to each, without control characters that came from a file.

A disk that is full, or a stream that is closed, is one line about it. A reader that has read enough, like `head`, is
no error.
"""

import contextlib
import sys

from tracer.printable import printable, printable_lines
from viewer.base.files import Unusable


class ReaderGone(Exception):
    """Whoever reads standard output has closed it: there is nobody left to write for."""


def put(text: str) -> None:
    """Write text to standard output, in UTF-8 whatever the system's own encoding is. ReaderGone if nobody reads it,
    Unusable if it cannot be written.
    """
    if sys.stdout is None:
        raise Unusable("standard output: cannot be written: it is closed")
    try:
        sys.stdout.buffer.write(printable_lines(text).encode("utf-8"))
        sys.stdout.buffer.flush()
    except BrokenPipeError:
        raise ReaderGone from None
    except OSError as error:
        raise Unusable(f"standard output: cannot be written: {error.strerror or error}") from None


def put_error(line: str) -> None:
    """Write one line to standard error. If that is full or closed, there is no place left to say so."""
    put_raw_error(f"{printable(line)}\n")


def put_note(note: str) -> None:
    """Write a note beside the command's output."""
    put_error(f"note: {note}")


def put_raw_error(text: str) -> None:
    """Write text with our own control characters to standard error."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):  # ValueError: it was closed in Python
            sys.stderr.write(text)
            sys.stderr.flush()

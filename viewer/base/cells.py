"""Cells of a CSV file that a spreadsheet may open."""

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Any

from tracer.printable import printable

FORMULAS = ("=", "+", "-", "@")  # spreadsheets run a cell that begins with one of these


def csv_text(rows: Iterable[Sequence[Any]]) -> str:
    """The rows as CSV. Text has no control characters, and a `'` in front where a spreadsheet would take it for a
    formula. Numbers stay as they are; None is an empty cell.
    """
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerows([_cell(value) for value in row] for row in rows)
    return buffer.getvalue()


def _cell(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    text = printable(value)
    return f"'{text}" if text.startswith(FORMULAS) else text

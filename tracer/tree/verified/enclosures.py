"""The enclosures of a recorded tree that a verified tree consists of."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

Range = tuple[float, float]  # floats below and above the exact number
RGBRange = tuple[Range, Range, Range]
UNKNOWN: RGBRange = ((0.0, math.inf), (0.0, math.inf), (0.0, math.inf))


@dataclass
class VerifiedRow:
    """The certified part of a recorded row."""

    doubts: tuple[str, ...] = ()  # its own decisions that are not certified
    certified: bool = False  # its way, and those of the rows above it; a colour of a checker may still be in doubt
    point: tuple[Range, Range, Range] | None = None  # None: it meets nothing, or it is not certain what
    weight: Range | None = None
    radiance: RGBRange = UNKNOWN

    @property
    def is_sure(self) -> bool:
        """Whether neither its way nor anything decided at its hit is in doubt."""
        return self.certified and not self.doubts


class VerifiedTree(NamedTuple):
    """Enclosures of a recorded tree."""

    rows: list[VerifiedRow]
    bits: int  # precision of the balls
    decisions: int
    certified: int  # of the decisions
    tested: int  # surfaces that were decided in balls, over all rays
    boxed: int  # surfaces that their boxes exclude, over all rays
    cut: float  # the weight of the rays that were cut is at most this; the colour is that of the others
    missing: tuple[float, float, float]  # these rays bring at most so much, linear RGB; inf where no bound is known
    unbounded: str  # the material because of which the colour has no upper end; empty if it has one

    @property
    def color(self) -> RGBRange:
        """The enclosure of the tree's colour, linear RGB."""
        return self.rows[0].radiance

    def to_dict(self) -> dict[str, Any]:
        """The summary for JSON. An end that is not finite is None."""
        return {
            "bits": self.bits,
            "color": [_ends(part) for part in self.color],
            "missing": [x if math.isfinite(x) else None for x in self.missing],
            "decisions": self.decisions,
            "certified": self.certified,
            "surfaces_tested": self.tested,
            "surfaces_excluded_by_boxes": self.boxed,
            "unbounded_material": self.unbounded or None,
        }

    def row_to_dict(self, i: int) -> dict[str, Any]:
        """The enclosures of row i for JSON."""
        row = self.rows[i]
        return {
            "certified": row.is_sure,
            "doubts": list(row.doubts),
            "point": None if row.point is None else [_ends(part) for part in row.point],
            "weight": None if row.weight is None else _ends(row.weight),
            "radiance": [_ends(part) for part in row.radiance],
        }


def _ends(part: Range) -> list[float | None]:
    return [x if math.isfinite(x) else None for x in part]

"""A verified tree in words."""

import math
from collections.abc import Callable
from decimal import ROUND_CEILING, Decimal, localcontext

from tracer.tree.digits import number_text
from tracer.tree.verified.enclosures import Range, VerifiedTree

MOST = 5  # doubts that are listed


def verified_text(verified: VerifiedTree, label: Callable[[int], str]) -> list[str]:
    """The lines about the colour and the decisions. `label` gives the label of a row."""
    return [f"verified with {verified.bits} bits: {color_text(verified)}", *decision_lines(verified, label)]


def color_text(verified: VerifiedTree) -> str:
    """The enclosure of the colour."""
    most = max(high - low for low, high in verified.color)
    if math.isinf(most):
        least = " ".join(number_text(low) for low, _ in verified.color)
        return (
            f"the exact colour is at least {least} (r g b), and has no upper end, because no bound is known for the "
            f'material "{verified.unbounded}"'
        )
    which = "the exact colour, without the rays that were cut, is " if verified.cut > 0.0 else "the exact colour is "
    return which + ", ".join(range_text(part) for part in verified.color) + " (r, g, b)"


def range_text(part: Range) -> str:
    """A range with the digits that both ends share, and how far the ends are from these at most; or both ends."""
    low, high = part
    width, middle = high - low, 0.5 * (low + high)
    if width > 1e-3 * high:
        return f"{number_text(low)} to {number_text(high)}"
    shown = repr(middle)
    if width > 0.0:
        digits = max(1, min(17, math.floor(math.log10(middle) - math.log10(width))))
        shown = f"{middle:.{digits}g}"
    with localcontext(prec=1100, rounding=ROUND_CEILING):  # so many digits that every difference of floats is exact
        off = max(Decimal(high) - Decimal(shown), Decimal(shown) - Decimal(low))
        return f"{shown} ± {off:.1e}" if off > 0 else shown


def decisions_text(verified: VerifiedTree) -> str:
    """The number of decisions that are certified."""
    if verified.certified == verified.decisions:
        return f"all {verified.decisions} decisions are certified"
    return f"{verified.certified} of {verified.decisions} decisions are certified"


def decision_lines(verified: VerifiedTree, label: Callable[[int], str]) -> list[str]:
    """The number of decisions that are certified, the ways they were, and the others."""
    surfaces = f"surfaces: {verified.tested} decided in ball arithmetic, {verified.boxed} excluded by their boxes"
    doubts = [f"{label(i)}: {doubt}" for i, row in enumerate(verified.rows) for doubt in row.doubts]
    listed = "; ".join(doubts[:MOST]) + (f"; and {len(doubts) - MOST} more" if len(doubts) > MOST else "")
    return [f"{decisions_text(verified)}; {surfaces}", *([f"not certified: {listed}"] if doubts else [])]

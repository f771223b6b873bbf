"""The distribution of the errors of a family's draws."""

import math
from collections.abc import Iterable

from tracer.measure.check.case import Reading

QUANTILES = {"median": 0.5, "90 %": 0.9, "99 %": 0.99, "worst": 1.0}


def quantiles(errors: Iterable[float]) -> dict[str, float]:
    """The errors that these shares of all errors do not exceed."""
    ranked = sorted(errors)
    return {name: ranked[math.ceil(share * len(ranked)) - 1] for name, share in QUANTILES.items()}


def ours(family: Reading) -> dict[str, float]:
    return quantiles(draw.error for draw in family.draws)


def the_textbooks(family: Reading) -> dict[str, float]:
    return quantiles(draw.textbook_error for draw in family.draws if draw.textbook_error is not None)

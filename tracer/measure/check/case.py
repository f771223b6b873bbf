"""A case of `raytree check`: a scene with an exact answer, the answer of the textbook's formula, and ours.

An error, ours or the textbook's, is counted in units of rounding: u = 2^-53 times the size of the answer times the
case's condition number, the factor by which the problem magnifies rounding errors of its input. Exact answers are
computed with 50 decimal digits, or are whole numbers, fractions and words.

A family is many random draws of one problem from a fixed seed. Its reading is the draw with our largest error.
"""

import inspect
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from functools import cached_property
from typing import Literal

from tracer.formulas.double_double import U

DIGITS = Context(prec=50)

Exact = Decimal | Fraction | int | str
Got = float | int | str
Comparison = Literal["better", "as good", "worse"]


@dataclass(frozen=True)
class Reading:
    """One answer of a case, at one of its settings."""

    setting: str  # in a few words or symbols: "D = 1e7"
    exact: Exact
    got: Got
    unit: float = U  # in the unit of the answer: u times its size times the condition number
    allowed: float = 4.0  # units
    textbook: Got | None = None  # the textbook's answer; None if it has none
    draws: tuple["Reading", ...] = ()  # of a family: all its draws

    @cached_property
    def error(self) -> float:
        """Our error in units; infinite if the answer is not of the right kind."""
        return self._in_units(self.got)

    @cached_property
    def textbook_error(self) -> float | None:
        """The textbook's error in the same units; None if it has no answer."""
        return None if self.textbook is None else self._in_units(self.textbook)

    def _in_units(self, answer: Got) -> float:
        if self.unit > 0.0:
            return off(answer, self.exact) / self.unit
        return 0.0 if answer == self.exact else math.inf

    @property
    def share(self) -> float:
        """Our error as a share of what is allowed; above 1 if it is too large."""
        return self.error / (self.allowed or 1.0)

    @property
    def textbooks_worst(self) -> "Reading":
        """Of a family the draw with the textbook's largest error; otherwise the reading itself."""
        return max((self, *self.draws), key=lambda one: -1.0 if one.textbook_error is None else one.textbook_error)

    @property
    def comparison(self) -> Comparison | None:
        """The textbook's largest error compared with ours; None if it has no answer."""
        return compare(self.textbooks_worst.textbook_error, self.error)

    @property
    def ok(self) -> bool:
        return self.error <= self.allowed


# The meaning of the first letter of a case's id.
TOPICS = {
    "A": "spheres",
    "B": "flat faces, meshes and boxes",
    "C": "the start of a ray, and the scale of a scene",
    "D": "refraction at a surface",
    "E": "long chains of bounces",
    "F": "trees that branch without end",
    "G": "geometrical optics",
    "H": "one medium in another",
    "I": "shadows and mirrors",
    "J": "what must not change a tree, and invalid input",
    "K": "cones and cylinders",
    "L": "rays that a scene does not need",
}


@dataclass(frozen=True)
class Case:
    id: str  # a letter of TOPICS and a number
    title: str  # in one line
    read: Callable[[], Iterable[Reading]]
    wrong: str  # explanation of the textbook's error; wrapped when printed
    seconds: float  # that it is expected to take, beside other cases


Read = Callable[[], Iterable[Reading]]


def case(id: str, title: str, seconds: float = 0.01) -> Callable[[Read], Case]:
    """Make a case of a function that yields its readings. The docstring explains why the textbook's formula fails.

    `seconds` is about how long it takes, for the display of the time left. Only cases from 0.05 s on need it.
    """
    if id[0] not in TOPICS or not id[1:].isdigit():
        raise ValueError(f"the id of a case must be a letter of {', '.join(TOPICS)} and a number, got {id}")
    return lambda read: Case(id, title, read, inspect.cleandoc(read.__doc__ or ""), seconds)


@dataclass(frozen=True)
class Result:
    case: Case
    readings: Sequence[Reading]

    @property
    def worst(self) -> Reading:
        """The reading whose error is the largest share of what is allowed. Of equal ones, that with the textbook's
        largest error.
        """
        return max(self.readings, key=lambda reading: (reading.share, reading.textbooks_worst.textbook_error or 0.0))

    @property
    def textbooks_worst(self) -> Reading:
        """The reading, or the draw of a family, with the textbook's largest error; `worst` if none is larger."""
        each = (self.worst, *(reading.textbooks_worst for reading in self.readings))
        return max(each, key=lambda reading: reading.textbook_error or 0.0)

    @property
    def ok(self) -> bool:
        return bool(self.readings) and all(reading.ok for reading in self.readings)


def worst_of(setting: str, draws: Iterable[Reading]) -> Reading:
    """The reading of a family: the draw with our largest error, as a share of what is allowed."""
    every = tuple(draws)
    worst = max(every, key=lambda draw: draw.share)
    named = tuple(replace(draw, setting=f"{setting}, one of {len(every)}") for draw in every)
    return replace(worst, setting=f"{setting}, worst of {len(every)}", draws=named)


def compare(theirs: float | None, ours: float) -> Comparison | None:
    """The textbook's error compared with ours."""
    if theirs is None:
        return None
    return "worse" if theirs > ours else "as good" if theirs == ours else "better"


def run(case: Case) -> Result:
    with localcontext(DIGITS):
        return Result(case, tuple(case.read()))


def off(value: Got, exact: Exact) -> float:
    """The distance of a number from the exact answer; for words 0 or infinite."""
    if isinstance(exact, str) or isinstance(value, str):
        return 0.0 if value == exact else math.inf
    if not math.isfinite(value):
        return math.inf
    return float(abs(DIGITS.subtract(decimal(value), decimal(exact))))


def decimal(value: Exact | float) -> Decimal:
    """A number with 50 digits; of a float, all its digits."""
    if isinstance(value, Fraction):
        return DIGITS.divide(Decimal(value.numerator), Decimal(value.denominator))
    return Decimal(value)


def root(value: Exact | float) -> Decimal:
    return DIGITS.sqrt(decimal(value))


def exactly(setting: str, exact: Exact, got: Got, textbook: Got | None = None) -> Reading:
    """A reading that leaves no room for rounding: a word, a count, or a number whose digits must be exact."""
    return Reading(setting, exact, got, 0.0, 0.0, textbook)

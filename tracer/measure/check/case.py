"""A case of `raytree check`: a scene with an exact answer, what the textbook formula makes of it, and what we do.

An error is counted in units of rounding: u = 2^-53 times the answer's size times the case's condition number, which is
how much more than the answer's own rounding the rounding of what is given may change it. Exact answers are worked out
with 50 decimal digits or are whole numbers, fractions and words.
"""

import inspect
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from fractions import Fraction

from tracer.formulas.double_double import U

DIGITS = Context(prec=50)

Exact = Decimal | Fraction | int | str
Got = float | int | str


@dataclass(frozen=True)
class Reading:
    """One answer of a case, at one of its settings."""

    setting: str  # in a few words or symbols: "D = 1e7"
    exact: Exact
    got: Got
    unit: float = U  # of the error, in the answer's own unit: u times its size times the condition number
    allowed: float = 4.0  # units
    textbook: Got | None = None  # the textbook's answer; None where it has nothing to say

    @property
    def error(self) -> float:
        """In units; infinite where the answer is not even of the right kind."""
        return (
            off(self.got, self.exact) / self.unit if self.unit > 0.0 else (0.0 if self.got == self.exact else math.inf)
        )

    @property
    def textbook_error(self) -> float | None:
        """Absolute, or relative to the exact answer where that is not 0."""
        if self.textbook is None:
            return None
        return off(self.textbook, self.exact) / self.size

    @property
    def gain(self) -> float:
        """How many times the textbook's error is ours."""
        return (self.textbook_error or 0.0) / (off(self.got, self.exact) / self.size + U)

    @property
    def size(self) -> float:
        """What errors are relative to: of the exact answer, 1 for 0 and for words."""
        return (0.0 if isinstance(self.exact, str) else abs(float(self.exact))) or 1.0

    @property
    def ok(self) -> bool:
        return self.error <= self.allowed


@dataclass(frozen=True)
class Case:
    id: str
    title: str  # what it is, in one line
    read: Callable[[], Iterable[Reading]]
    wrong: str  # what goes wrong in the textbook's way, and why; wrapped when shown


Read = Callable[[], Iterable[Reading]]


def case(id: str, title: str) -> Callable[[Read], Case]:
    """Make a case of a function that yields its readings. The docstring says what goes wrong in the textbook's way."""
    return lambda read: Case(id, title, read, inspect.cleandoc(read.__doc__ or ""))


@dataclass(frozen=True)
class Result:
    case: Case
    readings: Sequence[Reading]

    @property
    def worst(self) -> Reading:
        """The reading that comes nearest to what is allowed, or goes farthest beyond."""
        return max(self.readings, key=lambda reading: reading.error / (reading.allowed or 1.0))

    @property
    def telling(self) -> Reading:
        """The worst where the case falls short; else the one where we do most better than the textbook."""
        return self.worst if not self.ok else max(self.readings, key=lambda reading: reading.gain)

    @property
    def ok(self) -> bool:
        return bool(self.readings) and all(reading.ok for reading in self.readings)


def run(case: Case) -> Result:
    with localcontext(DIGITS):
        return Result(case, tuple(case.read()))


def off(value: Got, exact: Exact) -> float:
    """How far a number is from the exact answer; for words 0 or infinite."""
    if isinstance(exact, str) or isinstance(value, str):
        return 0.0 if value == exact else math.inf
    if not math.isfinite(value):
        return math.inf
    return float(abs(DIGITS.subtract(decimal(value), decimal(exact))))


def decimal(value: Exact | float) -> Decimal:
    """A number with 50 digits; of a float all it has."""
    if isinstance(value, Fraction):
        return DIGITS.divide(Decimal(value.numerator), Decimal(value.denominator))
    return Decimal(value)


def root(value: Exact | float) -> Decimal:
    return DIGITS.sqrt(decimal(value))


def exactly(setting: str, exact: Exact, got: Got, textbook: Got | None = None) -> Reading:
    """A reading with no room for rounding: a word, a number of things, or digits that must be just these."""
    return Reading(setting, exact, got, 0.0, 0.0, textbook)

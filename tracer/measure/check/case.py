"""A case of `raytree check`: a scene with an exact answer, the answer of the textbook's formula, and ours.

An error is counted in units of rounding: u = 2^-53 times the size of the answer times the case's condition number,
the factor by which the problem magnifies rounding errors of its input. Exact answers are computed with 50 decimal
digits, or are whole numbers, fractions and words.
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
    unit: float = U  # in the unit of the answer: u times its size times the condition number
    allowed: float = 4.0  # units
    textbook: Got | None = None  # the textbook's answer; None if it has none

    @property
    def error(self) -> float:
        """The error in units; infinite if the answer is not of the right kind."""
        return (
            off(self.got, self.exact) / self.unit if self.unit > 0.0 else (0.0 if self.got == self.exact else math.inf)
        )

    @property
    def textbook_error(self) -> float | None:
        """Relative to the exact answer, or absolute if that is 0."""
        if self.textbook is None:
            return None
        return off(self.textbook, self.exact) / self.size

    @property
    def gain(self) -> float:
        """The ratio of the textbook's error to ours."""
        return (self.textbook_error or 0.0) / (off(self.got, self.exact) / self.size + U)

    @property
    def size(self) -> float:
        """The size of the exact answer, to which errors are relative; 1 for 0 and for words."""
        return (0.0 if isinstance(self.exact, str) else abs(float(self.exact))) or 1.0

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
    "L": "rays that a scene does not need",
}


@dataclass(frozen=True)
class Case:
    id: str  # a letter of TOPICS and a number
    title: str  # in one line
    read: Callable[[], Iterable[Reading]]
    wrong: str  # explanation of the textbook's error; wrapped when printed


Read = Callable[[], Iterable[Reading]]


def case(id: str, title: str) -> Callable[[Read], Case]:
    """Make a case of a function that yields its readings. The docstring explains why the textbook's formula fails."""
    if id[0] not in TOPICS or not id[1:].isdigit():
        raise ValueError(f"the id of a case must be a letter of {', '.join(TOPICS)} and a number, got {id}")
    return lambda read: Case(id, title, read, inspect.cleandoc(read.__doc__ or ""))


@dataclass(frozen=True)
class Result:
    case: Case
    readings: Sequence[Reading]

    @property
    def worst(self) -> Reading:
        """The reading that is nearest to the allowed error, or farthest beyond it."""
        return max(self.readings, key=lambda reading: reading.error / (reading.allowed or 1.0))

    @property
    def telling(self) -> Reading:
        """The reading to be shown: the worst if the case fails, otherwise the one with the largest gain over the
        textbook.
        """
        return self.worst if not self.ok else max(self.readings, key=lambda reading: reading.gain)

    @property
    def ok(self) -> bool:
        return bool(self.readings) and all(reading.ok for reading in self.readings)


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

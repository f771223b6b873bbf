"""All cases of `raytree check`, and their results."""

import pkgutil
from collections.abc import Iterator, Sequence
from decimal import Decimal
from fractions import Fraction
from importlib import import_module
from typing import Any

from tracer.measure.check import cases, families
from tracer.measure.check.case import Case, Reading, Result, run
from tracer.measure.check.distribution import ours, the_textbooks
from tracer.progress import Progress, divided, ignore


def all_cases() -> Iterator[Case]:
    """The cases in the files of the folders `cases` and `families`."""
    for folder in (cases, families):
        for file in pkgutil.iter_modules(folder.__path__, f"{folder.__name__}."):
            yield from (value for value in vars(import_module(file.name)).values() if isinstance(value, Case))


CASES = tuple(sorted(set(all_cases()), key=lambda one: (one.id[0], int(one.id[1:]))))


def run_all(cases: Sequence[Case] = CASES, progress: Progress = ignore) -> list[Result]:
    """The results of all cases. `progress` is called with the share of the expected time."""
    results = []
    for case, done in zip(cases, divided(progress, [case.seconds for case in cases]), strict=True):
        results.append(run(case))
        done(1.0)
    return results


def to_dict(results: Sequence[Result]) -> dict[str, Any]:
    """The results for JSON: of each case the worst reading, and below it all readings."""
    return {"cases": [_case(result) for result in results]}


def _case(result: Result) -> dict[str, Any]:
    worst = result.worst
    return {
        "id": result.case.id,
        "ok": result.ok,
        "exact": plain(worst.exact),
        "got": plain(worst.got),
        "error": finite(worst.error),
        "tolerance": worst.allowed,
        "textbook_error": plain(worst.textbooks_worst.textbook_error),
        "textbook_is": worst.comparison,
        "title": result.case.title,
        "readings": [_reading(reading) for reading in result.readings],
    }


def _reading(reading: Reading) -> dict[str, Any]:
    """`textbook_error` is null if the textbook has no answer, or an infinite error: `textbook_is` is null only for the
    former. Of a family, it is the largest of all draws.
    """
    values = {
        "setting": reading.setting,
        "exact": plain(reading.exact),
        "got": plain(reading.got),
        "textbook": plain(reading.textbook),
        "error": finite(reading.error),
        "unit": reading.unit,
        "tolerance": reading.allowed,
        "textbook_error": plain(reading.textbooks_worst.textbook_error),
        "textbook_is": reading.comparison,
        "ok": reading.ok,
    }
    if reading.draws:
        values |= {
            "draws": len(reading.draws),
            "quantiles": {name: finite(error) for name, error in ours(reading).items()},
            "textbook_quantiles": {name: finite(error) for name, error in the_textbooks(reading).items()},
        }
    return values


def plain(value: Any) -> Any:
    """A number or a word for JSON, which has no infinity."""
    if isinstance(value, Decimal | Fraction):
        return float(value)
    return finite(value) if isinstance(value, float) else value


def finite(value: float) -> float | None:
    return value if abs(value) < float("inf") else None

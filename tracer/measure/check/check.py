"""All cases of `raytree check`, and their results."""

import pkgutil
from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal
from fractions import Fraction
from importlib import import_module
from typing import Any

from tracer.measure.check import cases
from tracer.measure.check.case import Case, Result, run


def all_cases() -> Iterator[Case]:
    """The cases in the files of the folder `cases`."""
    for file in pkgutil.iter_modules(cases.__path__, f"{cases.__name__}."):
        yield from (value for value in vars(import_module(file.name)).values() if isinstance(value, Case))


CASES = tuple(sorted(set(all_cases()), key=lambda one: (one.id[0], int(one.id[1:]))))


def run_all(cases: Sequence[Case] = CASES, progress: Callable[[float], None] = lambda share: None) -> list[Result]:
    """The results of all cases. `progress` is called with the share."""
    results = []
    for case in cases:
        results.append(run(case))
        progress(len(results) / len(cases))
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
        "title": result.case.title,
        "readings": [
            {
                "setting": reading.setting,
                "exact": plain(reading.exact),
                "got": plain(reading.got),
                "textbook": plain(reading.textbook),
                "error": finite(reading.error),
                "unit": reading.unit,
                "tolerance": reading.allowed,
                "ok": reading.ok,
            }
            for reading in result.readings
        ],
    }


def plain(value: Any) -> Any:
    """A number or a word for JSON, which has no infinity."""
    if isinstance(value, Decimal | Fraction):
        return float(value)
    return finite(value) if isinstance(value, float) else value


def finite(value: float) -> float | None:
    return value if abs(value) < float("inf") else None

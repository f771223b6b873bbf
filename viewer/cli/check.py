"""`raytree check`: for each case a line with the exact answer, the textbook's and ours."""

import difflib
import json
import textwrap
import time
from collections.abc import Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any

from tracer.measure.check.case import TOPICS, Case, Reading, Result
from tracer.measure.check.check import CASES, run_all, to_dict
from tracer.tree.text import columns
from viewer.base.files import Unusable
from viewer.base.progress import Progress
from viewer.cli.options import CheckOptions
from viewer.cli.terminal import compile_once, put

LONGEST = 20  # characters of a word in the table
NONE = "–"  # the textbook has no formula to compare with
WIDTH = 100  # of running text
HEADINGS = ("setting", "exact answer", "the textbook's", "error", "ours", "error", "")
ABOUT = (
    "Each line is a case, at the setting with the largest ratio of the textbook's error to ours. The textbook's\n"
    "error is relative. Ours is in units of rounding: 2^-53 of the answer times the case's condition number. The\n"
    "allowed number of units follows. If an answer has a bound of its own (some of E and F), the unit is that bound.\n"
    "A dash: the textbook has no formula to compare with.\n"
)


def check(options: CheckOptions) -> int:
    cases = chosen(options.cases)
    compile_once()
    began = time.perf_counter()
    with Progress("check") as progress:
        results = run_all(cases, progress)
    if options.json:
        put(json.dumps(to_dict(results), indent=1, allow_nan=False, ensure_ascii=False) + "\n")
    elif options.explain:
        put("\n".join(explained(result) for result in results))
    else:
        put(table(results) + "\n" + verdict(results, time.perf_counter() - began) + "\n")
    return 0 if all(result.ok for result in results) else 1


def chosen(names: Sequence[str]) -> list[Case]:
    """The cases of these names or groups (a name's first letter); all if none is given. Unusable for unknown names."""
    if not names:
        return list(CASES)
    found: list[Case] = []
    faults: list[str] = []
    for name in names:
        these = [case for case in CASES if name.upper() in (case.id, case.id[0])]
        found += [case for case in these if case not in found]
        if not these:
            close = difflib.get_close_matches(name.upper(), [case.id for case in CASES], 1)
            hint = f"did you mean {close[0]}?" if close else f"the groups are {', '.join(TOPICS)}"
            faults.append(f'raytree check: no case "{name}": {hint}')
    if faults:
        raise Unusable(*faults)
    return found


def table(results: Sequence[Result]) -> str:
    """A table by topic: each case's title, and below it the setting with the answers."""
    head, *rows = columns([("  ", *HEADINGS), *(("  ", *cells(result.telling)) for result in results)])
    lines = [ABOUT, head]
    topic = ""
    for result, row in zip(results, rows, strict=True):
        case = result.case
        if case.id[0] != topic:
            topic = case.id[0]
            lines += ["", f"{topic}  {TOPICS[topic].upper()}"]
        lines += [f"{case.id:4}{case.title}", row]
    return "\n".join(lines) + "\n"


def explained(result: Result) -> str:
    """One case in full: its title, the explanation of the textbook's error, and every setting."""
    case = result.case
    lines = columns([HEADINGS, *(cells(reading) for reading in result.readings)])
    return "\n".join([f"{case.id}  {case.title}", "", textwrap.fill(case.wrong, WIDTH), "", *lines]) + "\n"


def verdict(results: Sequence[Result], seconds: float) -> str:
    short = [result.case.id for result in results if not result.ok]
    count = f"{len(results)} case{'s' if len(results) != 1 else ''} in {seconds:.1f} s"
    return f"{count}: " + (f"{', '.join(short)} failed" if short else "all within what is allowed")


def cells(reading: Reading) -> tuple[str, ...]:
    usual = reading.textbook_error
    lost = NONE if usual is None else ("wrong" if usual == float("inf") else f"{usual:.1e}")
    if usual == 0.0:
        lost = "0"
    if usual is not None and reading.unit == 0.0:
        lost = "wrong" if usual else "right"
    return (
        reading.setting,
        shown(reading.exact),
        NONE if reading.textbook is None else shown(reading.textbook),
        lost,
        shown(reading.got),
        counted(reading),
        "ok" if reading.ok else "FAILED",
    )


def counted(reading: Reading) -> str:
    """The error in units with the allowed number of units; for words, whether they are right."""
    if isinstance(reading.exact, str) or reading.unit == 0.0:
        return "right" if reading.ok else "wrong"
    few = 0.0 < reading.error < 0.01
    return f"{'<0.01' if few else f'{reading.error:.2g}'} of {reading.allowed:g}"


def shown(value: Any) -> str:
    """A number with ten digits, or a word."""
    if isinstance(value, str):
        return value if len(value) <= LONGEST else value[: LONGEST - 1].rpartition(" ")[0] + " …"
    if value == float("inf"):
        return "no hit"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, Fraction) and value.denominator < 1000:
        return str(value)
    return f"{float(value) if isinstance(value, Decimal | Fraction) else value:.10g}"

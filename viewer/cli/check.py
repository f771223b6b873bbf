"""`raytree check`: for each case the exact answer, the textbook's and ours, with their errors in the same unit."""

import difflib
import textwrap
import time
from collections import Counter
from collections.abc import Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any

from tracer.measure.check.case import TOPICS, Case, Reading, Result, compare
from tracer.measure.check.check import CASES, run_all, to_dict
from tracer.measure.check.distribution import QUANTILES, ours, the_textbooks
from tracer.printable import json_text
from tracer.tree.text import columns
from viewer.base.files import Unusable
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.options import CheckOptions
from viewer.cli.terminal import compile_once

LONGEST = 20  # characters of a word in the table
NONE = "–"  # the textbook has no formula to compare with
WIDTH = 100  # of running text
HEADINGS = ("setting", "exact answer", "the textbook's", "error", "ours", "error", "", "textbook is")
COMPARED = {None: "", "better": "better", "as good": "as good", "worse": ""}
ABOUT = """\
Below each case stands the setting at which our error is the largest part of what is allowed. If the textbook's error
is larger at another setting, that one follows. Both errors are in the same unit, a unit of rounding: 2^-53 of the
answer times the condition number of the problem. "0.7 of 4" means 0.7 units, and that 4 are allowed. If an answer has
a bound of its own (some of E and F), the unit is that bound. Words and counts are right or wrong, and numbers whose
every digit counts are exact or inexact. A dash: the textbook has no formula to compare with.
"Worst of 500" is our largest error in 500 random problems, the same in every run; "one of 500" is the one with the
textbook's largest error. --explain shows how the errors are distributed, and every setting.
"""
UNITS = """\
Errors are in units of rounding: 2^-53 of the answer times the condition number of the problem. "Worst of 500" is our
largest error in 500 random problems; "one of 500", below it, is the one with the textbook's largest error.
"""


def check(options: CheckOptions) -> int:
    cases = chosen(options.cases)
    compile_once(batch=True)
    began = time.perf_counter()
    with Progress("check") as progress:
        results = run_all(cases, progress)
    if options.json:
        put(json_text(to_dict(results), indent=1) + "\n")
    elif options.explain:
        put("\n".join([*map(explained, results), UNITS]))
    else:
        put(table(results) + "\n" + comparison(results) + "\n" + verdict(results, time.perf_counter() - began) + "\n")
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
    """A table by topic: each case's title, and below it one or two settings with the answers."""
    chosen = [(result, reading) for result in results for reading in telling(result)]
    head, *rows = columns([("  ", *HEADINGS), *(("  ", *cells(reading)) for _, reading in chosen)])
    lines = [ABOUT, head]
    topic, above = "", None
    for (result, _), row in zip(chosen, rows, strict=True):
        case = result.case
        if case.id[0] != topic:
            topic = case.id[0]
            lines += ["", f"{topic}  {TOPICS[topic].upper()}"]
        if result is not above:
            lines.append(f"{case.id:4}{case.title}")
            above = result
        lines.append(row)
    return "\n".join(lines) + "\n"


def telling(result: Result) -> list[Reading]:
    """The setting with our largest part of the allowed error, and the one with the textbook's largest error."""
    ours, theirs = result.worst, result.textbooks_worst
    return [ours] if theirs is ours else [ours, theirs]


def explained(result: Result) -> str:
    """One case in full: its title, the explanation of the textbook's error, every setting, and of families the
    distribution of the errors.
    """
    case = result.case
    rows = []
    for reading in result.readings:
        rows.append(cells(reading))
        if reading.textbooks_worst is not reading:
            rows.append(cells(reading.textbooks_worst))
    lines = [f"{case.id}  {case.title}", "", textwrap.fill(case.wrong, WIDTH), "", *columns([HEADINGS, *rows])]
    if families := [reading for reading in result.readings if reading.draws]:
        lines += ["", *distributions(families)]
    return "\n".join(lines) + "\n"


def distributions(families: Sequence[Reading]) -> list[str]:
    """A table of the errors of all draws, ours and the textbook's."""
    rows: list[Sequence[str]] = [("errors in units", "", *QUANTILES, "")]
    for family in families:
        rows.append((family.setting, "ours", *map(units, ours(family).values()), ""))
        better, equal = (sum(draw.comparison == word for draw in family.draws) for word in ("better", "as good"))
        compared = f"smaller than ours in {better} of {len(family.draws)}, equal in {equal}"
        rows.append(("", "the textbook's", *map(units, the_textbooks(family).values()), compared))
    return columns(rows)


def comparison(results: Sequence[Result]) -> str:
    """The number of settings at which the textbook is worse, as good and better, and the cases with the latter."""
    found = Counter(reading.comparison for result in results for reading in result.readings if reading.comparison)
    better = [result.case.id for result in results if any(one.comparison == "better" for one in result.readings)]
    where = textwrap.fill(f"It is smaller at settings of {', '.join(better)}.", WIDTH) + "\n" if better else ""
    return (
        f"The textbook has an answer at {found.total()} settings. Its error is larger than ours at {found['worse']}, "
        f"equal at {found['as good']},\nand smaller at {found['better']}. (Of random problems, the largest errors are "
        f"compared.)\n{where}"
    )


def verdict(results: Sequence[Result], seconds: float) -> str:
    short = [result.case.id for result in results if not result.ok]
    count = f"{len(results)} case{'s' if len(results) != 1 else ''} in {seconds:.1f} s"
    return f"{count}: " + (f"{', '.join(short)} failed" if short else "all within what is allowed")


def cells(reading: Reading) -> tuple[str, ...]:
    theirs = reading.textbook_error
    return (
        reading.setting,
        shown(reading.exact),
        NONE if reading.textbook is None else shown(reading.textbook),
        NONE if theirs is None else counted(reading, theirs),
        shown(reading.got),
        counted(reading, reading.error) + (f" of {reading.allowed:.3g}" if reading.unit > 0.0 else ""),
        "ok" if reading.ok else "FAILED",
        COMPARED[compare(theirs, reading.error)],
    )


def counted(reading: Reading, error: float) -> str:
    """An error in units; if nothing may be rounded, whether the answer is right."""
    if reading.unit > 0.0:
        return units(error)
    if isinstance(reading.got, float):
        return "inexact" if error else "exact"
    return "wrong" if error else "right"


def units(error: float) -> str:
    if error == float("inf"):
        return "wrong"
    if 0.0 < error < 0.01:
        return "<0.01"
    return f"{error:.2g}" if error < 100.0 else f"{error:.0f}" if error < 1e5 else f"{error:.1e}"


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

"""The figures as a table for people and as JSON for programs."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.results.figure import Figure, Spread

FORMAT = "raytree-bench/1"
HEAD = ("part", "what", "raytree", "the other", "ratio or value", "lowest .. highest", "n", "wanted", "met")


def as_json(figures: Sequence[Figure], failures: Mapping[str, str], about: Mapping[str, Any], runs: int) -> str:
    rows = [figure.as_dict() for figure in figures]
    return json.dumps(
        {"format": FORMAT, "machine": about, "runs": runs, "figures": rows, "failures": failures}, indent=1
    )


def read_json(path: Path) -> list[Figure]:
    """Read figures back. Raises ValueError if the file is not one of figures."""
    content = json.loads(path.read_text("utf-8"))
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ValueError(f"its format is not {FORMAT}")
    return [Figure.from_dict(row) for row in content["figures"]]


def as_markdown(figures: Sequence[Figure], failures: Mapping[str, str], about: Mapping[str, Any]) -> str:
    rows = [HEAD, *(row(figure) for figure in figures)]
    widths = [max(len(line[k]) for line in rows) for k in range(len(HEAD))]
    lines = [
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)) + " |" for line in rows
    ]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    machine = ", ".join(f"{name} {value}" for name, value in about.items())
    text = f"Medians of n runs in turn; a ratio is that of neighbouring runs. {machine}.\n\n" + "\n".join(lines)
    for name, reason in failures.items():
        text += f"\n\n**{name} could not be run**: {reason}"
    return text + "\n"


def row(figure: Figure) -> tuple[str, ...]:
    verdict, met = figure.verdict, figure.met
    unit = "" if figure.ratio else f" {figure.unit}"
    wanted = f"{'>=' if figure.at_least else '<='} {figure.wanted:g}" if figure.wanted is not None else ""
    return (
        figure.part,
        figure.what,
        value(figure.ours, figure.unit),
        f"{figure.than}: {value(figure.theirs, figure.unit)}" if figure.theirs else figure.than,
        f"{short(verdict.median)}{unit}",
        f"{short(verdict.low)} .. {short(verdict.high)}",
        f"{verdict.runs}",
        wanted,
        "" if met is None else "yes" if met else "**no**",
    )


def value(spread: Spread, unit: str) -> str:
    return f"{short(spread.median)} {unit}"


def short(number: float) -> str:
    """Three digits; integers as they are."""
    if number == int(number) or abs(number) >= 1000:
        return f"{number:.0f}"
    return f"{number:.3g}"

"""The report's numbers for programs: JSON, and a CSV with one line per marker."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from tracer.measure.conditions import Moment
from tracer.measure.precision.errors import MEASURES
from tracer.measure.precision.precision import Point, Source
from tracer.measure.timing import Times
from tracer.printable import json_text
from viewer.base.cells import csv_text
from viewer.report.chapter import Chapter
from viewer.report.conditions import Conditions, busy_note

FORMAT = "raytree-report/1"
HEAD = (
    "scene", "source", "width", "height", "method", "setting", "value", "runs", "seconds", "lower_quartile",
    "upper_quartile", "cpu_seconds", "busy", "rays", "tests", *MEASURES, "bound", "estimate",
)  # fmt: skip


def as_csv(chapters: Sequence[Chapter]) -> bytes:
    """The CSV. Unknown and infinite numbers are empty. `seconds` is the median of the wall times of so many `runs`,
    `cpu_seconds` that of the processor times; `busy` is 1 if the two differ by more than on an idle machine.
    """
    rows: list[Sequence[Any]] = [HEAD]
    for chapter in chapters:
        for source in chapter.sources:
            for curve in source.curves:
                for p in curve.points:
                    off = [getattr(p.errors, name) for name in MEASURES]
                    figures = (*_times(p.times).values(), p.rays, p.tests, *off, p.bound, p.estimate)
                    names = (chapter.name, source.name, *source.size, curve.method, p.label, p.value)
                    rows.append((*names, *map(_finite, figures)))
    return csv_text(rows).encode("utf-8")


def as_json(chapters: Sequence[Chapter], conditions: Conditions) -> bytes:
    scenes = [
        {
            "name": chapter.name,
            "title": chapter.title,
            "sources": [_source(source) for source in chapter.sources],
            "left_out": list(chapter.left_out),
        }
        for chapter in chapters
    ]
    document = {
        "format": FORMAT,
        "command": conditions.command,
        "scenes": scenes,
        "machine": conditions.machine,
        "began": _moment(conditions.began),
        "ended": _moment(conditions.ended),
        "duration": conditions.seconds,
        "warnings": list(filter(None, [busy_note(chapters)])),
    }
    return (json_text(_plain(document), indent=1) + "\n").encode("utf-8")


def _source(source: Source) -> dict[str, Any]:
    reference = {"how": source.reference.how, "own": asdict(source.reference.own)}
    curves = [{**asdict(curve), "points": [_point(point) for point in curve.points]} for curve in source.curves]
    return {
        "name": source.name,
        "title": source.title,
        "size": list(source.size),
        "reference": reference,
        "curves": curves,
        "failures": list(source.failures),
    }


def _point(point: Point) -> dict[str, Any]:
    values = asdict(point)
    del values["times"]
    return {**values, **_times(point.times)}


def _times(times: Times) -> dict[str, Any]:
    return {
        "runs": times.runs,
        "seconds": times.seconds,
        "lower_quartile": times.lower,
        "upper_quartile": times.upper,
        "cpu_seconds": times.cpu_seconds,
        "busy": times.is_busy,
    }


def _moment(moment: Moment) -> dict[str, Any]:
    """`load` is null where the system does not know it."""
    return {"utc": moment.utc, "load": moment.load}


def _finite(number: float) -> Any:
    return number if math.isfinite(number) else ""


def _plain(value: Any) -> Any:
    """The value with null for numbers that JSON does not have."""
    match value:
        case dict():
            return {key: _plain(item) for key, item in value.items()}
        case list() | tuple():
            return [_plain(item) for item in value]
        case float() if not math.isfinite(value):
            return None
    return value

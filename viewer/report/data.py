"""The report's numbers for programs: JSON, and a CSV with one line per marker."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from tracer.measure.precision.errors import MEASURES
from tracer.measure.precision.precision import Source
from tracer.printable import json_text
from viewer.base.cells import csv_text
from viewer.report.chapter import Chapter

FORMAT = "raytree-report/1"
HEAD = ("scene", "source", "method", "setting", "value", "seconds", "rays", "tests", *MEASURES, "bound", "estimate")


def as_csv(chapters: Sequence[Chapter]) -> bytes:
    """The CSV. Unknown and infinite numbers are empty."""
    rows: list[Sequence[Any]] = [HEAD]
    for chapter in chapters:
        for source in chapter.sources:
            for curve in source.curves:
                for p in curve.points:
                    off = [getattr(p.errors, name) for name in MEASURES]
                    figures = (p.seconds, p.rays, p.tests, *off, p.bound, p.estimate)
                    names = (chapter.name, source.name, curve.method, p.label, p.value)
                    rows.append((*names, *map(_finite, figures)))
    return csv_text(rows).encode("utf-8")


def as_json(chapters: Sequence[Chapter], about: Mapping[str, str]) -> bytes:
    scenes = [
        {
            "name": chapter.name,
            "title": chapter.title,
            "sources": [_source(source) for source in chapter.sources],
            "left_out": list(chapter.left_out),
        }
        for chapter in chapters
    ]
    document = {"format": FORMAT, "scenes": scenes, "machine": dict(about)}
    return (json_text(_plain(document), indent=1) + "\n").encode("utf-8")


def _source(source: Source) -> dict[str, Any]:
    reference = {"how": source.reference.how, "own": asdict(source.reference.own)}
    curves = [asdict(curve) for curve in source.curves]
    return {
        "name": source.name,
        "size": list(source.size),
        "reference": reference,
        "curves": curves,
        "failures": list(source.failures),
    }


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

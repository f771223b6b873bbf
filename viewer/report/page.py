"""The report as one HTML file: plots, tables, and at the end machine and versions."""

import math
import re
from collections.abc import Callable, Sequence

from tracer.measure.conditions import Moment
from tracer.measure.precision.experiment import THREADS
from tracer.measure.precision.precision import Curve, Point, Source
from viewer.figures.writers.html.frame import text
from viewer.report.chapter import Chapter
from viewer.report.conditions import Conditions, busy_note

STYLE = """
body { font: 16px/1.45 "DejaVu Sans", Verdana, sans-serif; color: #14181d; max-width: 66em; margin: 2em auto;
  padding: 0 1em; }
h1 { font-size: 1.6em } h2 { font-size: 1.25em; margin-top: 2em }
.plots { display: flex; flex-wrap: wrap; gap: 1em } .plots svg { flex: 1 1 26em; max-width: 32em; height: auto }
table { border-collapse: collapse; font-size: 0.75em; margin: 1em 0; font-variant-numeric: tabular-nums }
th, td { padding: 0.15em 0.45em; text-align: right; border-bottom: 1px solid #d6dbe1; white-space: nowrap }
td:first-child { white-space: normal; min-width: 8em } td:nth-child(2) { white-space: normal; min-width: 6em }
.table { overflow-x: auto }
th:first-child, td:first-child, th:nth-child(2), td:nth-child(2) { text-align: left }
.chapter { margin-top: 3em; padding-top: 0.5em; border-top: 3px solid #14181d }
.warning { border-left: 4px solid #B35C00; background: #FFF4E5; padding: 0.5em 1em }
.busy td { background: #FFF4E5 }
.small { color: #5a6572; font-size: 0.9em }
@media print { body { max-width: none; font-size: 11px } section { break-inside: avoid-page }
  table { font-size: 0.7em } }
"""


def as_html(title: str, chapters: Sequence[Chapter], conditions: Conditions) -> bytes:
    body = [f"<h1>Error against run time: {text(title)}</h1>", f'<p class="small">{text(conditions.command)}</p>']
    body.append(f'<p class="small">{text(_when(conditions))}</p>')
    if note := busy_note(chapters):
        body.append(f'<p class="warning">Warning: {text(note)}. The rows concerned are marked.</p>')
    body.append(f"<p>{text(INTRODUCTION)}</p>")
    several = len(chapters) > 1
    if several:
        links = [f'<li><a href="#{c.anchor}">{text(c.title)}</a></li>' for c in chapters]
        body += ["<ul>", *links, "</ul>"]
    for chapter in chapters:
        body += _chapter(chapter, several)
    body += _list("Machine", [f"{name}: {value}" for name, value in conditions.machine.items()])
    page = ["<!doctype html>", '<html lang="en">', "<head>", '<meta charset="utf-8">']
    page += [f"<title>Error against run time: {text(title)}</title>", f"<style>{STYLE}</style>", "</head>", "<body>"]
    return "\n".join([*page, *body, "</body>", "</html>", ""]).encode("utf-8")


INTRODUCTION = (
    "Each curve is a method, each marker one of its settings; lower left is better. Every setting ran once to warm up, "
    f"and then n times on {THREADS} thread, in turn with all other settings of its section. A time is the median of "
    "these n runs, and a bar reaches from quartile to quartile. On an idle machine the processor time (CPU) is as "
    "long. Sizes and n follow from counted rays and tests, so they are the same in every report. Sizes differ, since "
    "a reference image must not be too much work. An error below the dotted line is no better than that of the "
    "reference. RMSE is in linear light, 1 is white; MRSE is relative to the pixel (pbrt's definition); FLIP is the "
    "difference seen by a person who flips between the two images."
)


def _when(conditions: Conditions) -> str:
    """Date, duration and load."""
    began, ended = conditions.began, conditions.ended
    return (
        f"Measured from {_utc(began)} to {_utc(ended)}, in {conditions.seconds:.0f} s. Load average "
        f"over 1, 5 and 15 minutes: {_load(began)} at the start, {_load(ended)} at the end. Processors: "
        f"{conditions.machine['processors']} of the kind {conditions.machine['processor']}."
    )


def _utc(moment: Moment) -> str:
    return moment.utc.replace("T", " ").replace("+00:00", " UTC")


def _load(moment: Moment) -> str:
    return ", ".join(f"{load:.2f}" for load in moment.load) if moment.load else "unknown"


def _chapter(chapter: Chapter, titled: bool) -> list[str]:
    """A chapter. `titled`: there are several."""
    body = [f'<h1 id="{chapter.anchor}" class="chapter">{text(chapter.title)}</h1>'] if titled else []
    for source in chapter.sources:
        body += _section(f"{chapter.anchor}-{source.name}", source, chapter.plots[source.name])
    failures = [line for source in chapter.sources for line in source.failures]
    body += _list("What failed", failures or ["nothing"])
    return body + (_list("Left out", chapter.left_out) if chapter.left_out else [])


def _section(name: str, source: Source, plots: Sequence[bytes]) -> list[str]:
    drawings = [_inline(plot, f"{name}{k}") for k, plot in enumerate(plots)]
    return [
        f'<section id="{name}">',
        f"<h2>{text(source.title)}</h2>",
        f"<p>{text(source.about)}</p>",
        f'<p class="small">{text(_judged(source))}</p>',
        '<div class="plots">',
        *drawings,
        "</div>",
        *_slopes(source.curves),
        *_table(source),
        "</section>",
    ]


def _judged(source: Source) -> str:
    """The reference of the errors, and the settings that the plots cannot show."""
    own = source.reference.own
    said = f"{source.size[0]}x{source.size[1]} pixels. Reference: {source.reference.how}"
    apart = (
        f"differ by {own.rmse:.1e} (RMSE), {own.largest:.1e} at most" if own.largest else "are the same to the last bit"
    )
    said += "." if source.exact else f"; the two {apart}."
    exact = sum(p.errors.largest == 0.0 for curve in source.curves for p in curve.points)
    if exact:
        are = "settings are" if exact > 1 else "setting is"
        said += f" {exact} {are} exact to the last bit, which a logarithmic axis cannot show."
    return said


def _inline(plot: bytes, name: str) -> str:
    """An SVG for inclusion in the page: without its head, and with ids that start with `name`."""
    svg = plot.decode("utf-8")
    svg = svg[svg.index("<svg") :]
    return re.sub(r'(id="|url\(#|href="#)', rf"\g<1>{name}-", svg)


def _slopes(curves: Sequence[Curve]) -> list[str]:
    lines = [
        f"{curve.method}: error falls as N^{curve.fitted:.2f}; theory has N^{curve.slope:g} for edges"
        for curve in curves
        if curve.slope is not None and curve.fitted is not None
    ]
    return [f"<p>{text('. '.join(lines))}.</p>"] if lines else []


def _table(source: Source) -> list[str]:
    """One row per marker. Empty columns are left out."""
    points = [(curve, p) for curve in source.curves for p in curve.points]
    columns = {name: [figure(p) for _, p in points] for name, figure in COLUMNS.items()}
    shown = {name: cells for name, cells in columns.items() if any(cell not in ("–", "none") for cell in cells)}
    rows = []
    for k, (curve, p) in enumerate(points):
        cells = (curve.method, p.label, *(column[k] for column in shown.values()))
        mark = ' class="busy"' if p.times.is_busy else ""
        rows.append(f"<tr{mark}>{''.join(f'<td>{text(cell)}</td>' for cell in cells)}</tr>")
    head = "".join(f"<th>{name}</th>" for name in ("method", "setting", *shown))
    return [
        '<div class="table"><table>',
        f"<thead><tr>{head}</tr></thead>",
        "<tbody>",
        *rows,
        "</tbody>",
        "</table></div>",
    ]


def _figure(number: float) -> str:
    if math.isnan(number):
        return "–"
    return "none" if math.isinf(number) else f"{number:.2e}" if number else "0"


def _ms(seconds: float) -> str:
    """Milliseconds, with three digits."""
    return f"{1e3 * seconds:.3g}" if seconds < 1.0 else f"{1e3 * seconds:.0f}"


COLUMNS: dict[str, Callable[[Point], str]] = {
    "n": lambda p: f"{p.times.runs}",
    "median (ms)": lambda p: _ms(p.times.seconds),
    "quartiles (ms)": lambda p: f"{_ms(p.times.lower)} to {_ms(p.times.upper)}",
    "CPU (ms)": lambda p: _ms(p.times.cpu_seconds),
    "busy": lambda p: f"{100 * p.times.waited:.0f} %" if p.times.is_busy else "–",
    "rays": lambda p: f"{p.rays}",
    "tests": lambda p: f"{p.tests}",
    "RMSE": lambda p: _figure(p.errors.rmse),
    "estimated": lambda p: _figure(p.estimate),
    "MRSE": lambda p: _figure(p.errors.mrse),
    "largest": lambda p: _figure(p.errors.largest),
    "FLIP": lambda p: _figure(p.errors.flip),
    "bound": lambda p: _figure(p.bound),
}


def _list(title: str, lines: Sequence[str]) -> list[str]:
    return [f"<h2>{title}</h2>", "<ul>", *(f"<li>{text(line)}</li>" for line in lines), "</ul>"]

"""Plots of error against work: one curve per method, one marker per setting, logarithmic axes. Lower left is better.

Curves differ in marker and dash as well as in colour, and are named below the plot, never over it. A hollow marker
is the bound or estimate that the program itself gives. A bar reaches from the lower to the upper quartile of the time.
"""

import io
import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

from tracer.measure.precision.errors import MEASURES
from tracer.measure.precision.precision import Curve, Point, Source

LOOKS = (("#0072B2", "o", "-"), ("#B35C00", "s", "--"), ("#11723F", "^", "-."), ("#5A5A5A", "D", ":"))
INK, GRID = "#14181D", "#D6DBE1"
WORK: dict[str, tuple[str, Callable[[Point], float]]] = {
    "seconds": ("time (s)", lambda point: point.times.seconds),
    "rays": ("rays traced", lambda point: float(point.rays)),
    "tests": ("ray-surface intersection tests", lambda point: float(point.tests)),
}
FORMATS = ("svg", "pdf")
SAME = 40.0  # points: markers nearer than this share a name, if it is the same
WORDY = 26  # characters: a longer method name has a legend line of its own
FEW = 30.0  # an axis with a smaller ratio of its ends also has ticks at 2 and 5


def plot(source: Source, work: str, measure: str) -> dict[str, bytes]:
    """One plot in every format: an error against seconds, rays or tests."""
    import matplotlib as mpl  # pyright: ignore[reportMissingImports]
    from matplotlib.figure import Figure  # pyright: ignore[reportMissingImports]

    settings: Any = {"font.size": 11, "font.family": "DejaVu Sans", "svg.hashsalt": "raytree"}
    with mpl.rc_context(settings | {"svg.fonttype": "none", "pdf.fonttype": 42, "figure.dpi": 72}):
        canvas = Figure(figsize=(6.4, 4.6), layout="constrained", facecolor="white")
        axes = canvas.subplots()
        ends = _draw(axes, source, work, measure)
        names = [name_of(curve) for curve in source.curves]
        canvas.legend(loc="outside lower center", ncols=1 if max(map(len, names)) > WORDY else 2, frameon=False)
        canvas.draw_without_rendering()  # only then are the axes in their final place
        canvas.set_layout_engine("none")  # and stay there
        _say(axes, ends)
        return {name: _saved(canvas, name) for name in FORMATS}


def _saved(canvas: Any, name: str) -> bytes:
    content = io.BytesIO()
    canvas.savefig(content, format=name, metadata={"Date": None} if name == "svg" else {"CreationDate": None})
    return content.getvalue()


def _draw(axes: Any, source: Source, work: str, measure: str) -> "Sequence[End]":
    """Draw the curves. Returns the names of each curve's first and last marker, with their places."""
    from matplotlib.ticker import LogFormatterSciNotation, LogLocator, NullFormatter

    label, cost = WORK[work]
    ends: list[End] = []
    for curve, (color, marker, dash) in zip(source.curves, LOOKS, strict=False):
        points = drawable(curve, measure)
        if not points:
            continue
        x, y = [cost(p) for p in points], [error_of(p, measure) for p in points]
        axes.plot(x, y, color=color, marker=marker, linestyle=dash, linewidth=1.8, markersize=6, label=name_of(curve))
        if work == "seconds":
            off = [(p.times.seconds - p.times.lower, p.times.upper - p.times.seconds) for p in points]
            bars = list(zip(*off, strict=True))
            axes.errorbar(x, y, xerr=bars, color=color, fmt="none", elinewidth=1.2, capsize=3.0)
        ends += [(points[k].label, color, x[k], y[k]) for k in sorted({0, len(points) - 1})]
        by_itself, word = said_of(source, measure)
        said = [(cost(p), by_itself(p)) for p in points if 0.0 < by_itself(p) < math.inf]
        if said:
            axes.plot(
                *zip(*said, strict=True), color=color, marker=marker, markerfacecolor="white", linestyle="none",
                markersize=8, label=f"{curve.method}: {word}",
            )  # fmt: skip
    own = getattr(source.reference.own, measure)
    if own > 0.0:
        axes.axhline(own, color=INK, linewidth=1.0, linestyle=(0, (1, 3)), label="the reference's own error")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(label)
    axes.set_ylabel(f"{MEASURES[measure]}" + ("" if measure == "flip" else " (linear)"))
    axes.grid(which="major", color=GRID)
    axes.spines[["top", "right"]].set_visible(False)
    axes.margins(0.14, 0.1)
    for reach, locator in ((axes.get_xlim(), axes.xaxis), (axes.get_ylim(), axes.yaxis)):
        few = reach[1] / reach[0] < FEW
        locator.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,), numticks=12))
        locator.set_major_formatter(LogFormatterSciNotation(labelOnlyBase=False))
        locator.set_minor_formatter(NullFormatter())
    return ends


def _say(axes: Any, ends: "Sequence[End]") -> None:
    """Write names beside their markers, in the colour of the curve, over no curve and no other name if possible, and
    never over the numbers of an axis or the edge of the plot.
    """
    inked = [(x - 4.0, y - 4.0, x + 4.0, y + 4.0) for x, y in _inked(axes)]
    names: list[Box] = []
    left, bottom, right, top = axes.bbox.x0, axes.bbox.y0, axes.figure.bbox.x1, axes.figure.bbox.y1
    said: list[tuple[str, float, float]] = []
    for label, ink, x, y in ends:
        at_x, at_y = axes.transData.transform((x, y))
        if any(label == name and math.dist((at_x, at_y), at) < SAME for name, *at in said):
            continue
        said.append((label, at_x, at_y))
        wide, high = 6.2 * len(label), 10.0

        def covers(place: tuple[bool, int], x: float = at_x, y: float = at_y, w: float = wide, h: float = high) -> Box:
            start = x + 7.0 if place[0] else x - 7.0 - w
            return (start, y + place[1], start + w, y + place[1] + h)

        def cost(place: tuple[bool, int], covers: Callable[[tuple[bool, int]], Box] = covers) -> tuple[bool, int, int]:
            box = covers(place)
            is_outside = box[0] < left or box[1] < bottom or box[2] > right or box[3] > top
            return is_outside, sum(_meet(box, name) for name in names), sum(_meet(box, ink) for ink in inked)

        best = min(PLACES, key=cost)
        names.append(covers(best))
        axes.annotate(
            label, (x, y), textcoords="offset points", xytext=(7 if best[0] else -7, best[1]),
            ha="left" if best[0] else "right", fontsize=9, color=ink,
        )  # fmt: skip


End = tuple[str, str, float, float]  # a marker's name, its colour, and its place
Box = tuple[float, float, float, float]  # left, bottom, right, top, in points
# offsets of a name, the best first
PLACES = tuple((right, up) for up in (5, -14, 17, -26, 30, -39, 43, -52) for right in (True, False))


def _meet(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def _inked(axes: Any) -> list[tuple[float, float]]:
    """Points on curves, bars and markers, a few points apart."""
    found: list[tuple[float, float]] = []
    chains = [axes.transData.transform(segment) for bars in axes.collections for segment in bars.get_segments()]
    for line in axes.lines:
        places = line.get_transform().transform(line.get_xydata())
        found += [tuple(place) for place in places]
        if line.get_linestyle() != "None":
            chains.append(places)
    for chain in chains:
        for (x0, y0), (x1, y1) in pairwise(chain):
            count = int(math.dist((x0, y0), (x1, y1)) / 6.0)
            found += [(x0 + k / count * (x1 - x0), y0 + k / count * (y1 - y0)) for k in range(1, count)]
    return found


def said_of(source: Source, measure: str) -> tuple[Callable[[Point], float], str]:
    """The program's own bound or estimate of a measure, and its name."""
    if measure == "largest" and source.bounded:
        return (lambda point: point.bound), "its bound"
    if measure == "rmse":
        return (lambda point: point.estimate), "as estimated"
    return (lambda point: math.nan), ""


def drawable(curve: Curve, measure: str) -> Sequence[Point]:
    """The points of a curve without errors of 0, which a logarithmic axis cannot show."""
    return [p for p in curve.points if 0.0 < error_of(p, measure) < math.inf]


def error_of(point: Point, measure: str) -> float:
    return float(getattr(point.errors, measure))


def name_of(curve: Curve) -> str:
    """The method's name with its measured slope and that of theory."""
    if curve.slope is None or curve.fitted is None:
        return curve.method
    return f"{curve.method}: N^{curve.fitted:.2f} (theory {curve.slope:g})"

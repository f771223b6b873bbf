"""The figures as bars: a panel for each part and unit, with the target as a line across each bar.

Counts of rays are no speed and appear in the table only.
"""

import importlib.util
import io
from collections.abc import Sequence

from benchmarks.results.figure import Figure
from benchmarks.results.report import short

MET, MISSED, PLAIN, LINE = "#3b78b5", "#c8651b", "#a3acb5", "#1d1d1f"
LABELS = {
    "povray": "Images against POV-Ray", "lessons": "Lessons against POV-Ray",
    "embree": "First hits against Embree", "growth": "Larger meshes", "click": "A click",
    "flat": "Boxes for a few surfaces", "start": "Starts", "window": "The window", "pick": "A pick in the window",
    "adaptive": "Samples where the error is, against everywhere",
}  # fmt: skip


def has_library() -> bool:
    return importlib.util.find_spec("matplotlib") is not None


def as_svg(figures: Sequence[Figure]) -> bytes:
    """An SVG, or None without figures or without matplotlib."""
    panels = grouped(figures)
    if not panels or not has_library():
        return b""
    import matplotlib as mpl  # pyright: ignore[reportMissingImports]
    from matplotlib.figure import Figure as Canvas  # pyright: ignore[reportMissingImports]

    heights = [len(rows) + 1.6 for rows in panels.values()]
    with mpl.rc_context(
        {"font.size": 11, "font.family": "sans-serif", "svg.hashsalt": "raytree", "axes.axisbelow": True}
    ):
        canvas = Canvas(figsize=(10.0, 0.42 * sum(heights) + 0.6), layout="constrained", facecolor="white")
        axes = canvas.subplots(len(panels), 1, squeeze=False, height_ratios=heights)[:, 0]
        for ax, ((part, unit), rows) in zip(axes, panels.items(), strict=True):
            draw(ax, rows)
            ax.set_title(f"{LABELS[part]}: {unit}", loc="left", fontsize=12, fontweight="bold")
        content = io.BytesIO()
        canvas.savefig(content, format="svg", metadata={"Date": None})
    return content.getvalue()


def grouped(figures: Sequence[Figure]) -> dict[tuple[str, str], list[Figure]]:
    """Figures by part and unit."""
    panels: dict[tuple[str, str], list[Figure]] = {}
    for figure in figures:
        if figure.part not in LABELS:
            continue
        unit = "ratio" if figure.ratio or figure.unit == "times as fast" else figure.unit
        panels.setdefault((figure.part, unit), []).append(figure)
    return panels


def draw(ax, rows: Sequence[Figure]) -> None:
    """Bars from the top down; whiskers from the lowest to the highest run."""
    longest = max(max(row.verdict.high, row.wanted or 0.0) for row in rows)
    for k, row in enumerate(rows):
        spread = row.verdict
        color = PLAIN if row.met is None else MET if row.met else MISSED
        ax.barh(k, spread.median, height=0.6, color=color)
        ax.plot([spread.low, spread.high], [k, k], color=LINE, linewidth=1.2, solid_capstyle="butt")
        end = max(spread.high, row.wanted or 0.0)
        label = short(spread.median)
        if row.wanted is not None:
            ax.plot([row.wanted] * 2, [k - 0.42, k + 0.42], color=LINE, linewidth=2.5, solid_capstyle="butt")
            label += f"   wanted {'≥' if row.at_least else '≤'} {row.wanted:g}"
        ax.text(end + 0.012 * longest, k, label, va="center", color=LINE)
    ax.set_yticks(range(len(rows)), [row.what for row in rows])
    ax.set_ylim(len(rows) - 0.45, -0.55)
    ax.set_xlim(0.0, 1.4 * longest)
    ax.grid(axis="x", color="#e3e6e9")
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(axis="y", length=0)

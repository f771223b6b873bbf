"""Error over time while the image converges, with a curve for each setting, and the choice of a map."""

import math
from collections.abc import Sequence

import numpy as np
from imgui_bundle import imgui, implot

from viewer.base.theme import SMALL, curve_color
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.panel import Panel
from viewer.session.actions import set_strategy, toggle_refinement
from viewer.session.refinement import DISPLAYS, STRATEGIES, Run, forecast
from viewer.session.session import Session
from viewer.session.view_state import Request

MAP_WIDTH = 116  # logical pixels
PLOT_HEIGHT = 96
FEW = 60.0  # an axis with a smaller ratio of its ends also has ticks at 2 and 5
LEGEND_FROM = 290  # of the panel's width
MARKERS = (
    implot.Marker_.circle, implot.Marker_.square, implot.Marker_.diamond, implot.Marker_.up, implot.Marker_.down,
    implot.Marker_.cross,
)  # fmt: skip


def draw(session: Session, canvas: Canvas) -> None:
    if not session.world:
        return
    _controls(session)
    _numbers(session)
    if any(run.points for run in session.refinement.runs):
        _plot(session)
    else:
        imgui.push_text_wrap_pos(0.0)
        samples = session.world.scene.image.samples
        now = "one ray per pixel, through its centre" if samples == 1 else f"{samples} rays per pixel"
        words = BEGUN if session.refinement.is_running else f"The image has {now}. {MORE}"
        imgui.text_colored(session.appearance.theme.muted, words)
        imgui.pop_text_wrap_pos()


BEGUN = "The first rays are being traced: each pixel gets one, then one more."
MORE = (
    "Refine it: pixels get more rays, twice as many each time, and the change of their mean gives an estimate of the "
    "error. Try another depth, or another way to place the rays: every curve is kept."
)


def _controls(session: Session) -> None:
    state, unit = session.refinement, d.unit()
    if imgui.button("Pause" if state.is_running else "Refine", (66 * unit, 0)):
        toggle_refinement(session)
    d.hint("more rays for each pixel, until it is paused (key R)")
    imgui.same_line()
    imgui.set_next_item_width(148 * unit)
    if imgui.begin_combo("##way", state.strategy.name):
        for strategy in STRATEGIES:
            if imgui.selectable(strategy.name, strategy == state.strategy)[0]:
                set_strategy(session, strategy)
            d.hint(strategy.hint)
        imgui.end_combo()
    d.hint("placement of the samples")
    imgui.same_line()
    if imgui.get_content_region_avail().x < MAP_WIDTH * unit:
        imgui.new_line()
    imgui.set_next_item_width(MAP_WIDTH * unit)
    if imgui.begin_combo("##map", DISPLAYS[state.shows]):
        for name, meaning in DISPLAYS.items():
            if imgui.selectable(meaning, name == state.shows)[0]:
                state.shows = name
        imgui.end_combo()
    d.hint("what the image panel shows")


def _numbers(session: Session) -> None:
    """The error so far, a forecast for one more second, and the error due to rays that were cut."""
    run, theme = session.refinement.current, session.appearance.theme
    if not run or not run.points:
        return
    last = run.points[-1]
    imgui.push_text_wrap_pos(0.0)
    imgui.text(f"error {last.error:.2g} after {last.seconds:.1f} s  ·  {_outlook(run)}")
    spread = f", {last.least} to {last.most}" if last.most > last.least else ""
    lines = [(f"{last.samples:.3g} samples a pixel{spread}{_picked(session, run)}", MEAN)]
    if math.isinf(run.floor):
        lines.append((f"* rays cut at depth {run.depth}: no upper bound is known for their light", FLOOR))
    elif run.floor > 0.0:
        lines.append((f"rays cut at depth {run.depth}: they add an error of at most {run.floor:.2g}", FLOOR))
    for content, meaning in lines:
        if imgui.get_content_region_avail().y > (PLOT_HEIGHT + 40) * d.unit():
            imgui.text_colored(theme.muted, content)
            d.hint(meaning)
    imgui.pop_text_wrap_pos()


def _picked(session: Session, run: Run) -> str:
    """The samples and the error of the picked pixel."""
    if not (session.pixel and run.image):
        return ""
    x, y = session.pixel
    count, error = run.image.statistics.counts[y, x], float(run.image.statistics.errors((y, x)))
    return "" if math.isnan(error) else f"; picked pixel: {count} samples, error {error:.2g}"


MEAN = "the mean over all pixels, the least and the most; the samples of the picked pixel, and its estimated error"
FLOOR = "a bound on the error due to rays that were cut; more samples do not reduce it"


def _outlook(run: Run) -> str:
    last, after = run.points[-1], forecast(run.points, 1.0)
    if run.ended:
        return "finished: no pixel gets more samples"
    if math.isnan(after):
        return "1 s more: too early to tell"
    return f"after 1 s more: error {100.0 * (1.0 - after / last.error):.2g} % lower"


def _plot(session: Session) -> None:
    unit, theme, state = d.unit(), session.appearance.theme, session.refinement
    size = SMALL * imgui.get_font_size()
    at = imgui.get_cursor_screen_pos()
    caption = d.shortened(
        "estimated sampling error (RMSE) over seconds", size, imgui.get_content_region_avail().x - 60 * unit
    )
    d.text(imgui.get_window_draw_list(), (at.x, at.y), theme.muted, caption, size)
    imgui.dummy((0.0, 1.2 * size))
    if len(state.runs) > 1:
        width = d.text_size("clear", imgui.get_font_size())[0] + 14 * unit
        imgui.same_line(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - width)
        if imgui.small_button("clear"):
            state.clear()
        d.hint("drop the curves of earlier settings")
    room = imgui.get_content_region_avail()
    room.y = max(room.y, PLOT_HEIGHT * unit)  # otherwise the panel would scroll
    flags, axis = implot.Flags_, implot.AxisFlags_
    implot.push_style_var(implot.StyleVar_.plot_padding, (4.0 * unit, 4.0 * unit))
    implot.push_style_color(implot.Col_.frame_bg, (0.0, 0.0, 0.0, 0.0))
    shown = flags.no_title | flags.no_menus | flags.no_mouse_text | flags.no_box_select
    if room.x < LEGEND_FROM * unit:
        shown |= flags.no_legend
    if implot.begin_plot("##convergence", room, shown):
        implot.setup_axes("", "", axis.no_label, axis.no_label)
        implot.setup_axis_scale(implot.ImAxis_.x1, implot.Scale_.log10)
        implot.setup_axis_scale(implot.ImAxis_.y1, implot.Scale_.log10)
        implot.setup_legend(implot.Location_.east, implot.LegendFlags_.outside)
        times = [p.seconds for run in state.runs for p in run.points]
        errors = [p.error for run in state.runs for p in run.points if p.error > 0.0]
        errors += [run.floor for run in state.runs if 0.0 < run.floor < math.inf]
        (left, right), (low, high) = _around(times), _around(errors)
        implot.setup_axes_limits(left, right, low, high, implot.Cond_.always)
        for which, (first, last) in ((implot.ImAxis_.x1, (left, right)), (implot.ImAxis_.y1, (low, high))):
            values = ticks(first, last)
            implot.setup_axis_ticks(which, values, [f"{value:g}" for value in values], False)
        for run in state.runs:
            _curve(session, run, (left, right))
        implot.end_plot()
    implot.pop_style_color()
    implot.pop_style_var()


def _around(values: Sequence[float]) -> tuple[float, float]:
    """The ends of a logarithmic axis, with room on either side of its values."""
    low, high = min(values, default=1.0), max(values, default=1.0)
    room = max((high / low) ** 0.06, 1.15)
    return low / room, high * room


def ticks(low: float, high: float) -> list[float]:
    """Ticks of a logarithmic axis: 1, 2, 5 in each decade, or only decades if there are many."""
    steps = (1.0, 2.0, 5.0) if high / low < FEW else (1.0,)
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    found = [step * 10.0**k for k in decades for step in steps]
    return [value for value in found if low <= value <= high]


def _curve(session: Session, run: Run, reach: tuple[float, float]) -> None:
    """A marker for each round, and a horizontal line at the error due to cut rays."""
    points = [p for p in run.points if p.error > 0.0]
    if not points:
        return
    state, unit = session.refinement, d.unit()
    color = imgui.ImVec4(*curve_color(session.appearance.theme, run.number))
    on = run is state.current
    name = run.name([other.model for other in state.runs])
    if 0.0 < run.floor < math.inf:
        faint = imgui.ImVec4(color.x, color.y, color.z, 0.55)
        flat = implot.Spec(line_color=faint, line_weight=1.2 * unit)
        implot.plot_line(f"##floor {name}", np.array(reach), np.full(2, run.floor), flat)
    spec = implot.Spec(
        line_color=color, line_weight=(2.6 if on else 1.5) * unit, marker=MARKERS[run.number % len(MARKERS)],
        marker_size=(4.0 if on else 3.0) * unit, marker_line_color=color, marker_fill_color=color,
    )  # fmt: skip
    implot.plot_line(name, np.array([p.seconds for p in points]), np.array([p.error for p in points]), spec)


PANEL = Panel("Error", draw, request=Request.SHOW_ERROR)

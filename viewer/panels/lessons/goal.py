"""The task of a step, below its text: each condition with a circle, or with a tick while the rays on show meet it. A
number that is not reached yet stands beside the one that is asked for.
"""

from collections.abc import Sequence

from imgui_bundle import imgui

from viewer.base.theme import Theme, faded
from viewer.figures.marks import Disc, Mark, Point, Shape, Stroke
from viewer.figures.writers.imgui import draw_marks
from viewer.lessons.expectation import Condition
from viewer.panels import draw as d

# In font sizes.
MARGIN = 0.45
INDENT = 1.75  # of the words
LINE = 1.28
BETWEEN = 0.25  # two conditions
RADIUS = 0.42  # of the circle
TICK = ((-0.2, 0.02), (-0.05, 0.18), (0.24, -0.2))  # its corners, from the circle's middle


def goal_height(conditions: Sequence[Condition], width: float) -> float:
    """The height of the box in pixels; 0 without conditions."""
    em = imgui.get_font_size()
    if not conditions:
        return 0.0
    return (2.0 * MARGIN + (len(conditions) - 1) * BETWEEN) * em + sum(_high(one, width) for one in conditions)


def draw_goal(theme: Theme, conditions: Sequence[Condition], at: d.Point, width: float) -> None:
    """Draw the box at a place on the screen."""
    if not conditions:
        return
    em, pad, (x, y) = imgui.get_font_size(), imgui.get_window_draw_list(), at
    end = (x + width, y + goal_height(conditions, width))
    all_hold = all(condition.holds for condition in conditions)
    pad.add_rect_filled(at, end, d.u32(faded(theme.accent if all_hold else theme.muted, 0.16)), 0.25 * em)
    y += MARGIN * em
    for condition in conditions:
        middle = (x + (MARGIN + RADIUS) * em, y + 0.5 * em)
        draw_marks(pad, _sign(theme, condition.holds, middle, em), (0.0, 0.0), 1.0)
        place = (round(x + INDENT * em), round(y))
        pad.add_text(imgui.get_font(), em, place, d.u32(theme.text), _text(condition), wrap_width=_room(width))
        y += _high(condition, width) + BETWEEN * em


def _text(condition: Condition) -> str:
    return f"{condition.words}   (now {condition.now})" if condition.now else condition.words


def _room(width: float) -> float:
    """The width of the words."""
    return max(1.0, width - (INDENT + MARGIN) * imgui.get_font_size())


def _high(condition: Condition, width: float) -> float:
    return imgui.calc_text_size(_text(condition), wrap_width=_room(width)).y


def _sign(theme: Theme, holds: bool, middle: Point, em: float) -> list[Mark]:
    """A circle, or a tick in a disc."""
    if not holds:
        return [Disc("circle", middle, RADIUS * em, None, Stroke(theme.muted, 0.09 * em))]
    corners = tuple((middle[0] + x * em, middle[1] + y * em) for x, y in TICK)
    return [
        Disc("circle", middle, RADIUS * em, theme.accent, None),
        Shape("tick", corners, None, Stroke(theme.on_accent, 0.13 * em), closed=False),
    ]

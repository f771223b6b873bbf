"""Positions of a tree's boxes on its part of the canvas: downwards from an eye at the top, or to the right from one at
the left.

Boxes and labels never overlap. Edges run through free space: from a box's sides down past its stubs, or from its
right side through the free column to the next level.
"""

from viewer.figures.layout.places import LayoutTask, Places
from viewer.figures.layout.sizes import (
    BARE_NOTE,
    BELOW,
    BOX,
    FOLD,
    LINE,
    MARGIN,
    NOTE,
    SLOT,
    STUB,
    Sizes,
    TreeStyle,
    bar_width,
)
from viewer.figures.layout.tidy_tree import Layout, Spacing, tidy_layout
from viewer.figures.marks import Point

# All in text sizes.
GAP = 0.7  # least distance between two boxes side by side
GAP_BELOW = 0.3  # least distance between two boxes one below the other, with all that hangs below them
SPREAD = 1.6  # largest factor of these distances if there is space
EYE = 0.75  # from the top to the eye
EYE_WIDE = 0.95  # from the left to the eye, and from the eye to the start of the first ray
FIRST_RIGHT = 3.4  # from the eye to the box of the first hit
CLEAR = 6.3  # least distance of levels if a leaf's note may hang beside a box of the next level
# Downwards, with stubs and without them, in a compact tree: from the eye to the first hit, least and largest distance
# of levels, and the share of it down to which edges stay outside the neighbours' boxes and stubs.
FIRST, COMPACT_FIRST = 4.8, 3.1
PITCH, COMPACT_PITCH = 4.85, 3.7
TALLEST, COMPACT_TALLEST = 8.0, 5.5
PASSES, COMPACT_PASSES = 0.9, 0.3
PASSES_FOLDS = 0.5 * FOLD / COMPACT_PITCH  # the same for a compact tree with the boxes of folds, which are higher
CORRIDOR, WIDEST = 2.4, 6.0  # least and largest distance between the boxes of two levels, sideways

EYES = ("top", "left")


def levels_down(style: TreeStyle, hung: bool) -> int:
    """The largest possible number of levels below the first. `hung`: with folds under the last."""
    return int(_room_below(style, hung) / (_pitch(style) * style.size))


def levels_right(sizes: Sizes, style: TreeStyle) -> int:
    return int(_room_right(sizes, style) / (sizes.column + CORRIDOR * style.size))


def _pitch(style: TreeStyle) -> float:
    return COMPACT_PITCH if style.compact else PITCH


def _first(style: TreeStyle) -> float:
    """The vertical position of the first hit."""
    return style.where[1] + (MARGIN + EYE + (COMPACT_FIRST if style.compact else FIRST)) * style.size


def _room_below(style: TreeStyle, hung: bool) -> float:
    """The room between the first hit and the lowest possible one."""
    hanging = (BARE_NOTE + LINE + BELOW) * hung if style.compact else STUB + NOTE + LINE * hung + 0.5
    return style.where[3] - _first(style) - (0.5 * BOX + hanging + MARGIN) * style.size


def place_downwards(task: LayoutTask, anyhow: bool) -> Places | None:
    """The positions; None if they do not fit."""
    rays, style, sizes = task.rays, task.style, task.sizes
    size, (left, top, right, _) = style.size, style.where
    left += style.aside
    margin, gap = MARGIN * size, GAP * size
    unit = sizes.column + gap
    stub = sizes.slot / unit
    first, free, levels = _first(style), _room_below(style, task.hung), task.levels
    crowded = CLEAR * size * levels > free and not style.compact
    passes = PASSES
    if style.compact:
        passes = PASSES_FOLDS if task.folds else COMPACT_PASSES
    room = Spacing(0.5, 0.5, stub, 0.5 * stub, sides=True, passes=passes, crowded=crowded, bars=not style.compact)
    laid = tidy_layout(rays, task.boxes if style.compact else {*task.rows, *task.folds}, room)
    rim = (left + margin - 0.5 * gap, right - margin + 0.5 * gap)
    across = _across(laid, (0.5, 0.5), unit, rim)
    if across is None or _pitch(style) * size * levels > free:
        if not anyhow:
            return None
        across = across or (0.5 * (left + right), 1.0)
    middle, spread = across
    tallest = COMPACT_TALLEST if style.compact else TALLEST
    pitch = min(tallest * size, free / levels) if levels else 0.0
    at = {
        i: (middle + place.x * unit * spread, first + pitch * rays.depths[i])
        for i, place in laid.places.items()
        if not rays.is_shadow[i]
    }

    def hanging(parent: int, x: float) -> Point:
        """A stub keeps its distance from its hit."""
        x0, y0 = at[parent]
        return (x0 + (x - laid.places[parent].x) * unit, y0 + 0.5 * sizes.box + STUB * size)

    at |= {i: hanging(rays.parents[i], place.x) for i, place in laid.places.items() if rays.is_shadow[i]}
    bars = {i: hanging(i, place.x) for i, place in laid.bars.items()}
    return Places(at, *_lines(task, at, bars), (at[0][0], top + margin + EYE * size))


def _lines(task: LayoutTask, at: dict[int, Point], bars: dict[int, Point]) -> tuple[dict[int, Point], dict[int, Point]]:
    """(ends of bars, middles of lines): a line hangs in the middle below its hit, with the bar on its right."""
    lines: dict[int, Point] = {}
    moved = dict(bars)
    for i, wide in task.sizes.lines.items():
        size = task.style.size
        x, y = at[i][0], at[i][1] + 0.5 * task.sizes.box + STUB * size
        bar = bar_width(size) if i in bars else 0.0
        lines[i] = (x - 0.5 * bar, y)
        if i in bars:
            moved[i] = (x + 0.5 * (wide + SLOT * size), y)
    return moved, lines


def _room_right(sizes: Sizes, style: TreeStyle) -> float:
    """The room between the first hit and the rightmost possible one."""
    left, _, right, _ = style.where
    return right - left - (2.0 * MARGIN + EYE_WIDE + FIRST_RIGHT) * style.size - sizes.column


def place_rightwards(task: LayoutTask, anyhow: bool) -> Places | None:
    """The positions; None if they do not fit. Reflected rays go up, refracted ones down."""
    rays, style, sizes = task.rays, task.style, task.sizes
    size, (left, top, _, bottom) = style.size, style.where
    margin = MARGIN * size
    unit = sizes.up + sizes.down + GAP_BELOW * size
    extent = ((sizes.up + 0.5 * GAP_BELOW * size) / unit, (sizes.down + 0.5 * GAP_BELOW * size) / unit)
    laid = tidy_layout(rays, task.boxes, Spacing(*extent, 0.0, 0.0))
    rim = (top + margin - 0.5 * GAP_BELOW * size, bottom - margin + 0.5 * GAP_BELOW * size)
    across = _across(laid, extent, unit, rim)
    free, levels = _room_right(sizes, style), task.levels
    if across is None or (sizes.column + CORRIDOR * size) * levels > free:
        if not anyhow:
            return None
        across = across or (0.5 * (top + bottom), 1.0)
    middle, spread = across
    pitch = min(sizes.column + WIDEST * size, free / levels) if levels else 0.0
    eye = left + margin + EYE_WIDE * size
    first = eye + FIRST_RIGHT * size + 0.5 * sizes.column
    at = {i: (first + pitch * rays.depths[i], middle + place.x * unit * spread) for i, place in laid.places.items()}
    bars: dict[int, Point] = {}
    for i in sorted(task.boxes.difference(task.folds)):
        stubs = [] if style.compact else [c for c in rays.shadow_rays.get(i, ()) if c in task.rows]
        barred = not style.compact and any(c in task.rows and rays.is_tir[c] for c in rays.rays.get(i, ()))
        (x, y), count = at[i], len(stubs) + barred
        ends = [(x + sizes.slot * (k - 0.5 * (count - 1)), y + 0.5 * sizes.box + STUB * size) for k in range(count)]
        if barred:
            bars[i] = ends.pop()
        at |= dict(zip(stubs, ends, strict=True))
    return Places(at, *_lines(task, at, bars), (eye, at[0][1]))


def _across(
    laid: Layout, extent: tuple[float, float], unit: float, rim: tuple[float, float]
) -> tuple[float, float] | None:
    """(position of the first hit, factor of all distances) between two ends; None if there is no room.

    The first hit stands in the middle if the tree allows it.
    """
    low = min(place.x for place in laid.places.values()) - extent[0]
    high = max(place.x for place in laid.places.values()) + extent[1]
    widest = (rim[1] - rim[0]) / (high - low)
    if unit > widest:
        return None
    spread = min(widest, SPREAD * unit) / unit
    middle = min(max(0.5 * (rim[0] + rim[1]), rim[0] - low * unit * spread), rim[1] - high * unit * spread)
    return middle, spread

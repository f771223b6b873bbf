"""The sample points of a pixel, for anti-aliasing: the first points of the Sobol sequence that images use.

Of the first 4, 16, 64 ... points, each cell of a grid of 2 x 2, 4 x 4, 8 x 8 ... holds exactly one. With a pixel of a
scene, each point has the colour that its ray sees, and the pixel their mean.
"""

import math

import numpy as np

from tracer.formulas.sampler import PIXEL_CENTER, make_samples, sample_offset
from tracer.tree.trace import trace
from viewer.base.srgb import LUMINANCE, display_color
from viewer.base.theme import Color, faded
from viewer.figures.layout.hit_frame import MARGIN
from viewer.figures.marks import Disc, Line, Mark, Shape, Stroke, widened
from viewer.lessons.live.labels import Labels
from viewer.lessons.live.page import with_caption
from viewer.lessons.live.piece import LiveContext, Parameters

SAMPLE = "sample"  # what a click sets: the sample of the pixel whose rays are on show
DEFAULT, MOST = 16, 1024
NUMBERED = 64  # points that have a number beside them and a colour at most
MIDDLE = 0.5  # encoded luminance of a ground, from which on dark letters are read better than light ones
BLACK, WHITE = (0.0, 0.0, 0.0, 1.0), (1.0, 1.0, 1.0, 1.0)


def samples(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The first `count` sample points in the pixel of the tree, else in pixel (0, 0), as an image of so many samples
    has them; by default as many as those of the scene. The one whose tree is shown has a ring. ValueError for a count
    that is no whole number from 1 to 1024.
    """
    own = context.world.scene.image.samples if context.world else 1
    count = parameters.get("count", DEFAULT if own == 1 else min(own, MOST))
    if not (count == int(count) and 1 <= count <= MOST):
        raise ValueError(f"samples: count must be a whole number from 1 to {MOST}, got {count:g}")
    x, y = (context.tree.pixel or (0, 0)) if context.tree else (0, 0)
    points = sample_points(x, y, int(count))
    side = math.isqrt(len(points))
    is_grid = side * side == len(points) and side & (side - 1) == 0 and side > 1
    cells = f"{len(points)} points in a pixel" + (f": one in each cell of {side} × {side}" if is_grid else "")
    size, theme = context.size, context.theme
    captions = [cells, f"{len(points)} points in a pixel", f"{len(points)} points"]
    (left, top, right, bottom), marks = with_caption(context, widened(context.where, -MARGIN * size), captions)
    seen = _seen(context, len(points))
    largest = (0.45 if seen else 0.28) * size  # a colour is seen on a larger dot
    radius = max(1.2, min(largest, 0.13 * min(right - left, bottom - top) / math.sqrt(len(points))))
    extent = min(right - left, bottom - top) - 2.0 * radius - 2.0
    left, top = 0.5 * (left + right - extent), 0.5 * (top + bottom - extent)
    corners = ((left, top), (left + extent, top), (left + extent, top + extent), (left, top + extent))
    mean = display_color(np.mean(seen, axis=0)) if seen else None
    ink = theme.text if mean is None else _letters_on(mean)
    fill, title = (faded(theme.glass, 0.12), "the pixel") if mean is None else (mean, "the pixel: the mean")
    marks.append(Shape("pixel", corners, fill, Stroke(theme.text, 2.0), title=title))
    for k in range(1, side if is_grid else 1):
        at = extent * k / side
        for start, end in (
            ((left + at, top), (left + at, top + extent)),
            ((left, top + at), (left + extent, top + at)),
        ):
            marks.append(
                Line("cells", start, end, Stroke(theme.muted if mean is None else faded(ink, 0.5), 0.8, (2.0, 3.0)))
            )
    edge = Stroke(ink, 1.4) if seen else None
    colors = list(map(display_color, seen)) or [theme.accent] * len(points)
    dots = [
        Disc(f"sample-{k}", (left + u * extent, top + v * extent), radius, color, edge, title=f"{u:.4f}, {v:.4f}")
        for k, ((u, v), color) in enumerate(zip(points, colors, strict=True))
    ]
    chosen = context.tree.sample if context.tree and own > 1 else None
    if chosen is not None and chosen < len(dots):
        ring = Disc("chosen", dots[chosen].center, 1.7 * radius, None, Stroke(theme.text, 2.0))
        marks.append(ring)
    labels = Labels((left, top, left + extent, top + extent), size, theme, dots)
    for k, dot in enumerate(dots if len(points) <= NUMBERED and extent / side >= 3.0 * size else []):
        (cx, cy), away = dot.center, radius + 0.25 * size
        labels.place(dot.name, [str(k)], [((cx + away, cy), "start"), ((cx - away, cy), "end")], ink)
    return [*marks, *dots, *labels.marks]


def clicked(name: str) -> dict[str, float]:
    """A click on a point chooses that sample."""
    kind, _, number = name.partition("-")
    return {SAMPLE: float(number)} if kind == "sample" and number.isdecimal() else {}


def sample_points(x: int, y: int, count: int) -> list[tuple[float, float]]:
    """The sample points of a pixel, from its top left corner, in [0, 1)."""
    chosen = make_samples(count)
    if chosen == PIXEL_CENTER:
        return [(0.5, 0.5)]
    with np.errstate(over="ignore"):  # the integers of the scramble wrap around
        return [sample_offset(x, y, k, chosen.sampler) for k in range(count)]


def _seen(context: LiveContext, count: int) -> list[np.ndarray]:
    """The colour of each sample, linear RGB; none without a pixel, and none of many samples."""
    tree, world = context.tree, context.world
    if tree is None or world is None or tree.pixel is None or count > NUMBERED:
        return []
    how = {"depth": tree.depth, "size": tree.size, "model": tree.model, "samples": count}
    numbers = range(count) if count > 1 else (None,)  # one is the pixel's centre
    return [trace(world, tree.pixel, sample=k, **how).radiance for k in numbers]


def _letters_on(ground: Color) -> Color:
    """Black or white, for letters on this colour."""
    return BLACK if float(np.asarray(ground[:3]) @ LUMINANCE) > MIDDLE else WHITE

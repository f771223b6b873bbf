"""The difference between two images of the scene: at depth d, and at depth d - 1. It is the light that level d adds.

A tree of depth d begins with the rows of that of depth d - 1, so that a pixel without rays at level d has the same
bits in both, and counts as unchanged.
"""

from dataclasses import dataclass

import numpy as np

import tracer
from tracer.image.task import Cancelled, never
from tracer.kernel.world import World
from viewer.base.srgb import srgb
from viewer.base.wording import format_number
from viewer.figures.font import text_width
from viewer.figures.layout.hit_frame import MARGIN
from viewer.figures.marks import Box, Handle, Line, Mark, Raster, Rectangle, Stroke, Text, widened
from viewer.lessons.live.piece import LiveContext, Parameters

ROOM = (320, 240)  # pixels: an image fills it in one direction
DEEPEST = (6, 12)  # the range of the handle ends between these, at the depth of the scene
TIMES = (1, 2, 5)  # and by powers of ten: a faint difference is shown so many times as bright

# In text sizes.
HEAD, AXIS, LINE = 1.6, 2.7, 1.35  # heights of the title, of the axis with its handle, of a line of numbers
LEAST = 5.0  # height of a picture beside longer texts


@dataclass(frozen=True)
class Difference:
    """What level `depth` adds to an image, in linear light."""

    depth: int
    pixels: np.ndarray  # (height, width, 3)

    @property
    def largest(self) -> float:
        return float(np.abs(self.pixels).max())

    @property
    def mean(self) -> float:
        """Of the absolute values, over all pixels and channels."""
        return float(np.abs(self.pixels).mean())

    @property
    def changed(self) -> float:
        """The share of pixels that change."""
        return float((self.pixels != 0.0).any(axis=2).mean())

    @property
    def times(self) -> int:
        """The largest round number by which the difference can be multiplied without clipping; 1 if it adds nothing."""
        rounds = [m * 10**k for k in range(6) for m in TIMES]
        return max((n for n in rounds if n * self.largest <= 1.0), default=1) if self.largest > 0.0 else 1


def small_image(world: World, depth: int, model: str | None = None, cancelled: Cancelled = never) -> np.ndarray:
    """The image of a scene, pixel centres only, (height, width, 3) of linear light, small enough to be traced at once.
    Raises Stopped if `cancelled` returns true.
    """
    whole = world.scene.image
    share = min(1.0, ROOM[0] / whole.width, ROOM[1] / whole.height)
    size = (max(1, round(share * whole.width)), max(1, round(share * whole.height)))
    return tracer.render(world, size, samples=1, depth=depth, threads=1, model=model, cancelled=cancelled).pixels


def difference(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The picture and its numbers; the handle is the depth `d`. ValueError without a scene, and for a `d` that is no
    depth within the range.
    """
    world = context.world
    if world is None:
        raise ValueError("difference: no scene is on show")
    deepest = min(max(world.scene.tracing.depth, DEEPEST[0]), DEEPEST[1])
    usual = min(context.tree.depth if context.tree else world.scene.tracing.depth, deepest)
    d = round(parameters.get("d", usual))
    if not 0 <= d <= deepest:
        raise ValueError(f"difference: d must be from 0 to {deepest}, got {d}")
    model = context.tree.model if context.tree else None
    images = context.images or (lambda depth: small_image(world, depth, model))
    images_of = [images(depth) for depth in (d, d - 1) if depth >= 0]
    found = None
    if all(image is not None for image in images_of):
        pixels = [np.asarray(image) for image in images_of]
        found = Difference(d, pixels[0] - pixels[1] if d else pixels[0])
    return _Page(context, d, deepest, found).marks


class _Page:
    def __init__(self, context: LiveContext, d: int, deepest: int, found: Difference | None) -> None:
        self.size, self.theme = context.size, context.theme
        self.room = widened(context.where, -MARGIN * context.size)
        self.marks: list[Mark] = []
        left, top, right, bottom = self.room
        numbers = self._numbers(found)
        for k, line in enumerate(numbers):
            y = bottom - (len(numbers) - k - 0.5) * LINE * self.size
            self._text("numbers", (0.5 * (left + right), y), line)
        bottom -= len(numbers) * LINE * self.size
        self._axis(d, deepest, bottom - AXIS * self.size)
        head = f"depth {d} − depth {d - 1}" if d else "depth 0"
        if found and found.times > 1:
            longer = [f"{head}, shown {found.times} times as bright", f"{head}, × {found.times}"]
            head = next((words for words in longer if text_width(words, self.size) <= right - left), head)
        self._text("head", (0.5 * (left + right), top + 0.5 * self.size), head)
        self._picture((left, top + HEAD * self.size, right, bottom - AXIS * self.size), found)

    def _text(self, name: str, at: tuple[float, float], content: str) -> None:
        self.marks.append(Text(name, at, content, self.size, self.theme.text))

    def _numbers(self, found: Difference | None) -> list[str]:
        """The numbers in one line, in two, or the shortest."""
        if found is None:
            return ["…"]
        if found.largest == 0.0:
            return ["nothing is added"]
        largest, mean = (format_number(value, 3) for value in (found.largest, found.mean))
        share = f"{100.0 * found.changed:.1f} %"
        left, top, right, bottom = self.room
        for lines in (
            [f"largest {largest}, mean {mean}; {share} of the pixels change"],
            [f"mean {mean}; {share} of the pixels change"],
            [f"largest {largest}, mean {mean}", f"{share} of the pixels change"],
        ):
            above = bottom - top - (HEAD + AXIS + len(lines) * LINE) * self.size
            if above >= LEAST * self.size and max(text_width(line, self.size) for line in lines) <= right - left:
                return lines
        return [f"mean {mean}, in {share}"]

    def _picture(self, room: Rectangle, found: Difference | None) -> None:
        left, top, right, bottom = room
        center = (0.5 * (left + right), 0.5 * (top + bottom))
        if found is None:
            self._text("picture", center, "is being traced …")
            return
        height, width = found.pixels.shape[:2]
        scale = min((right - left) / width, (bottom - top) / height)
        size = (scale * width, scale * height)
        pixels = srgb(found.times * np.abs(found.pixels))
        title = f"the light that level {found.depth} of the recursion adds"
        self.marks.append(Raster("picture", center, size, (width, height), pixels.tobytes(), title=title))
        self.marks.append(Box("frame", center, size, 0.0, None, Stroke(self.theme.border, 1.0)))

    def _axis(self, d: int, deepest: int, top: float) -> None:
        """The depths as ticks, with the handle above."""
        size, theme = self.size, self.theme
        left, _, right, _ = self.room
        y, words = top + 0.8 * size, "depth d"
        self.marks.append(Text("axis", (left, y), words, size, theme.muted, "start"))
        left, right = left + text_width(words, size) + 1.2 * size, right - 0.8 * size
        self.marks.append(Line("axis", (left, y), (right, y), Stroke(theme.text, 1.4)))
        for k in range(deepest + 1):
            x = left + (right - left) * k / deepest
            self.marks.append(Line("axis", (x, y), (x, y + 0.3 * size), Stroke(theme.text, 1.4)))
            ink = theme.accent if k == d else theme.muted
            self.marks.append(Text("axis", (x, y + 1.2 * size), str(k), size, ink))
        path = ((left, y), (right, y))
        self.marks.append(Handle("d", d, (0, deepest), path, theme.accent, title="drag to change the depth"))

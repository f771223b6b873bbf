"""The colour of a hit as a sum: its local light and each child's colour times its factor, arriving as colours and bars.

The bars are the red, green and blue of the sum, stacked in the order of the sum: they end where the radiance of the
table is, to the last bit.
"""

from dataclasses import dataclass

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.srgb import display_color
from viewer.base.theme import Color
from viewer.explain.sums import Term, sum_terms
from viewer.figures.font import text_width
from viewer.figures.layout.hit_frame import MARGIN
from viewer.figures.marks import Box, Line, Mark, Stroke, Text, widened
from viewer.lessons.live.piece import LiveContext, Parameters
from viewer.lessons.live.plot import Stacked, stacked_bars

ROW = 1.75  # height of a row, in text sizes
SWATCH = 1.15  # size of a swatch, in text sizes
GAP = 0.7  # between columns, in text sizes
LEAST_BARS = 3 * 1.05  # height of the bars, in text sizes


@dataclass(frozen=True)
class Part:
    """A term of the sum: `brought` is the child's radiance, or the local light; `value` is what arrives."""

    row: int | None  # of the child; None: local light
    brought: np.ndarray
    value: np.ndarray


def parts(tree: RayTree, i: int) -> list[Part]:
    """The terms of the sum of hit i. Added up in this order, they are its radiance to the last bit."""
    local = tree.nodes["local"][i]
    found = [Part(None, local, local)]
    for child in tree.children[i]:
        if tree.nodes["kind"][child] != SHADOW:
            radiance = tree.nodes["radiance"][child]
            found.append(Part(int(child), radiance, tree.nodes["factor"][child] * radiance))
    return found


def sum_piece(context: LiveContext, _: Parameters) -> list[Mark]:
    """The sum of the hit looked at. ValueError where the ray meets nothing."""
    tree, _world, _name = context.hit("sum")
    return _Sum(tree, context.row, context).marks


class _Sum:
    def __init__(self, tree: RayTree, row: int, context: LiveContext) -> None:
        self.tree, self.row, self.size, self.theme = tree, row, context.size, context.theme
        self.left, self.top, self.right, self.bottom = widened(context.where, -MARGIN * context.size)
        self.parts = parts(tree, row)
        self.total = tree.nodes["radiance"][row]
        self.marks: list[Mark] = []
        self._bars(self._terms() + 0.6 * self.size)

    def _color(self, row: int | None) -> Color:
        return self.theme.text if row is None else self.theme.ray(self.tree.kind(row))

    def _terms(self) -> float:
        """A row for each term. Returns their bottom."""
        size, wide = self.size, self.right - self.left
        most = int((self.bottom - self.top - (LEAST_BARS + 0.6) * size) / (ROW * size))
        for luminance in (False, True):
            terms = sum_terms(self.tree, self.row, luminance)
            names, values = (max(text_width(text, size) for text in texts) for texts in zip(
                *((term.name, term.value) for term in terms), strict=True))  # fmt: skip
            if names + values + (2.0 * SWATCH + 3.0 * GAP) * size <= wide:
                break
        columns = (self.left + (SWATCH + GAP) * size, self.left + (SWATCH + 2.0 * GAP) * size + names + values)
        shown = terms if len(terms) <= most else [*terms[: max(0, most - 1)], terms[-1]]
        for k, term in enumerate(shown):
            y = self.top + (k + 0.5) * ROW * size
            is_total = term is terms[-1]
            part = None if is_total else self.parts[k]
            self._term(term, part, y, columns, luminance)
            if is_total and k:
                line = y - 0.5 * ROW * size
                end = columns[1] + (GAP + SWATCH) * size
                self.marks.append(Line("sum", (self.left, line), (end, line), Stroke(self.theme.text, 1.4)))
        return self.top + len(shown) * ROW * size

    def _term(self, term: Term, part: Part | None, y: float, columns: tuple[float, float], luminance: bool) -> None:
        size, theme = self.size, self.theme
        name = "sum" if part is None else "local" if part.row is None else f"ray-{part.row}"
        ink = self._color(None if part is None else part.row)
        self.marks.append(Text(name, (columns[0], y), term.name, size, ink, "start"))
        self.marks.append(Text(name, (columns[1], y), term.value, size, theme.text, "end"))
        brought = self.total if part is None else part.brought
        self._swatch(name, self.left + 0.5 * SWATCH * size, y, brought, "its colour")
        if part is not None and part.row is not None:
            self._swatch(name, columns[1] + (GAP + 0.5 * SWATCH) * size, y, part.value, "times its factor")

    def _swatch(self, name: str, x: float, y: float, color: np.ndarray, title: str) -> None:
        side = SWATCH * self.size
        edge = Stroke(self.theme.border, 1.0)
        self.marks.append(Box(name, (x, y), (side, side), 3.0, display_color(color), edge, title=title))

    def _bars(self, top: float) -> None:
        """One bar for each channel, of the terms one after the other."""
        size, theme = self.size, self.theme
        pitch = min(2.0 * size, (self.bottom - top) / 3.0)
        stacked = [
            Stacked(
                "local" if part.row is None else f"ray-{part.row}", part.value, self._ink(part.row), self._title(part)
            )
            for part in self.parts
        ]
        self.marks += stacked_bars(stacked, (self.left, top, self.right, top + 3.0 * pitch), size, theme)
        y = top + 3.0 * pitch + 0.8 * size
        if y + 0.6 * size > self.bottom:
            return
        words = ["local, then each ray × its factor, add up to the colour", "the terms add up to the colour", "the sum"]
        words = (
            words if len(self.parts) > 1 else ["no ray is sent on: the colour is the local light", "only local light"]
        )
        said = next((line for line in words if text_width(line, size) <= self.right - self.left), "")
        self.marks.append(Text("bars", (self.left, y), said, size, theme.muted, "start"))

    def _title(self, part: Part) -> str:
        return "local light" if part.row is None else f"{self.tree.label(part.row)} times its factor"

    def _ink(self, row: int | None) -> Color:
        return self.theme.muted if row is None else self._color(row)

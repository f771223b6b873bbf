"""The texts in the corners of the figure of a hit: the rays with their labels and angles, where they come from and go
to.
"""

from collections.abc import Sequence

from tracer.tree.raytree import RayTree
from viewer.base.theme import Theme
from viewer.base.wording import format_angle
from viewer.explain.scattering import direction_error
from viewer.figures.font import text_width
from viewer.figures.labels import end_label, factor_label, ray_label
from viewer.figures.layout.formula_column import LINE
from viewer.figures.layout.hit_frame import HitFrame
from viewer.figures.marks import Point, Text

LOW = 17.0  # height of a picture, in text sizes, below which lines are saved
TURNED = "turned by hand"


class HitCorners:
    """`going_on` are the rows of the rays that the hit sends out, apart from shadow rays. Rays of a hit that is turned
    by hand have no labels: they are none of the pixel's tree.
    """

    def __init__(
        self,
        tree: RayTree,
        node: int,
        going_on: Sequence[int],
        frame: HitFrame,
        size: float,
        theme: Theme,
        is_turned: bool,
    ) -> None:
        self.tree, self.frame, self.size, self.theme, self.is_turned = tree, frame, size, theme, is_turned
        left, top, right, bottom = frame.picture
        self.left, self.right = left + 0.5 * size, right - 0.5 * size  # of texts
        self.first, self.last = top + 0.9 * size, bottom - 0.9 * size  # the first and the last line of text
        self.marks: list[Text] = []
        turn = direction_error(tree, node)
        theta1, theta2 = (format_angle(float(tree.nodes[name][node]), turn) for name in ("theta1", "theta2"))
        words = self._words(f"v: {TURNED if is_turned else ray_label(tree, node)}", f"θ₁ = {theta1}")
        self.third = self._write(node, words, (self.left, self.first), "start")  # the line below these
        end = end_label(tree, node)
        if end and not going_on:
            at = (self.right, self.first)
            self.marks.append(Text(f"ray-{node}", at, end, size, theme.muted, "end"))
        for child in going_on:
            refracted = tree.kind(child) == "refraction"
            label = self._label(child, "t" if refracted else "r")
            words = self._words(label, f"θ₂ = {theta2}" if refracted else f"θ₁ = {theta1}")
            y = self.last - (len(words) - 1) * LINE * size if refracted else self.first
            self._write(child, words, (self.right, y), "end")

    def _label(self, child: int, letter: str) -> str:
        """The label of a ray, with its factor if there is room on its side of the normal."""
        label = letter if self.is_turned else f"{letter}: {ray_label(self.tree, child)}"
        full = f"{label} {factor_label(self.tree, child)}"
        return full if self._fits_aside(full) else label

    def _fits_aside(self, content: str) -> bool:
        return text_width(content, self.size) <= self.right - self.frame.center[0] - self.size

    def _words(self, label: str, angle: str) -> list[str]:
        """The lines of a corner: in a low picture one, if there is room on this side of the normal."""
        _, top, _, bottom = self.frame.picture
        one = f"{label}   {angle}"
        if not self._fits_aside(angle):
            return [label]
        return [one] if bottom - top < LOW * self.size and self._fits_aside(one) else [label, angle]

    def _write(self, row: int, lines: Sequence[str], at: Point, anchor: str) -> float:
        """Write lines in the colour of a ray. Returns the place of the next line."""
        (x, y), color = at, self.theme.ray(self.tree.kind(row))
        for words in lines:
            self.marks.append(Text(f"ray-{row}", (x, y), words, self.size, color, anchor))
            y += LINE * self.size
        return y

"""The subject of a figure, and the style it is drawn in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tracer.kernel.world import World
from viewer.base.orbit import Orbit
from viewer.base.theme import LIGHT, Theme
from viewer.figures.export_options import TEXT_SIZE
from viewer.figures.marks import HEIGHT, WIDTH, Mark, Rectangle
from viewer.figures.steps import Step

if TYPE_CHECKING:
    from viewer.figures.visible.scene_view import SceneView

Pages = list[list[Mark]]

THINNEST, THICKEST = 0.45, 1.6  # factors of the line width


def line_share(text_size: float) -> float:
    """The factor of line widths, which follow the text size."""
    return min(THICKEST, max(THINNEST, text_size / TEXT_SIZE))


@dataclass(frozen=True)
class FigureStyle:
    """The style of a figure."""

    theme: Theme = LIGHT
    text_size: float = TEXT_SIZE
    swatches: bool = False  # each box shows the radiance of its ray
    fold: float = 0.0  # branches with a smaller weight are folded
    ground: bool = False  # on the theme's background; otherwise transparent
    node: int = 0  # the row of the hit that the figure is about, if it is about one
    is_turned: bool = False  # whether that hit is one of a ray that was turned by hand
    eye: str = "top"  # of a tree: or "left"
    selected: int | None = None  # the row of a ray to emphasise; rays that are neither above nor below it are dimmed
    levels: bool = False  # a tree from the top: the depths, with their numbers
    legend: bool = True  # of a tree
    page: tuple[float, float] = (WIDTH, HEIGHT)  # width and height of the canvas, in points

    @property
    def canvas(self) -> Rectangle:
        return (0.0, 0.0, *self.page)


@dataclass(frozen=True)
class Subject:
    """The steps of one tree, the fullest last. Figures of the scene also need the world and the orbit."""

    steps: Sequence[Step]
    world: World | None = None
    orbit: Orbit | None = None  # from which the scene is seen

    def view(self, where: Rectangle) -> SceneView:
        """The scene as seen in a rectangle of the canvas."""
        from viewer.figures.visible.scene_view import SceneView

        if self.world is None or self.orbit is None:
            raise ValueError("a figure of the scene needs a world and an orbit")
        return SceneView(self.world, self.orbit.framed((where[2] - where[0]) / (where[3] - where[1])), where)

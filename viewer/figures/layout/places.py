"""The parts of a tree figure that are to be placed, and their places."""

from collections.abc import Collection
from dataclasses import dataclass

from viewer.figures.layout.planned_rays import PlannedRays
from viewer.figures.layout.sizes import Sizes, TreeStyle
from viewer.figures.marks import Point


@dataclass(frozen=True)
class Places:
    """Centres of boxes and of signs at ends of stubs, ends of the bars of total internal reflection, middles of the
    lines that stand for shadow rays, the eye.
    """

    at: dict[int, Point]
    bars: dict[int, Point]
    lines: dict[int, Point]
    eye: Point


@dataclass(frozen=True)
class LayoutTask:
    """The rows and the boxes of folds to place, in a style."""

    rays: PlannedRays
    rows: Collection[int]
    folds: Collection[int]
    sizes: Sizes
    style: TreeStyle
    hung: bool  # whether folds hang under the last level

    @property
    def levels(self) -> int:
        """The number of levels below the first."""
        return max(self.rays.depths[i] for i in (*self.rows, *self.folds))

    @property
    def boxes(self) -> set[int]:
        """The rows of hits and folds."""
        return {i for i in self.rows if not self.rays.is_shadow[i]}.union(self.folds)

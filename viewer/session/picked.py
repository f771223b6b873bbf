"""The picked place in the image, the tree of rays behind it, and the selected ray."""

from dataclasses import dataclass, field

from tracer.formulas.vector import Vector
from tracer.tree.raytree import RayTree
from viewer.base.cached import Cached
from viewer.lessons.image_place import ray_between
from viewer.session.scene_on_show import OnShow
from viewer.session.stepping.sample import SampleChoice
from viewer.session.stepping.trees import trace_place


@dataclass(eq=False)
class Picked(OnShow):
    """A pixel of the scene on show, or a place between pixels, and its tree."""

    pixel: tuple[int, int] | None = None
    between: tuple[float, float] | None = None  # the place whose tree is shown, if it is no pixel's; `pixel` is near it
    sample: SampleChoice = field(default_factory=SampleChoice)
    tree: RayTree | None = None  # of the picked pixel, or of its chosen sample
    full_tree: RayTree | None = None  # the same, perhaps deeper; `tree` is its first rows
    selection: str | None = None  # the path of the selected ray, if the tree has it
    _selected: Cached[int | None] = field(default_factory=Cached[int | None])

    @property
    def selected(self) -> int | None:
        """The row of the selected ray; None if no ray is selected, or if the tree does not have it."""
        tree, path = self.tree, self.selection
        return self._selected.get((tree, path), lambda: tree.find(path) if tree and path else None)

    @property
    def ray(self) -> tuple[Vector, Vector] | None:
        """(origin, direction) of the ray from the eye, if the picked place is between pixels."""
        return ray_between(self.world, self.between) if self.world and self.between else None

    def put(self, pixel: tuple[int, int] | None, between: tuple[float, float] | None = None) -> None:
        """Pick another place. Its tree is traced before the next frame."""
        self.pixel, self.between = pixel, between
        self.tree = self.full_tree = None

    def inside(self, x: int, y: int) -> tuple[int, int]:
        """The nearest pixel of the image."""
        width, height = self.size
        return (min(max(x, 0), width - 1), min(max(y, 0), height - 1))

    def trace(self) -> None:
        """Trace the tree of the picked place."""
        assert self.world and self.pixel
        sample, most = self.sample.number(self.world.scene), self.limits.max_nodes
        how = (sample, self.depth, self.model, most)
        self.tree, self.full_tree = trace_place(self.world, self.pixel, self.ray, *how)

"""The form of a live piece: a function from a context and parameters to marks.

A `Handle` among the marks has the name of the parameter that it changes. When it is dragged, the piece is called again
with the new value. A context that cannot serve a piece is a ValueError with one line for the reader.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.theme import Theme
from viewer.figures.labels import hit_label
from viewer.figures.marks import Mark, Rectangle

Images = Callable[[int], np.ndarray | None]  # (height, width, 3) linear light by depth; None: not there yet
OBJECT = "object"  # the parameter of pieces about a ray and an object: the object's number


@dataclass(frozen=True)
class LiveContext:
    """The state that a piece shows, and its room, in points."""

    tree: RayTree | None  # of the step's pixel; None: no pixel
    row: int  # of the hit looked at, 0 if none
    world: World | None
    theme: Theme
    size: float  # of text, in points
    where: Rectangle
    images: Images | None = None  # small images of the scene, where they are traced ahead; None: a piece traces its own

    def hit(self, piece: str) -> tuple[RayTree, World, str]:
        """The tree, the world and the name of the object that the ray meets. ValueError where it meets none."""
        if self.tree is None or self.world is None:
            raise ValueError(f"{piece}: no pixel is picked; it needs a ray that meets a surface")
        if self.tree.nodes["object"][self.row] < 0:
            raise ValueError(f"{piece}: {self.tree.label(self.row)} meets nothing; it needs a ray that meets a surface")
        return self.tree, self.world, hit_label(self.tree, self.row)

    def tested(self, piece: str, parameters: "Parameters") -> tuple[RayTree, str, int | None]:
        """The tree, and the name and number of the object that the ray is tested against: of the parameter `object`,
        which the ray may miss; or the name of the one that it meets, and None. ValueError where there is none.
        """
        if OBJECT not in parameters:
            tree, _, name = self.hit(piece)
            return tree, name, None
        if self.tree is None:
            raise ValueError(f"{piece}: no pixel is picked; it needs a ray")
        number = int(parameters[OBJECT])
        return self.tree, self.tree.scene.object_name(number), number


Parameters = Mapping[str, float]  # by the name of a handle; one that is not there has the piece's default
Piece = Callable[[LiveContext, Parameters], list[Mark]]

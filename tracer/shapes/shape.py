"""The base class of all shapes: their properties, with defaults. `sphere.py` is the model to follow."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar, Self

import numpy as np

from tracer.formulas.exact import Exact
from tracer.formulas.vector import Vector


class Shape(ABC):
    """A shape as an author writes it: a frozen dataclass whose fields carry their rules (`tracer.fields`)."""

    __slots__ = ()

    name: ClassVar[str]  # in scene files
    curved: ClassVar[bool] = True  # whether equal shapes count as coincident; flat faces are compared by their planes
    checker_in_plane: ClassVar[bool] = False  # checkers are squares in the shape's plane, not cubes in space
    has_edges: ClassVar[bool] = True  # whether the 3D view draws the edges of its triangles if it is transparent
    packed_as: ClassVar[str] = ""  # the shape whose rows it packs, where it has no intersection of its own

    @classmethod
    @abstractmethod
    def example(cls) -> Self:
        """A shape about the origin, about 2 across: tests and documentation use it."""

    @abstractmethod
    def pack(self, rows: np.ndarray) -> None:
        """Fill its rows of `SURFACE`, one for each box that `bounds` gives."""

    @classmethod
    def pack_together(cls, shapes: "Sequence[Self]", rows: np.ndarray) -> np.ndarray | None:
        """Fill one row for each of many shapes, and return their boxes (n, 2, 3); None if the shape has no such method.

        It is worth its lines for a shape of which scenes have very many.
        """
        return None

    @abstractmethod
    def bounds(self) -> np.ndarray | None:
        """Bounding boxes (n, 2, 3) of its surfaces, as lowest and highest corner; None where it is infinite."""

    @abstractmethod
    def triangles(self, middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """(corners, normals), both (n, 3, 3): an approximation for the 3D view, counter-clockwise seen from outside.

        `middle` and `radius` are those of the scene. Only infinite shapes depend on them.
        """

    def faces(self) -> "list[tuple[Shape, ...]]":
        """The parts whose outlines figures draw, each made of shapes that lie in one plane; by default the shape
        itself.
        """
        return [(self,)]

    def is_closed(self) -> bool:
        """Whether it has an inside, which can be filled with a medium."""
        return False

    def contains(self, p: np.ndarray) -> bool:
        """Whether the point lies inside. On the surface, either answer will do."""
        return False

    def contains_each(self, points: np.ndarray) -> np.ndarray:
        """`contains` for many points (n, 3)."""
        return np.array([self.contains(p) for p in points], bool)

    def may_touch(self, points: np.ndarray, row: int) -> np.ndarray:
        """Whether each point (n, 3) might lie on the surface `row`: true wherever `touches` is."""
        return np.ones(len(points), bool)

    @abstractmethod
    def touches(self, p: Exact, row: int) -> bool:
        """Whether the point lies exactly on the surface with this number among its rows."""

    def plane(self) -> tuple[Vector, Vector] | None:
        """(point, unit normal) of the plane that a flat shape lies in; None for other shapes."""
        return None

    def outline(self) -> np.ndarray | None:
        """The corners (n, 3) that its row refers to by `first` and `count`; None for none."""
        return None

    def smooth(self) -> np.ndarray | None:
        """Unit vertex normals (rows, 3, 3) at the corners of its faces; None for none."""
        return None

    def faults(self) -> list[str]:
        """Errors that the rules of single fields do not find, a line each."""
        return []

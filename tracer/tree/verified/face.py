"""A face of a surface, and where a line of balls crosses it."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple

from tracer.tree.verified.balls import Ball, BallVector, anywhere, dot, nowhere, sign


class Crossing(NamedTuple):
    """A place where a line crosses a face, or may cross it."""

    t: Ball
    face: "Face"
    normal: BallVector  # unit, outwards
    certain: bool  # the line surely crosses the face here
    entering: bool | None  # None: not known


class Face(ABC):
    """A part of a surface. `surface` is its id in the world."""

    surface: int

    @abstractmethod
    def crossings(self, o: BallVector, d: BallVector) -> list[Crossing]:
        """All crossings of the line o + t d with unit d that are not surely absent, for any t."""

    def next_crossings(self, o: BallVector, d: BallVector) -> list[Crossing]:
        """The same for a line whose origin surely lies on this face, without the crossing there."""
        return []

    def avoids(self, o: BallVector, d: BallVector, end: Ball) -> bool:
        """Whether the line surely does not cross the face at any t from 0 to `end`, as one that is nearly parallel to
        it: then `crossings` only says that it may cross it somewhere.
        """
        return False

    def is_same(self, other: "Face") -> bool:
        """Whether the other face lies in the same plane, or is the same sphere or cone, decided exactly."""
        return False

    def may_have_normal(self, n: Sequence[float]) -> bool:
        """Whether a unit normal n, with rounding errors and of either sign, may be one of this face. Tells apart the
        faces of one surface.
        """
        return True

    def shading_normal(self, p: BallVector, n: BallVector) -> BallVector:
        """The outward normal to shade with, at a point with the outward unit normal n."""
        return n

    def somewhere(self) -> Crossing:
        """A crossing of which nothing is known, not even that it exists."""
        return Crossing(anywhere(), self, nowhere(), False, None)

    def crossing(self, t: Ball, n: BallVector, d: BallVector, certain: bool) -> Crossing:
        leaving = sign(dot(n, d))
        return Crossing(t, self, n, certain, leaving < 0 if leaving else None)

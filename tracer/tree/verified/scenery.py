"""The surfaces of a world in balls, and which of them a ray may cross.

A box test in float64, rounded outwards, certifies that a ray misses most surfaces. The faces of the others are built
when they are first needed.
"""

import math
from collections.abc import Sequence

import numpy as np

from tracer.kernel.world import World
from tracer.scene import Material
from tracer.tree.verified.balls import BallVector, bounds
from tracer.tree.verified.face import Crossing, Face
from tracer.tree.verified.faces import Matrix, faces_of


class Scenery:
    """The surfaces of one world, at one precision. `tested` and `boxed` count surfaces over all rays: those decided by
    balls, and those that their boxes excluded.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.owners = np.asarray(world.arrays.surfaces["object"])
        self.solids = np.asarray(world.arrays.surfaces["solid"])
        self.tested = self.boxed = 0
        self._faces: dict[int, Sequence[Face] | None] = {}
        self._turns: dict[int, Matrix] = {}

    def material(self, s: int) -> Material:
        return self.world.scene.objects[self.owners[s]].material

    def faces(self, s: int) -> Sequence[Face] | None:
        """The faces of surface s; None if its shape is not known."""
        if s not in self._faces:
            owner = self.owners[s]
            row = s - int(np.searchsorted(self.owners, owner))
            self._faces[s] = faces_of(self.world.scene.objects[owner].shape, s, row, self._turns)
        return self._faces[s]

    def crossings(self, o: BallVector, d: BallVector, start: Sequence[Face]) -> list[Crossing] | None:
        """Crossings of a ray with surfaces, certain or not, nearest first. d is a unit vector; `start` are the faces
        that the ray's origin lies on. None if a surface in its way is of a kind that is not known.
        """
        near = np.flatnonzero(may_meet(self.world.boxes, o, d)).tolist()
        self.tested += len(near)
        self.boxed += len(self.owners) - len(near)
        found: list[Crossing] = []
        for s in near:
            faces = self.faces(s)
            if faces is None:
                return None
            for face in faces:
                here = face.next_crossings(o, d) if face in start else face.crossings(o, d)
                at_start = face not in start and any(not (c.t > 0 or c.t < 0) for c in here)
                if at_start and any(face.is_same(other) for other in start):
                    here = face.next_crossings(o, d)
                found += [c for c in here if not c.t < 0]
        return sorted(found, key=lambda c: (bounds(c.t)[0], c.face.surface))


def may_meet(boxes: np.ndarray, o: BallVector, d: BallVector) -> np.ndarray:
    """Whether the ray may meet each box (n, 2, 3), for t >= 0. Never false because of rounding."""
    first, last = np.zeros(len(boxes)), np.full(len(boxes), math.inf)
    flat: list[tuple[int, float, float, float]] = []
    with np.errstate(over="ignore", invalid="ignore"):
        for k in range(3):
            (near_o, far_o), (low, high) = bounds(o[k]), bounds(d[k])
            if low <= 0.0 <= high:
                flat.append((k, near_o, far_o, max(-low, high)))
                continue
            gaps = [boxes[:, side, k] - origin for side in (0, 1) for origin in (near_o, far_o)]
            quotients = [gap / way for gap in gaps for way in (low, high)]
            # A difference and a quotient, each off by one unit in the last place at most.
            size = 4.0 * 2.0**-52 * np.max(np.abs(quotients), axis=0)
            enter, leave = np.min(quotients, axis=0) - size, np.max(quotients, axis=0) + size
            first, last = np.fmax(first, enter), np.fmin(last, leave)
        meets = ~(first > last)
        for k, near_o, far_o, slope in flat:
            reach = np.where(slope == 0.0, 0.0, slope * np.where(meets, last, 0.0) * (1.0 + 2.0**-50))
            meets &= ~((near_o - reach > boxes[:, 1, k]) | (far_o + reach < boxes[:, 0, k]))
    return meets

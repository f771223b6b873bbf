"""Flat faces: whole planes, polygons and discs."""

from collections.abc import Callable, Sequence
from functools import cached_property

from tracer.formulas.exact import ExactPlane, are_one_plane
from tracer.tree.verified.balls import (
    Ball,
    BallVector,
    add,
    ball,
    between,
    cross,
    dot,
    is_parallel,
    nowhere,
    scale,
    sign,
    square,
    subtract,
    unit,
)
from tracer.tree.verified.face import Crossing, Face

# Half lines in the plane along which crossings with an outline are counted, as (x1, x2, y1, y2): the coordinates are
# x1 a + x2 b along the half line and y1 a + y2 b across it. The next is tried where a corner may lie on one.
HALF_LINES = ((1, 0, 0, 1), (0, 1, 1, 0), (2, 1, -1, 2), (-1, 2, 2, 1))


class Flat(Face):
    """A flat face: all of its plane, or the part within an outline or a circle."""

    def __init__(
        self,
        surface: int,
        point: BallVector,
        normal: BallVector,
        corners: Sequence[BallVector] = (),
        radius: Ball = None,
        plane: Callable[[], ExactPlane | None] = lambda: None,
        smooth: Sequence[BallVector] = (),
    ) -> None:
        self.surface = surface
        self.point, self.normal = point, unit(normal)
        self.corners, self.radius = corners, radius
        self._plane = plane
        self.smooth = smooth

    @cached_property
    def plane(self) -> ExactPlane | None:
        """Its plane in fractions; None where its numbers are none."""
        return self._plane()

    def may_have_normal(self, n: Sequence[float]) -> bool:
        return is_parallel(self.normal, n)

    def crossings(self, o: BallVector, d: BallVector) -> list[Crossing]:
        speed = dot(self.normal, d)
        height = dot(self.normal, subtract(self.point, o))
        if not sign(speed):
            if speed.is_zero() and sign(height):
                return []  # parallel to the plane, and off it
            return [self.somewhere()]
        t = height / speed
        inside = self.contains(add(o, scale(t, d)))
        return [] if inside is False else [self.crossing(t, self.normal, d, inside is True)]

    def avoids(self, o: BallVector, d: BallVector, end: Ball) -> bool:
        climb = dot(self.normal, d) * between(ball(0.0), end)
        return bool(sign(dot(self.normal, subtract(self.point, o)) - climb))

    def contains(self, p: BallVector) -> bool | None:
        """Whether a point of the plane lies within the outline; None if it may lie on it."""
        if self.radius is not None:
            beyond = sign(square(subtract(p, self.point)) - self.radius**2)
            return None if beyond is None else beyond <= 0
        if not self.corners:
            return True
        u, v = self._across
        arms = [(corner[u] - p[u], corner[v] - p[v]) for corner in self.corners]
        for x1, x2, y1, y2 in HALF_LINES:
            inside = is_odd([(x1 * a + x2 * b, y1 * a + y2 * b) for a, b in arms])
            if inside is not None:
                return inside
        return None

    @cached_property
    def _across(self) -> tuple[int, int]:
        """The two axes that are farthest from the normal."""
        sizes = [abs(float(x.mid())) for x in self.normal]
        return ((1, 2), (2, 0), (0, 1))[sizes.index(max(sizes))]

    def is_same(self, other: Face) -> bool:
        if not isinstance(other, Flat) or self.plane is None or other.plane is None:
            return other is self
        return are_one_plane(self.plane, other.plane)

    def shading_normal(self, p: BallVector, n: BallVector) -> BallVector:
        if not self.smooth:
            return n
        arms = [subtract(corner, p) for corner in self.corners]
        total = scale(dot(cross(arms[1], arms[2]), n), self.smooth[0])
        total = add(total, scale(dot(cross(arms[2], arms[0]), n), self.smooth[1]))
        total = add(total, scale(dot(cross(arms[0], arms[1]), n), self.smooth[2]))
        along = sign(dot(total, n))
        if along is None:
            return nowhere()
        return unit(total) if along > 0 else n


def is_odd(arms: Sequence[tuple[Ball, Ball]]) -> bool | None:
    """Whether an outline crosses the half line from the origin along +x an odd number of times; None if not known."""
    odd = False
    ax, ay = arms[-1]
    for bx, by in arms:
        above_a, above_b = sign(ay), sign(by)
        if not above_a or not above_b:
            if not (ax < 0 and bx < 0):
                return None
        elif above_a != above_b:
            turn = sign(ax * by - ay * bx)
            if not turn:
                return None
            if turn == above_b:
                odd = not odd
        ax, ay = bx, by
    return odd

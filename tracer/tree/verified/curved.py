"""Curved faces: spheres, and the sides of cones."""

from collections.abc import Sequence

from tracer.shapes.cone import Cone
from tracer.shapes.sphere import Sphere
from tracer.tree.verified.balls import (
    Ball,
    BallVector,
    add,
    ball,
    balls,
    between,
    cross,
    dot,
    is_parallel,
    scale,
    sign,
    square,
    subtract,
    unit,
)
from tracer.tree.verified.face import Crossing, Face


class SphereFace(Face):
    """A sphere."""

    def __init__(self, surface: int, shape: Sphere) -> None:
        self.surface, self.shape = surface, shape
        self.center, self.radius = balls(shape.center), ball(shape.radius)

    def crossings(self, o: BallVector, d: BallVector) -> list[Crossing]:
        f = subtract(o, self.center)
        b = dot(f, d)
        across = square(cross(f, d))
        discriminant = self.radius**2 - across
        hits = sign(discriminant)
        if hits == -1:
            return []
        if not hits:
            return [self.somewhere()]
        half = discriminant.sqrt()
        q = -b + half if b < 0 else -b - half
        if not sign(q):
            return [self.somewhere()]
        roots = ((square(f) - self.radius**2) / q, q)
        return [self.crossing(t, self._normal(f, t, d), d, True) for t in roots]

    def next_crossings(self, o: BallVector, d: BallVector) -> list[Crossing]:
        f = subtract(o, self.center)
        t = -2 * dot(f, d)
        return [self.crossing(t, self._normal(f, t, d), d, bool(sign(t)))]

    def _normal(self, f: BallVector, t: Ball, d: BallVector) -> BallVector:
        return scale(1 / self.radius, add(f, scale(t, d)))

    def is_same(self, other: Face) -> bool:
        return isinstance(other, SphereFace) and other.shape == self.shape


class ConeSide(Face):
    """The side of a cone, between its ends: |across| = radius(height), with heights from 0 to the cone's."""

    def __init__(self, surface: int, shape: Cone) -> None:
        self.surface, self.shape = surface, shape
        self.base = balls(shape.base)
        axis = subtract(balls(shape.apex), self.base)
        self.height = square(axis).sqrt()
        self.axis = scale(1 / self.height, axis)
        self.radius = ball(shape.base_radius)
        self.slope = (ball(shape.apex_radius) - self.radius) / self.height

    def _split(self, v: BallVector) -> tuple[Ball, BallVector]:
        along = dot(self.axis, v)
        return along, subtract(v, scale(along, self.axis))

    def may_have_normal(self, n: Sequence[float]) -> bool:
        return not is_parallel(self.axis, n)  # as the end discs have it

    def crossings(self, o: BallVector, d: BallVector, starts_here: bool = False) -> list[Crossing]:
        s0, f = self._split(subtract(o, self.base))
        s1, g = self._split(d)
        p0, p1 = self.radius + self.slope * s0, self.slope * s1
        a, b = square(g) - p1 * p1, dot(f, g) - p0 * p1
        c = square(f) - p0 * p0
        curved = sign(a)
        if starts_here:
            if curved is None:
                return [self.somewhere()]
            roots = [-2 * b / a] if curved else []
        else:
            bend = subtract(scale(p0, g), scale(p1, f))
            discriminant = square(bend) - square(cross(f, g))
            crosses = sign(discriminant)
            if crosses == -1:
                return []
            if not curved or not crosses:
                return [self.somewhere()]
            root = discriminant.sqrt()
            q = -b + root if b < 0 else -b - root
            if not sign(q):
                return [self.somewhere()]
            roots = [c / q, q / a]
        found = []
        for t in roots:
            s, wide = s0 + t * s1, p0 + t * p1
            tests = [sign(s), sign(self.height - s), sign(wide)]
            if tests[0] == -1 or tests[1] == -1 or tests[2] == -1:
                continue
            certain = None not in tests and tests[2] == 1
            radial = add(f, scale(t, g))
            n = unit(subtract(scale(1 / wide, radial), scale(self.slope, self.axis)))
            found.append(self.crossing(t, n, d, certain))
        return found

    def next_crossings(self, o: BallVector, d: BallVector) -> list[Crossing]:
        return self.crossings(o, d, starts_here=True)

    def avoids(self, o: BallVector, d: BallVector, end: Ball) -> bool:
        s0, f = self._split(subtract(o, self.base))
        s1, g = self._split(d)
        t = between(ball(0.0), end)
        radius = self.radius + self.slope * (s0 + t * s1)
        return bool(sign(square(add(f, scale(t, g))) - radius**2))

    def is_same(self, other: Face) -> bool:
        return isinstance(other, ConeSide) and other.shape == self.shape

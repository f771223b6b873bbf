"""Cones against 50 digits, in rounding units of the inputs of a hit times its condition number."""

import math

import numpy as np
from mpmath import matrix, mp, mpf

import tracer
from tests.scenes import CLEAR, OPEN, random_cone, world_of
from tracer.kernel.nodes import BACKGROUND
from tracer.scene import Object
from tracer.shapes.cone import Cone

U = 2.0**-53


class Exact:
    """A cone with 50 digits by the textbook's quadratic: |across|^2 = (base_radius + slope height)^2."""

    def __init__(self, shape: Cone) -> None:
        mp.dps = 50
        self.base = matrix(list(shape.base))
        axis = matrix(list(shape.apex)) - self.base
        self.height = mp.norm(axis)
        self.axis = axis / self.height
        self.radius = mpf(shape.base_radius)
        self.slope = (mpf(shape.apex_radius) - self.radius) / self.height

    def split(self, v: matrix) -> tuple:
        along = (self.axis.T * v)[0]
        return along, v - along * self.axis

    def roots(self, origin: matrix, direction: matrix) -> list:
        """Distances t > 0 at which a ray hits the cone between its ends, in order."""
        height, f = self.split(origin - self.base)
        climb, d = self.split(direction)
        radius, rise = self.radius + self.slope * height, self.slope * climb
        a, b, c = (
            (v.T * w)[0] - x * y for v, w, x, y in ((d, d, rise, rise), (f, d, rise, radius), (f, f, radius, radius))
        )
        if b * b < a * c:
            return []
        root = mp.sqrt(b * b - a * c)
        return sorted(t for t in ((-b - root) / a, (-b + root) / a) if t > 0 and 0 <= height + t * climb <= self.height)

    def normal(self, p: matrix) -> tuple:
        """(outward unit normal, distance from the axis, distance from the side) at a point."""
        height, across = self.split(p - self.base)
        size = mp.norm(across)
        cosine = 1 / mp.sqrt(1 + self.slope**2)
        n = cosine * (across / size - self.slope * self.axis)
        return n, size, cosine * (size - self.radius - self.slope * height)


def test_hits_agree_with_50_digits() -> None:
    """A thousand rays at cones of every kind.

    Unit of error: a rounding of the inputs of a hit: the ray's length, the cone's size and its position. Condition
    number: 1/|n.d| for t, 1 for the distance from the side, one over the distance from the axis for the normal.
    """
    random = np.random.default_rng(17)
    worst = np.zeros(4)
    hits = 0
    for k in range(1200):
        shape = random_cone(random, k)
        exact = Exact(shape)
        world = world_of(Object(shape, OPEN, "cone"))
        angle, share = random.uniform(0, 2 * math.pi), random.random()
        aside = np.cross(np.subtract(shape.apex, shape.base), random.normal(size=3))
        aim = (1 - share) * np.array(shape.base) + share * np.array(shape.apex)
        aim += math.cos(angle) * aside / np.linalg.norm(aside) * max(shape.base_radius, shape.apex_radius)
        origin = aim + random.normal(size=3) * 10.0 ** random.uniform(-1, 2)
        row = tracer.trace(world, ray=(tuple(origin), tuple(aim - origin)), depth=0).nodes[0]
        o, d, p, normal = (matrix(row[field].tolist()) for field in ("origin", "direction", "point", "normal"))
        expected = exact.roots(o, d)
        assert (row["end"] == BACKGROUND) == (not expected), k
        if not expected:
            continue
        n, size, _ = exact.normal(o + expected[0] * d)
        facing = -(n.T * d)[0]
        if facing < 0:  # hit from inside
            n, facing = -n, -facing
        if facing < 1e-3:
            continue
        hits += 1
        ways = math.dist(row["origin"], shape.base) + math.dist(shape.base, shape.apex) + float(expected[0])
        unit = U * (ways + math.hypot(*shape.base))
        worst[0] = max(worst[0], abs(row["t"] - expected[0]) * facing / unit)
        worst[1] = max(worst[1], mp.norm(p - o - expected[0] * d) * facing / unit)
        worst[2] = max(worst[2], abs(exact.normal(p)[2]) / unit)
        turned = mp.norm(normal - n)
        worst[3] = max(worst[3], turned * facing / (unit / size + U))
    assert hits > 500
    assert (worst <= (8, 8, 1, 4)).all(), worst


def test_way_through_agrees_with_50_digits() -> None:
    """In and out of cones of index 1: the sum of both distances is the farther root, if it lies between the ends.

    Each end has the error of a hit; the first one also moves the start of the second segment.
    """
    random = np.random.default_rng(23)
    through = 0
    for k in range(600):
        shape = random_cone(random, k)
        exact = Exact(shape)
        share = random.random()
        aim = (1 - share) * np.array(shape.base) + share * np.array(shape.apex) + 0.1 * random.normal(size=3)
        origin = aim + random.normal(size=3) * 20.0
        tree = tracer.trace(world_of(Object(shape, CLEAR)), ray=(tuple(origin), tuple(aim - origin)), depth=3)
        o, d = matrix(tree.nodes["origin"][0].tolist()), matrix(tree.nodes["direction"][0].tolist())
        expected = exact.roots(o, d)
        assert np.isfinite(tree.nodes["t"]).sum() == len(expected), k
        if len(expected) < 2:
            continue
        through += 1
        condition = sum(1 / abs((exact.normal(o + t * d)[0].T * d)[0]) for t in expected)
        ways = 2 * (math.dist(origin, shape.base) + math.dist(shape.base, shape.apex))
        error = abs(tree.nodes["t"][0] + mpf(tree.nodes["t"][1]) - expected[1])
        assert error <= 4 * U * (ways + math.hypot(*shape.base)) * condition, k
    assert through > 100

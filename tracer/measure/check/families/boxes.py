"""The family of boxes: the distance to the hit, and hit or miss at edges and corners."""

import math
from collections.abc import Iterator
from decimal import Decimal
from typing import NamedTuple

from tracer.formulas.vector import scale, subtract, vector
from tracer.measure.check import exact_shapes, textbook
from tracer.measure.check.case import Reading, U, case, worst_of
from tracer.measure.check.draws import Draws, plus
from tracer.measure.check.scenes import MATTE, box, paths, world

# In units of u times the distance. The distance to a face, (face - origin) / direction, is rounded twice.
ROUNDED_TWICE = 2.0


class Crossing(NamedTuple):
    near: Decimal
    far: Decimal
    t: float  # ours
    usual: tuple[float, float]  # the textbook's near and far distances

    @property
    def margin(self) -> float:
        """The length of the ray in the box, below 0 if it misses, in units of u times its distance."""
        return float((self.far - self.near) / abs(self.near)) / U

    def wrongly(self, hit: bool) -> float:
        """The margin of a wrong decision; 0 for a right one."""
        return abs(self.margin) if hit != (self.near <= self.far) else 0.0


def coordinate(chance: Draws, low: float, high: float) -> float:
    """Between two faces, on one of them, or a little before or behind one."""
    if chance.random() < 0.3:
        return chance.uniform(low, high)
    beyond = chance.choice((-1.0, 0.0, 1.0)) * 2.0 ** -chance.uniform(1, 56)
    return chance.choice((low, high)) + beyond * (high - low)


def crossings(chance: Draws) -> Iterator[Crossing]:
    """Rays from outside at points in, on and around the box, many of them at its edges and corners."""
    for _ in range(50):
        size = chance.size(-6, 6)
        low = chance.place(size * chance.size(-3, 3))
        high = plus(low, [size * chance.size(-1, 0) for _ in range(3)])
        targets = [vector([coordinate(chance, *ends) for ends in zip(low, high, strict=True)]) for _ in range(10)]
        eyes = [plus(target, scale(2.0 * size * chance.size(0, 4), chance.direction())) for target in targets]
        ways = [subtract(target, eye) for target, eye in zip(targets, eyes, strict=True)]
        for row, eye in zip(paths(world(box(low, high, MATTE)), eyes, ways).hits, eyes, strict=True):
            direction = row["direction"].tolist()
            near, far = exact_shapes.box(eye, direction, low, high)
            yield Crossing(near, far, float(row["t"]), textbook.slab(eye, direction, low, high))


@case("B15", "boxes of any size seen from anywhere: the distance, and hit or miss at edges")
def any_box() -> Iterator[Reading]:
    """Ours is hardly better here: both compute the distances to the six planes in double precision, and hit if the last
    entry comes before the first exit. The textbook multiplies by 1 / direction, which is one more rounding. Margins
    are the differences between these two distances, in units of u times the distance.
    """
    found = list(crossings(Draws(56)))
    hits = [one for one in found if one.near <= one.far and math.isfinite(one.t)]
    yield worst_of(
        "boxes: t",
        [Reading("", one.near, one.t, U * float(one.near), ROUNDED_TWICE, one.usual[0]) for one in hits],
    )
    ours = max(one.wrongly(math.isfinite(one.t)) for one in found)
    usual = max(one.wrongly(one.usual[0] <= one.usual[1]) for one in found)
    yield Reading(f"boxes: margin decided wrongly, of {len(found)}", 0, ours, 1.0, 2.0 * ROUNDED_TWICE, usual)

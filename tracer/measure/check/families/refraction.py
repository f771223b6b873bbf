"""Families of refraction: the direction behind a plane, and total internal reflection or not."""

import math
from collections.abc import Iterator
from decimal import Decimal
from typing import NamedTuple

from tracer.formulas.vector import Vector, scale
from tracer.measure.check import textbook
from tracer.measure.check.case import Reading, U, case, decimal, root, worst_of
from tracer.measure.check.draws import Draws, perpendicular, plus
from tracer.measure.check.exact_optics import Point, along, dot, unit
from tracer.measure.check.families.judged import Decision, wrong_of
from tracer.measure.check.scenes import glass, path, plane, world
from tracer.tree.raytree import RayTree

# In units of the condition number, which has a rounding of the direction, of the normal and of the ratio of indices.
# The formula adds two products for each coordinate, and scales the result to length 1.
ROUNDINGS = 8.0


class Passage(NamedTuple):
    """A ray that was traced to a rotated plane of glass, and the exact answer."""

    tree: RayTree
    direction: list[float]
    normal: Vector  # as given, towards the side that the ray comes from
    n1: float
    n2: float
    c1: Decimal
    s1: Decimal
    s2: Decimal  # n1 s1 / n2, above 1 beyond the critical angle
    refracted: Point  # empty beyond the critical angle


def passage(chance: Draws, sine: float, n: float, into: bool) -> Passage:
    size = chance.size(-6, 6)
    place, up = chance.place(size * chance.size(-3, 3)), chance.direction()
    facing = up if into else scale(-1.0, up)
    aside = scale(sine, perpendicular(facing, chance.direction()))
    way = plus(scale(-math.sqrt((1.0 - sine) * (1.0 + sine)), facing), aside)
    tree = path(world(plane(place, up, glass(n))), plus(place, scale(-size, way)), way, 1)
    direction, n1, n2 = tree.nodes["direction"][0].tolist(), *((1.0, n) if into else (n, 1.0))
    d, normal = unit(direction), unit(facing)
    c1 = -dot(d, normal)
    across = along(d, normal, c1)
    s1, eta = root(dot(across, across)), decimal(n1) / decimal(n2)
    s2 = eta * s1
    refracted = along([eta * x for x in across], normal, -root(1 - s2 * s2)) if s2 < 1 else []
    return Passage(tree, direction, facing, n1, n2, c1, s1, s2, refracted)


def off(found: list[float], exact: Point) -> float:
    return math.hypot(*(float(decimal(x) - y) for x, y in zip(found, exact, strict=True)))


def directions(chance: Draws, count: int) -> Iterator[Reading]:
    while count:
        n, into = 1.0 + chance.size(-6, 0.5), chance.random() < 0.5
        limit = 1.0 if into else 1.0 / n
        sine = limit * (chance.size(-9, 0) if chance.random() < 0.3 else 1.0 - chance.size(-12, 0))
        ray = passage(chance, sine, n, into)
        if not ray.refracted:
            continue
        count -= 1
        c2 = root(1 - ray.s2 * ray.s2)
        condition = 1 + float((decimal(ray.n1) / decimal(ray.n2) * ray.c1 + ray.s2) / c2)
        found = ray.tree.nodes["direction"][ray.tree.children[0][-1]].tolist()
        usual = textbook.refract(ray.direction, textbook.unit(ray.normal), ray.n1, ray.n2)
        other = math.inf if usual is None else off(list(usual), ray.refracted)
        yield Reading("", 0, off(found, ray.refracted), U * condition, ROUNDINGS, other)


@case("D13", "any angle and any index, at rotated planes: the refracted direction", seconds=0.3)
def any_direction() -> Iterator[Reading]:
    """1 - c1^2 has the rounding error of c1^2, which is that of 1: near normal incidence the squared sine loses its
    digits, which does little harm to the direction, and near the critical angle the radicand does. The unit is u
    times the condition number 1 + (n1 c1 / n2 + s2) / c2: how much a rounding of the direction, of the normal and
    of n1 / n2 turns the refracted ray.
    """
    yield worst_of("off by", directions(Draws(41), 500))


def critical(chance: Draws, count: int) -> Iterator[Decision]:
    """Rays from glass near the critical angle, where the rounding of the normal leaves the decision to the formula."""
    while count:
        n = 1.0 + chance.size(-6, 3)
        margin = chance.choice((-1.0, 1.0)) * 2.0 ** -chance.uniform(1, 50)
        sine = (1.0 + margin) / n
        if sine >= 1.0:
            continue
        ray = passage(chance, sine, n, False)
        # A normal rounded by u, and a direction, change the sine by up to 4 u c1.
        if abs(ray.s2 - 1) <= 4 * decimal(U) * (1 + ray.c1 / ray.s1):
            continue
        count -= 1
        out = ray.tree.kind(ray.tree.children[0][-1]) == "refraction"
        usual = textbook.refract(ray.direction, textbook.unit(ray.normal), ray.n1, ray.n2) is not None
        yield Decision(bool(ray.refracted), out, usual, float(ray.s2 - 1))


@case("D14", "total internal reflection or not, at rotated planes, for n up to 1000", seconds=0.3)
def any_critical() -> Iterator[Reading]:
    """The textbook takes the squared sine from 1 - c1^2, whose rounding error is 1e-16 however small the sine is. For n
    = 1000 the critical sine is 1e-3, and its square has lost six digits. From the cross product of normal and
    direction it has all. Margins are relative to the critical sine; those that the rounding of the plane's normal
    would decide are left out.
    """
    yield wrong_of("rays", list(critical(Draws(42), 500)))

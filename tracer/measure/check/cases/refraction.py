"""Group D: refraction and Fresnel's equations at one plane of glass, at the angles where digits are lost."""

import math
from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from tracer.formulas import optics
from tracer.measure.check import exact_optics, textbook
from tracer.measure.check.case import Reading, U, case, decimal, exactly
from tracer.measure.check.scenes import box, glass, path, plane, world
from tracer.tree.raytree import RayTree

UP = (0.0, 1.0, 0.0)
DOWN = (0.0, -1.0, 0.0)


def into(n: float, sine: float, cosine: float) -> RayTree:
    """The tree of a ray from air into glass. It starts at the height of its cosine, so it is short at every angle."""
    return path(world(plane((0, 0, 0), UP, glass(n)), model="fresnel"), (0, cosine, 0), (sine, -cosine, 0), 1)


def out_of(n: float, sine: float, cosine: float, outside: float = 1.0) -> RayTree:
    """The tree of a ray from glass into air, or into another glass above it."""
    above = [plane((0, 0, 0), DOWN, glass(outside))] if outside != 1.0 else []
    stage = world(plane((0, 0, 0), UP, glass(n)), *above, model="fresnel")
    return path(stage, (0, -cosine, 0), (sine, cosine, 0), 1)


def bent(tree: RayTree) -> exact_optics.Bend:
    """The exact angles and shares of the recorded eye ray at the plane."""
    row = tree.nodes[0]
    return exact_optics.bend(exact_optics.across(row["direction"].tolist()), float(row["n1"]), float(row["n2"]))


def share(tree: RayTree, row: int) -> float:
    return float(tree.nodes["factor"][row, 0])


def usual(tree: RayTree) -> tuple[float, list[float]]:
    """The textbook's reflected share and refracted direction of the same ray."""
    row = tree.nodes[0]
    d, n, n1, n2 = row["direction"].tolist(), row["normal"].tolist(), float(row["n1"]), float(row["n2"])
    return textbook.fresnel(-textbook.dot(n, d), n1, n2), list(textbook.refract(d, n, n1, n2) or (0.0, 0.0, 0.0))


def given(n: float) -> float:
    """The condition number of R = ((n - 1) / (n + 1))^2 with respect to n; at least 1."""
    return max(1.0, 4.0 * n / ((n - 1.0) * (n + 1.0)))


@case("D1", "just below the critical angle: the ray that still leaves, and R")
def near_critical() -> Iterator[Reading]:
    """The cosine behind the surface is the root of a number close to 0. So an angle with error u has the error u /
    cosine behind the surface, whatever the formula. 1 - eta^2 (1 - c1^2) adds the rounding errors of c1^2 and of the
    subtraction. (1 - s2)(1 + s2), with the sine from a cross product, adds almost nothing.
    """
    critical = math.asin(1.0 / 1.5)
    for aside in (0.1, 1e-3, 1e-6, 1e-9, 1e-12):
        tree = out_of(1.5, math.sin(critical - aside), math.cos(critical - aside))
        exact, (r, t) = bent(tree), usual(tree)
        unit = U / float(exact.c2)
        yield Reading(f"cosine, {aside:g} below", exact.c2, float(tree.nodes["direction"][2, 1]), unit, 4.0, t[1])
        yield Reading(f"R, {aside:g} below", exact.r, share(tree, 1), unit, 8.0, r)


@case("D2", "exactly at the critical angle: everything is reflected")
def at_critical() -> Iterator[Reading]:
    """Half of the digits are lost here with any formula: an error of 1e-16 in the sine is one of 1e-8 in the cosine.
    The textbook takes the sine from 1 - c1^2, gets an angle a little below the critical angle, and lets 1e-7 of the
    light pass. What counts is that nothing is NaN, and that the next ray has length 1.
    """
    tree = out_of(2.5, 0.6, 0.8, outside=1.5)
    # An error u in the sine is one of sqrt(2u) in the cosine: no formula has more than half of the digits.
    yield Reading("R", 1, share(tree, 1), math.sqrt(U), 16.0, usual(tree)[0])
    yield Reading("|r|", 1, float(np.linalg.norm(tree.nodes["direction"][1])), U, 4.0)


@case("D3", "the displayed angle of refraction, near normal incidence")
def near_normal() -> Iterator[Reading]:
    """An angle computed as acos of a dot product has at most half of the digits: the cosine of 1e-8 is 1 - 5e-17, which
    is rounded to 1. So at 1e-4 rad eight digits are right, and at 1e-8 none: 0 is shown. atan2 of the length of the
    cross product and the dot product has all digits at every angle.
    """
    for angle in (1e-2, 1e-4, 1e-6, 1e-8, 1e-10):
        tree = into(1.5, math.sin(angle), math.cos(angle))
        exact = exact_optics.arcsin(bent(tree).s2)
        usual_angle = textbook.angle(usual(tree)[1], DOWN)
        yield Reading(f"{angle:g} rad", exact, float(tree.nodes["theta2"][0]), U * float(exact), 4.0, usual_angle)


@case("D4", "nearly equal indices: the deviation of the ray, and R")
def matched() -> Iterator[Reading]:
    """The textbook's rs is the difference of n1 c1 and n2 c2, which agree in nearly all digits if the indices nearly
    match, and R is its square. With n = 1 + 1e-9, half of R's digits are gone. In (n2 - n1)(n2 + n1) over a sum, the
    only difference is one of given numbers. acos of two nearly equal directions loses the rest: a turn of 1e-9 is
    shown as 0 or 1e-8.
    """
    for k in (3, 6, 9, 12):
        n = 1.0 + 10.0**-k
        tree = into(n, math.sqrt(0.75), 0.5)
        exact, (r, t) = bent(tree), usual(tree)
        d = tree.nodes["direction"]
        turn = exact_optics.arcsin(exact.s1) - exact_optics.arcsin(exact.s2)
        got = optics.angle(tuple(d[0]), tuple(d[2]))
        yield Reading(f"deviation, n = 1 + 1e-{k}", turn, got, U, 4.0, textbook.angle(d[0].tolist(), t))
        yield Reading(f"R, n = 1 + 1e-{k}", exact.r, share(tree, 1), U * float(exact.r), 8.0, r)


@case("D5", "grazing incidence: the transmittance T of the glass")
def grazing() -> Iterator[Reading]:
    """The textbook says T = 1 - R. At a cosine of 1e-12, R is 1 - 6e-12, and only four digits of T are left. At 1e-16,
    T is half wrong or 0. Each share has a formula of its own without a difference in it. The smaller one must be
    computed; the larger one may then be 1 minus that.
    """
    for cosine in (1e-2, 1e-5, 1e-8, 1e-12, 1e-16):
        tree = into(1.5, math.sqrt((1.0 - cosine) * (1.0 + cosine)), cosine)
        d = exact_optics.unit(tree.nodes["direction"][0].tolist())
        # The sine has no digits of such a small cosine: T is computed from the cosine itself.
        c1 = -d[1]
        c2 = exact_optics.root(1 - (1 - c1 * c1) / decimal(1.5) ** 2)
        both = 4 * c1 * c2 * decimal(1.5)
        exact = (both / (c1 + decimal(1.5) * c2) ** 2 + both / (decimal(1.5) * c1 + c2) ** 2) / 2
        yield Reading(
            f"T, cosine {cosine:g}",
            exact,
            share(tree, 2),
            U * float(exact),
            4.0,
            1.0 - textbook.fresnel(cosine, 1, 1.5),
        )


@case("D6", "normal incidence: R = ((n - 1) / (n + 1))^2")
def head_on() -> Iterator[Reading]:
    """Little goes wrong here: with c1 = 1 the textbook's terms are exact but for the rounding of the products. The case
    shows that care elsewhere costs nothing where it is not needed, even for n = 1e8.
    """
    for n in (1.5, 1.33, 1.333, 2.42, 1e8):
        tree = into(n, 0.0, 1.0)
        exact = ((Fraction(n) - 1) / (Fraction(n) + 1)) ** 2
        yield Reading(f"R, n = {n:g}", exact, share(tree, 1), U * float(exact) * given(n), 2.0, usual(tree)[0])


@case("D7", "Brewster's angle: the two rays are perpendicular, R = 25/338")
def brewster() -> Iterator[Reading]:
    """rp is 0 here, as the difference of two equal products. The textbook leaves about 1e-16 of it, whose square is
    harmless. In the product of (c1 - s2) and (c1 + s2) the vanishing factor can be seen.
    """
    tree = into(1.5, 3.0, 2.0)
    exact = Fraction(25, 338)
    yield Reading("R, n = 1.5", exact, share(tree, 1), U * float(exact), 8.0, usual(tree)[0])
    d = tree.nodes["direction"]
    yield Reading(
        "cosine between both rays", 0, float(d[1] @ d[2]), U, 4.0, textbook.dot(d[1].tolist(), usual(tree)[1])
    )


@case("D9", "angles in between: R, T and the angle of refraction")
def spots() -> Iterator[Reading]:
    """At common angles every formula has nearly all its digits. The few units that the textbook loses come from 1 -
    c1^2, from the differences in rs and rp, and from acos.
    """
    for degrees, inside in ((45, False), (10, True), (60, False)):
        a = math.radians(degrees)
        tree = (out_of if inside else into)(1.5, math.sin(a), math.cos(a))
        exact, (r, t) = bent(tree), usual(tree)
        way = f"{degrees} degrees, {'1.5 to 1' if inside else '1 to 1.5'}"
        theta = exact_optics.arcsin(exact.s2)
        yield Reading(f"R, {way}", exact.r, share(tree, 1), U * float(exact.r), 8.0, r)
        yield Reading(f"T, {way}", exact.t, share(tree, 2), U * float(exact.t), 8.0, 1.0 - r)
        normal = (-tree.nodes["normal"][0]).tolist()
        got, unit = float(tree.nodes["theta2"][0]), U * float(theta)
        yield Reading(f"angle behind, {way}", theta, got, unit, 8.0, textbook.angle(t, normal))


@case("D10", "the 3-4-5 triangle: cosine 0.6 into n = 4/3, everything rational")
def three_four_five() -> Iterator[Reading]:
    """The answers are fractions: R = 49/1250, the sine behind the surface 3/5, its cosine 4/5. The textbook is wrong by
    a few units in the last place. A larger error would have no excuse.
    """
    tree = into(4 / 3, 4.0, 3.0)
    r, t = usual(tree)
    got = (share(tree, 1), share(tree, 2), *tree.nodes["direction"][2, :2].tolist())
    exact = (Fraction(49, 1250), Fraction(1201, 1250), Fraction(3, 5), Fraction(-4, 5))
    units = (0.0392 * given(4 / 3), 1.0, 0.6, 0.8)
    others = (r, 1.0 - r, *t[:2])
    for what, value, number, unit, other in zip(("R", "T", "sine", "-cosine"), exact, got, units, others, strict=True):
        yield Reading(what, value, number, U * unit, 4.0, other)


@case("D11", "in and out of a slab: the direction comes back")
def slab() -> Iterator[Reading]:
    """A ray that leaves a slab is parallel to the one that entered it. Leaving the glass at grazing incidence is like
    approaching the critical angle from inside: an error u of the direction in the glass grows by 1 / cosine. At
    89.99 degrees that is a factor of 6000 for every formula.
    """
    stage = world(box((-1e6, -1, -1e6), (1e6, 0, 1e6), glass(1.5)))
    random = np.random.default_rng(5)
    for degrees in (10, 30, 60, 80, 89, 89.99):
        worst, other, c = 0.0, 0.0, math.cos(math.radians(degrees))
        for turn in random.uniform(0.0, 2.0 * math.pi, 30):
            s = math.sin(math.radians(degrees))
            d = path(stage, (0.3, c, 0.2), (s * math.cos(turn), -c, s * math.sin(turn)), 2).nodes["direction"]
            inside = textbook.refract(d[0].tolist(), UP, 1.0, 1.5)
            again = inside and textbook.refract(inside, UP, 1.5, 1.0)
            worst = max(worst, float(np.abs(d[2] - d[0]).max()))
            other = max(other, float(np.abs(np.array(again) - d[0]).max()) if again else math.inf)
        yield Reading(f"{degrees:g} degrees", 0, worst, U / c, 8.0, other)


@case("D12", "equal indices on both sides: the ray goes straight on, alone")
def equal_indices() -> Iterator[Reading]:
    """In the textbook, c2 is sqrt(1 - (1 - c1^2)), which is not always c1. So at about one angle in four, glass in
    equal glass sends out a second ray, of weight 1e-33, which then branches again. Equal indices make no interface:
    one ray goes on, with the same bits.
    """
    directions = [(math.sin(0.03 * k), -math.cos(0.03 * k), 0.1) for k in range(50)]
    for n in (1.0, 1.5):
        inner = box((-9, -3, -9), (9, -1, 9), glass(n), "inner", 1)
        stage = world(plane((0, 0, 0), UP, glass(n)), inner, model="fresnel")
        trees = [path(stage, (0.1, -0.5, 0), d, 1) for d in directions]
        rays = sum(1 + (usual(tree)[0] > 0.0) for tree in trees)
        same = sum(usual(tree)[1] == tree.nodes["direction"][0].tolist() for tree in trees)
        straight = sum(bool((tree.nodes["direction"][0] == tree.nodes["direction"][1]).all()) for tree in trees)
        yield exactly(f"rays sent on, n = {n:g}", 50, sum(len(tree) - 1 for tree in trees), rays)
        yield exactly(f"of 50: not bent, bit for bit, n = {n:g}", 50, straight, same)

"""Group F: trees that branch without end, and weights that decay slowly: the light that a fixed cut loses, and its
bound.
"""

import math
from collections.abc import Iterator
from fractions import Fraction

from tracer.kernel.world import World
from tracer.measure.check import textbook
from tracer.measure.check.case import Reading, U, case, exactly
from tracer.measure.check.cases.refraction import bent, given
from tracer.measure.check.scenes import DARK, ball, box, glass, path, plane, world
from tracer.scene import Material
from tracer.tree.raytree import RayTree

WHITE = (1.0, 1.0, 1.0)
CUT = {"depth": 5, "min_weight": 1.0 / 255.0}  # a usual choice: a few levels, and no weight below one step of a screen

# The 3-4-5 drop: x, y and their common denominator.
HITS = ((-3, 4, 5), (117, 44, 125), (237, -3116, 3125), (-76443, 16124, 78125), (922077, 1721764, 1953125))
EXITS = ((527, -336, 625), (-11753, -10296, 15625), (-164833, 354144, 390625))


def pile(count: int) -> World:
    """Clear plates on black under a white sky: the eye sees what they reflect."""
    plates = [box((-1e3, 2.0 * k, -1e3), (1e3, 2.0 * k + 1.0, 1e3), glass(1.5), f"plate {k}") for k in range(count)]
    return world(*plates, plane((0, -1, 0), (0, 1, 0), DARK, "floor"), background=WHITE, model="fresnel")


def under_dark() -> World:
    """A clear slab over a white sky, below a black ceiling: the eye sees what it transmits."""
    slab = box((-1e6, 0, -1e6), (1e6, 1, 1e6), glass(1.5))
    return world(slab, plane((0, 9, 0), (0, -1, 0), DARK, "ceiling"), background=WHITE, model="fresnel")


def down(stage: World, degrees: float = 0.0, depth: int | None = None, **limits) -> RayTree:
    a = math.radians(degrees)
    origin = (0.1, 1.0 + math.cos(a), 0.2) if degrees else (0.1, 1e3, 0.2)
    return path(stage, origin, (math.sin(a), -math.cos(a), 0.0), depth, **limits)


def shown(tree: RayTree) -> float:
    return float(tree.radiance[0])


@case("F1", "a slab at normal incidence with all inner reflections: 1/13 and 12/13")
def head_on() -> Iterator[Reading]:
    """A fixed depth of 5 and a smallest weight of 1/255 leave out all but the first inner reflections, so R and T are
    about one part in a thousand too small. Followed to 1e-12 the tree has 20 rays: each reflection leaves a 25th of
    the light inside.
    """
    for stage, what, exact in ((pile(1), "R", Fraction(1, 13)), (under_dark(), "T", Fraction(12, 13))):
        ray = ((0.0, 2.0, 0.0), (0.0, -1.0, 0.0))
        got, cut = shown(path(stage, *ray, None, tolerance=1e-20)), shown(path(stage, *ray, **CUT))
        yield Reading(what, exact, got, U * float(exact), 4.0, cut)
    yield exactly("rays to 1e-12", 20, len(down(pile(1), tolerance=1e-12)))


@case("F2", "a slab at oblique incidence: the transmittance is (1 - R) / (1 + R)")
def aslant() -> Iterator[Reading]:
    """The light that a minimum weight of 1/255 loses depends on which ray happens to fall below it: a few parts in a
    thousand at 45 and 75 degrees, less than a tenth of that at 60. Nothing tells the reader, for a ray that was cut
    looks like one that found black.
    """
    for degrees in (30.0, 45.0, 60.0, 75.0):
        tree = down(under_dark(), degrees, tolerance=1e-20)
        r = bent(tree).r
        exact = (1 - r) / (1 + r)
        yield Reading(
            f"T, {degrees:g} degrees",
            exact,
            shown(tree),
            U * float(exact),
            8.0,
            shown(down(under_dark(), degrees, **CUT)),
        )


@case("F3", "a slab at grazing incidence: 27 000 inner reflections count", seconds=0.05)
def grazing() -> Iterator[Reading]:
    """At 89.99 degrees a face reflects 0.999 of the light, and what got in comes out one part in a thousand at a time.
    All these parts weigh less than 1/255 and are cut: nothing comes through, instead of 5e-4. Best-first, with a
    bound on what is missing, the answer is right within 1e-12, and says so.
    """
    for degrees in (89.0, 89.9, 89.99):
        tree = down(under_dark(), degrees, tolerance=1e-12)
        r = bent(tree).r
        cut = shown(down(under_dark(), degrees, **CUT))
        yield Reading(f"T, {degrees:g} degrees", (1 - r) / (1 + r), shown(tree), tree.bound, 1.0, cut)


@case("F4", "piles of plates: N faces reflect N / (24 + N)")
def piles() -> Iterator[Reading]:
    """Every face splits every ray, so the number of rays grows without end. Their weights fall, but the sum of the
    weights does not. A smallest weight bounds each ray that is cut, not all of them together. With ten plates a
    fixed cut is far below the exact answer. A bound on the sum of the cut weights holds wherever tracing stops.
    """
    for count in (1, 2, 3, 5, 10):
        exact, stage = Fraction(2 * count, 24 + 2 * count), pile(count)
        tree = down(stage, tolerance=1e-12, max_nodes=5000)
        yield Reading(f"R of {count}", exact, shown(tree), tree.bound, 1.0, shown(down(stage, **CUT)))
    tree = down(pile(3), tolerance=0.0, max_nodes=1000)
    held = tree.bound <= 1.5e-4 and abs(shown(tree) - 0.2) <= tree.bound
    yield exactly("3 within 1.5e-4 by 1000 rays", "yes", "yes" if held else f"{tree.bound:.1e}")


@case("F6", "the 3-4-5 drop: every point and every weight a fraction")
def drop() -> Iterator[Reading]:
    """A ray at 4/5 of the radius meets a drop of n = 4/3 at Brewster's angle, and all that follows is rational. Starts
    that are moved off the surface by 1e-4 shift the third hit by about 1e-3: three digits are right instead of
    fifteen.
    """
    ray = ((-2.0, 0.8, 0.0), (1.0, 0.0, 0.0))
    tree = path(world(ball((0, 0, 0), 1.0, glass(4 / 3)), model="fresnel"), *ray, 5)
    nodes, row, r = tree.nodes, 0, Fraction(49, 1250)
    for k, (x, y, size) in enumerate(HITS):
        usual = textbook.drop(*ray, 4 / 3, k - 1)[0]
        for i, value in enumerate((x, y)):
            got = float(nodes["point"][row, i])
            yield Reading(f"{'xy'[i]} of hit {k}", Fraction(value, size), got, U, 9.0 * (k + 1), usual[i])
        out = [i for i in tree.children[row] if tree.end(i) == "background"]
        row = next(i for i in tree.children[row] if i not in out) if k + 1 < len(HITS) else row
        if not 0 < k <= len(EXITS):
            continue
        weight, condition = (1 - r) ** 2 * r ** (k - 1), max(1.0, given(4 / 3) * (k - 1))
        got, unit = float(nodes["weight"][out[0], 0]), U * float(weight) * condition
        yield Reading(f"weight of exit {k}", weight, got, unit, 8.0)
        x, y, size = EXITS[k - 1]
        usual = textbook.drop(*ray, 4 / 3, k - 1)[1]
        for i, value in enumerate((x, y)):
            got = float(nodes["direction"][out[0], i])
            yield Reading(f"{'xy'[i]} of exit {k}", Fraction(value, size), got, U, 9.0 * (k + 1), usual[i])


@case("F7", "inside an emitting shell that reflects half: 2 - 2^-depth")
def furnace() -> Iterator[Reading]:
    """If half of the light is reflected, five levels give 1.97 instead of 2; with 0.999 they give 6 instead of 1000. A
    fixed depth is only good for scenes that absorb. Down to depth 51 the sums here are exact; where something is
    missing, the bound says how much.
    """
    shell = world(ball((0, 0, 0), 1.0, Material("shell", ambient=1.0, reflect=0.5)))
    ray = ((0.1, 0.2, -0.3), (1.0, 2.0, 3.0))
    cut = shown(path(shell, *ray, **CUT))
    for depth in (10, 30, 51):
        tree = path(shell, *ray, depth)
        yield exactly(f"half reflected, depth {depth}", 2 - Fraction(1, 2**depth), shown(tree), cut)
    bright = world(ball((0, 0, 0), 1.0, Material("shell", ambient=1.0, reflect=0.999)))
    tree = path(bright, *ray, 20_000)
    exact = 1 / (1 - Fraction(0.999))
    unit = tree.bound + 20_000 * U * float(exact)  # the bound is what is missing, to the last digit
    yield Reading("0.999 reflected, depth 20000", exact, shown(tree), unit, 1.0, shown(path(bright, *ray, **CUT)))


@case("F8", "the weight balance: leaves, cut and absorbed add up to 1")
def balance() -> Iterator[Reading]:
    """A tracer that follows five levels and adds up what arrived has less than 1, and no column for the rest. Here the
    weight of cut rays is kept, and each sum is rounded once. A plain sum over millions of rays would lose four
    digits.
    """
    for name, stage, degrees in (("5 plates", pile(5), 0.0), ("slab at 89 degrees", under_dark(), 89.0)):
        arrived = down(stage, degrees, **CUT).ledger.leaves
        for rays in (100, 400, 5000):
            tree = down(stage, degrees, tolerance=1e-15, max_nodes=rays)
            yield Reading(f"{name}, {rays} rays", 1, math.fsum(tree.ledger), U, 4.0 * math.sqrt(len(tree)), arrived)


@case("F10", "stopped at any time: the error is at most the bound, which never grows")
def at_any_time() -> Iterator[Reading]:
    """A depth limit gives one answer without its error; to learn it, one traces again with more. Best-first, every stop
    has a bound of its own, and more rays never make it worse.
    """
    stage, bounds = pile(5), []
    cut = shown(down(stage, **CUT))
    for rays in (10, 100, 1000, 10_000):
        tree = down(stage, tolerance=0.0, max_nodes=rays)
        bounds.append(tree.bound)
        yield Reading(f"R after {rays} rays", Fraction(10, 34), shown(tree), tree.bound, 1.0, cut)
    falls = "yes" if bounds == sorted(bounds, reverse=True) else "no"
    yield exactly("the bound only falls", "yes", falls)

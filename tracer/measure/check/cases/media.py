"""Groups H and I: media that touch, nest and overlap; edges of shadows, and images in mirrors."""

import math
import random
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from tracer.kernel.world import World
from tracer.measure.check import exact_optics, textbook
from tracer.measure.check.case import Reading, U, case, decimal, exactly, root
from tracer.measure.check.scenes import MATTE, MIRROR, ball, box, glass, path, plane, world
from tracer.scene import Light
from tracer.tree.raytree import RayTree

SINE, COSINE = math.sqrt(0.75), 0.5  # 60 degrees
WATER = 4 / 3
UP = (0.0, 1.0, 0.0)


def glass_over_water(overlap: float = 0.0) -> World:
    """A layer of glass on two of water. The water may overlap the glass, which then has priority."""
    top = box((-9, -1, -9), (9, 0, 9), glass(1.5), "glass", 1)
    return world(top, box((-9, -3, -9), (9, overlap - 1.0, 9), glass(WATER, "water"), "water"), model="fresnel")


def straight_through(tree: RayTree) -> list[int]:
    """The rows of the ray that is refracted everywhere."""
    rows = [0]
    while below := [i for i in tree.children[rows[-1]] if tree.kind(i) == "refraction"]:
        rows.append(below[0])
    return rows


def slant(stage: World) -> RayTree:
    return path(stage, (-SINE, COSINE, 0), (SINE, -COSINE, 0), 3)


@case("H1", "glass on water, face to face: 60 degrees in, 60 degrees out")
def touching() -> Iterator[Reading]:
    """Two media that touch have two faces at the same place. A textbook tracer leaves the glass for air, at 60 degrees,
    and misses the water's face because it is nearer than its smallest distance. At the bottom it then leaves water
    at 60 degrees, where the sine outside would be 1.15: total internal reflection, which is wrong.
    """
    tree = slant(glass_over_water())
    rows, nodes = straight_through(tree), tree.nodes
    sine = exact_optics.across(nodes["direction"][0].tolist())
    faces = [(1.0, 1.5), (1.5, WATER), (WATER, 1.0)]
    bends = [exact_optics.bend(sine / decimal(n1), n1, n2) for n1, n2 in faces]
    into = textbook.refract((SINE, -COSINE, 0), UP, 1.0, 1.5) or UP
    # in the textbook the glass ends in air: the water's face is missed
    into = textbook.refract(into, UP, 1.5, 1.0) or UP
    names = ("in the glass", "in the water", "in the air again")
    usual = (None, textbook.angle(into, (0.0, -1.0, 0.0)), None)
    for name, row, a, other in zip(names, rows, bends, usual, strict=False):
        theta = exact_optics.arctan(a.s2 / a.c2)
        yield Reading(f"angle {name}", theta, float(nodes["theta2"][row]), U * float(theta) * 2, 8.0, other)
    leaves = "goes out" if len(rows) == 4 else "total reflection"
    other = "goes out" if textbook.refract(into, UP, WATER, 1.0) else "total reflection"
    yield exactly("at the last face", "goes out", leaves, other)
    x = bends[0].s2 / bends[0].c2 + 2 * bends[1].s2 / bends[1].c2
    yield Reading("place where it leaves", x, float(nodes["point"][rows[2], 0]), U * float(x), 8.0)
    through = bends[0].t * bends[1].t * bends[2].t
    yield Reading("weight", through, float(nodes["weight"][rows[3], 0]), U * float(through), 8.0)


@case("H2", "contact or a gap of 1e-15: R is 0.145 or 1")
def gap() -> Iterator[Reading]:
    """At 60 degrees glass reflects everything towards air, but not towards water. So the narrowest gap turns a clear
    contact into a mirror. A tracer that takes every face as one with air has R = 1 in both cases; one that merges
    all within 1e-4 has 0.145 in both. Only faces at exactly the same distance touch.
    """
    for width in (0.0, 1e-15, 1e-9, 1e-3):
        bottom = box((-9, -1, -9), (9, -width, 9), glass(WATER), "water")
        tree = path(
            world(box((-9, 0, -9), (9, 1, 9), glass(1.5)), bottom, model="fresnel"), (0, 0.5, 0), (SINE, -COSINE, 0), 1
        )
        exact = (
            exact_optics.bend(exact_optics.across(tree.nodes["direction"][0].tolist()), 1.5, WATER).r
            if width == 0.0
            else 1
        )
        usual = textbook.fresnel(COSINE, 1.5, 1.0)  # whichever of the two faces it finds, the glass ends in air
        got, unit = float(tree.nodes["factor"][1, 0]), U * float(exact)
        # At 77 degrees behind the face, R has the condition number 1 / cosine^2 with respect to the sine.
        yield Reading(f"R, gap {width:g}", exact, got, unit * (20.0 if width == 0.0 else 1.0), 8.0, usual)


@case("H3", "two panes with a little air between them: four faces")
def two_panes() -> Iterator[Reading]:
    """A gap below the smallest distance of 1e-4 is skipped, so the tracer counts three faces and takes air for glass. A
    ray at 30 degrees then leaves at 19.5 degrees, one at 45 degrees at 28.1, as if the air below were glass. The
    number shown is the largest error of the direction's coordinates.
    """
    for degrees in (30, 45):
        s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        for width in (1e-2, 1e-5, 1e-9, 1e-12):
            upper = box((-9, 0, -9), (9, 1, 9), glass(1.5), "upper")
            lower = box((-9, -1.0 - width, -9), (9, -width, 9), glass(1.5), "lower")
            tree = path(world(upper, lower), (0, 2, 0), (s, -c, 0), 6)
            d = tree.nodes["direction"]
            hits = int(np.isfinite(tree.nodes["t"]).sum())
            count, out = textbook.panes((0, 2, 0), (s, -c, 0), (1.0, 0.0, -width, -1.0 - width), 1.5)
            yield exactly(f"{degrees} degrees, gap {width:g}", "4 hits", f"{hits} hits", f"{count} hits")
            off, other = float(np.abs(d[-1] - d[0]).max()), math.inf
            if out:
                other = float(np.abs(np.array(out) - d[0]).max())
            yield Reading(f"off by, {degrees} degrees, gap {width:g}", 0, off, U / c, 16.0, other)


@case("H4", "water that reaches into the glass around it: the glass has priority")
def overlapping() -> Iterator[Reading]:
    """Modellers let media overlap so that no gap is left. Face by face, the overlap is wrong: the ray enters water
    inside the glass, and then leaves the glass as if for air. With priorities, the hidden face is no interface: the
    tree has the same bits as if the media just touched.
    """
    plain, overlapped = slant(glass_over_water()), slant(glass_over_water(0.1))
    for field in ("point", "direction", "theta1", "theta2", "weight", "n1", "n2"):
        a, b = plain.nodes[field], overlapped.nodes[field]
        same = "the same bits" if a.shape == b.shape and np.array_equal(a, b, equal_nan=True) else "others"
        yield exactly(field, "the same bits", same)
    row = straight_through(overlapped)[1]
    theta = exact_optics.arcsin(exact_optics.across(overlapped.nodes["direction"][0].tolist()) / decimal(WATER))
    way = textbook.refract((SINE, -COSINE, 0), UP, 1.0, 1.5) or UP
    way = textbook.refract(way, UP, 1.5, WATER) or UP
    way = textbook.refract(way, UP, 1.5, 1.0) or way  # the glass's lower face, as if there were no water
    got, usual = float(overlapped.nodes["theta2"][row]), textbook.angle(way, (0.0, -1.0, 0.0))
    yield Reading("angle in the water", theta, got, U * float(theta) * 2, 8.0, usual)


@case("H5", "the same ball twice in the file: nothing changes", seconds=0.1)
def twice() -> Iterator[Reading]:
    """Two equal surfaces at the same place bend the ray twice if each is taken as one between air and glass: the turn
    is 1.6 times too large. The second ball begins where the first does, so there is one glass inside.
    """
    once = path(world(ball((0, 0, 0), 1.0, glass(1.5))), (-2, 0.5, 0), (1, 0, 0), 4)
    both = path(
        world(ball((0, 0, 0), 1.0, glass(1.5), "a"), ball((0, 0, 0), 1.0, glass(1.5), "b")), (-2, 0.5, 0), (1, 0, 0), 4
    )
    same = len(once) == len(both) and all(
        np.array_equal(once.nodes[f], both.nodes[f], equal_nan=True) for f in ("point", "direction", "weight", "t")
    )
    yield exactly("both trees", "the same bits", "the same bits" if same else "others")
    yield exactly("200 rays: trees that differ", 0, trees_that_differ(200))
    a = exact_optics.bend(decimal(0.5), 1.0, 1.5)
    exact = exact_optics.arcsin(a.s1) - exact_optics.arcsin(a.s2)
    n = textbook.unit((-SINE, 0.5, 0.0))
    way = textbook.refract((1, 0, 0), n, 1.0, 1.5) or UP
    way = textbook.refract(way, n, 1.0, 1.5) or UP  # the second ball's surface bends it again
    d = both.nodes["direction"][1]
    yield Reading("turned by", exact, math.atan2(-d[1], d[0]), U, 4.0, textbook.angle(way, (1.0, 0.0, 0.0)))


def trees_that_differ(count: int) -> int:
    """The number of trees that differ between one ball and two in its place, seen from any side."""
    chance = random.Random(5)
    item = ball((0, 0, 0), 1.0, glass(1.5))
    one, two = world(item, model="fresnel"), world(item, replace(item, name="again"), model="fresnel")
    found = 0
    for _ in range(count):
        eye = textbook.unit([chance.gauss(0, 1) for _ in range(3)])
        origin, aim = [5.0 * x for x in eye], [chance.uniform(-0.5, 0.5) - x for x in eye]
        trees = [path(stage, origin, aim, 4).nodes for stage in (one, two)]
        found += trees[0].tobytes() != trees[1].tobytes()
    return found


@case("H6", "the eye under water: the first medium is found before the first ray")
def diver() -> Iterator[Reading]:
    """A tracer that starts every path in air bends the first ray as if there were no water, and leaves glass for air at
    the angle of incidence. Which solids the eye is in must be known before the first ray.
    """
    tree = path(glass_over_water(), (0, -2, 0), (0.3, 1, 0), 3)
    rows = straight_through(tree)
    n = [float(tree.nodes["n1"][row]) for row in rows]
    yield exactly("indices", "1.333 1.5 1", " ".join(f"{x:.4g}" for x in n))
    sine = decimal(WATER) * exact_optics.across(tree.nodes["direction"][0].tolist())
    got = abs(float(tree.nodes["direction"][rows[-1], 0]))
    usual = textbook.refract(textbook.unit((0.3, 1, 0)), (0.0, -1.0, 0.0), 1.0, 1.5)
    usual = usual and textbook.refract(usual, (0.0, -1.0, 0.0), 1.5, 1.0)
    yield Reading("sine outside", sine, got, U * float(sine), 8.0, usual[0] if usual else None)


@case("I2", "the edge of a ball's shadow, decided at 7.5 (1 - 1e-14) and 7.5 (1 + 1e-14)")
def shadow() -> Iterator[Reading]:
    """A shadow ray that starts 1e-4 above its floor belongs to another point. At the shadow's edge that is an error of
    1e-4, and for all points nearer to the edge the offset decides. With a start on the floor and a discriminant
    without cancellation, the edge is right to 1e-14.
    """
    floor = plane((0, 0, 0), UP, MATTE, "floor")
    lamp = Light("lamp", position=(0.0, 10.0, 0.0))
    stage = world(floor, ball((0, 5, 0), 3.0, MATTE), lights=(lamp,))
    for side in (-1e-3, -1e-9, -1e-14, 1e-14, 1e-9, 1e-3):
        x = 7.5 * (1.0 + side)
        tree = path(stage, (x, 1, 0), (0, -1, 0))
        origin = textbook.offset((x, 0.0, 0.0), UP, UP)
        t = textbook.sphere(origin, textbook.unit((-x, 10.0 - origin[1], 0.0)), (0, 5, 0), 3.0)
        word = "blocked" if side < 0 else "lit"
        yield exactly(f"7.5 (1 {side:+g})", word, tree.end(1) or "", "blocked" if t < math.inf else "lit")


@case("I7", "what a mirror shows is as far away as its image behind the mirror")
def virtual() -> Iterator[Reading]:
    """The ray that leaves the mirror starts 1e-4 above it, so the sum of both paths is too short by about that much:
    distances through mirrors have four correct digits. With a start on the mirror they add up to the distance of the
    image.
    """
    thing, origin = (1.0, 2.0, 4.0), (0.5, 0.3, 3.0)
    stage = world(plane((0, 0, 0), (0, 0, 1), MIRROR, "mirror"), ball(thing, 0.7, MATTE))
    for aside in (0.0, 0.1, 0.3):
        nodes = path(stage, origin, (0.5 + aside, 1.7 - aside, -7.0), 1).nodes
        p, d = exact_optics.point(nodes["origin"][0].tolist()), exact_optics.unit(nodes["direction"][0].tolist())
        f = [x - y for x, y in zip(p, exact_optics.point((1.0, 2.0, -4.0)), strict=True)]
        b = exact_optics.dot(f, d)
        exact = -b - root(b * b - exact_optics.dot(f, f) + decimal(0.7) ** 2)
        way = nodes["direction"][0].tolist()
        t = textbook.plane(origin, way, (0, 0, 0), (0, 0, 1))
        back = textbook.reflect(way, (0.0, 0.0, 1.0))
        start = textbook.offset(textbook.at(origin, way, t), (0.0, 0.0, 1.0), back)
        usual = t + textbook.sphere(start, back, thing, 0.7)
        yield Reading(f"{aside:g} aside", exact, float(nodes["t"].sum()), U * float(exact), 8.0, usual)

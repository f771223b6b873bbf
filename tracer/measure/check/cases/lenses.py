"""Group G: drops, balls, prisms and slabs, compared with the closed forms of geometrical optics."""

import math
from collections.abc import Iterator
from decimal import Decimal

import numpy as np

from tracer.formulas import optics
from tracer.measure.check import exact_optics, textbook
from tracer.measure.check.case import Reading, U, case, decimal, exactly, root
from tracer.measure.check.cases.refraction import bent
from tracer.measure.check.scenes import MATTE, MIRROR, ball, box, glass, path, plane, world
from tracer.scene import Object
from tracer.shapes.mesh import Geometry, Mesh
from tracer.tree.raytree import RayTree

# The impact parameter of minimum deviation with k inner reflections, n = 4/3: root((k + 1)^2 - n^2) / root(k (k + 2)).
RAINBOWS = {1: 0.8606629658238704, 2: 0.950146187582615, 3: 0.9737289911202953, 20: 0.9991157706854212}

PRISM = np.array([(x, y, z) for z in (-1.0, 1.0) for x, y in ((-1.0, 0.0), (1.0, 0.0), (0.0, math.sqrt(3.0)))])
FACES = ((0, 2, 1), (3, 4, 5), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5))


def through_drop(b: float, n: float, inner: int) -> RayTree:
    return path(world(ball((0, 0, 0), 1.0, glass(n)), model="fresnel"), (-2, b, 0), (1, 0, 0), inner + 2)


def last_out(tree: RayTree) -> np.void:
    """The row of the ray that leaves after the most inner reflections."""
    return max(
        (row for row in tree.nodes if tree.end(row["id"]) == "background" and row["kind"] == 2),
        key=lambda row: row["depth"],
    )


def crossing(point, direction) -> float:
    """The x at which a ray crosses the x axis."""
    return float(point[0]) - float(point[1]) * (float(direction[0]) / float(direction[1]))


def turned(direction) -> float:
    """The angle of a direction clockwise from the x axis, 0 to 2 pi."""
    return -math.atan2(float(direction[1]), float(direction[0])) % (2.0 * math.pi)


@case("G1", "the rainbow's angles, by rays traced through a drop")
def rainbow() -> Iterator[Reading]:
    """A ray of the rainbow runs through the drop on chords of equal length. Starts that are moved off the surface by
    1e-4 change each chord, and with it every later angle: the first bow by 1e-7 rad, which nobody sees, the third by
    6e-6, the one of twenty reflections by 1e-2.
    """
    n, full = 4 / 3, 2 * exact_optics.pi()
    for k, b in RAINBOWS.items():
        out = last_out(through_drop(b, n, k))
        exact = (
            k * exact_optics.pi()
            + 2 * exact_optics.arcsin(b)
            - 2 * (k + 1) * exact_optics.arcsin(decimal(b) / decimal(n))
        )
        usual = turned(textbook.drop((-2, b, 0), (1, 0, 0), n, k)[1])
        yield Reading(f"{k} inside", exact % full, turned(out["direction"]), U * (k + 1), 9.0, usual)


@case("G2", "retroreflection by a ball of n = 2: the angular error")
def cat_eye() -> Iterator[Reading]:
    """The angle to the way back is b^3 / 4, which is 2.5e-10 at an impact parameter of 1e-3. acos of a dot product
    cannot tell angles below 1e-8 from 0. With atan2 the angle is as good as the directions: 1e-16 absolute.
    """
    for b in (0.5, 0.1, 1e-2, 1e-3, 1e-4):
        d = last_out(through_drop(b, 2.0, 1))["direction"]
        exact = 2 * exact_optics.arcsin(b) - 4 * exact_optics.arcsin(decimal(b) / 2)
        usual = textbook.angle(d.tolist(), (-1.0, 0.0, 0.0))
        yield Reading(f"b = {b:g}", abs(exact), optics.angle(tuple(d), (-1.0, 0.0, 0.0)), U, 8.0, usual)


@case("G3", "the focus of a ball lens: where a ray crosses the axis")
def ball_lens() -> Iterator[Reading]:
    """A ray inside the glass that starts 1e-4 off the surface runs on a neighbouring line, so the focus is wrong in the
    fourth or fifth digit. No lens designer would accept that, and only an epsilon is to blame.
    """
    for n, b in ((1.5, 0.8), (1.5, 0.5), (1.5, 0.1), (1.5, 1e-3), (2.0, 0.5)):
        nodes = path(world(ball((0, 0, 0), 1.0, glass(n))), (-2, b, 0), (1, 0, 0), 2).nodes
        a = exact_optics.bend(b, 1.0, n)
        exact = decimal(b) / (2 * (a.s1 * a.c2 - a.c1 * a.s2) * (a.c1 * a.c2 + a.s1 * a.s2))
        got, usual = (
            crossing(nodes["point"][1], nodes["direction"][2]),
            crossing(*textbook.drop((-2, b, 0), (1, 0, 0), n, 0)),
        )
        yield Reading(f"n = {n:g}, b = {b:g}", exact, got, U * float(exact), 8.0, usual)


@case("G6", "a prism of 60 degrees at minimum deviation")
def prism() -> Iterator[Reading]:
    """At such angles the textbook's formulas are accurate; only its acos costs a few units. The prism is a mesh: the
    ray must find its faces without a gap.
    """
    for n, name in ((1.5, "1.5"), (math.sqrt(2.0), "root 2")):
        stage = world(Object(Mesh(Geometry(PRISM, np.array(FACES))), glass(n), "prism"))
        incidence = math.asin(n / 2.0)
        a = incidence - math.pi / 6.0  # upwards, at the face whose normal is at 150 degrees
        d = (math.cos(a), math.sin(a), 0.0)
        nodes = path(stage, (-0.5 - d[0], math.sqrt(0.75) - d[1], 0.1), d, 2).nodes
        exact = 2 * exact_optics.arcsin(decimal(n) / 2) - exact_optics.pi() / 3
        got = optics.angle(tuple(nodes["direction"][0]), tuple(nodes["direction"][2]))
        inside = textbook.refract(d, (-math.sqrt(0.75), 0.5, 0.0), 1.0, n) or d
        usual = textbook.refract(inside, (-math.sqrt(0.75), -0.5, 0.0), n, 1.0) or d
        yield Reading(f"n = {name}", exact, got, U, 4.0, textbook.angle(d, usual))


@case("G7", "lateral displacement by a slab: 0.35 in the 3-4-5 case")
def shift() -> Iterator[Reading]:
    """A start that is moved 1e-4 along the normal takes that much of the slab's thickness from the path in the glass:
    the shift is wrong by one part in ten thousand. The direction is right, so nothing looks wrong.
    """
    for sine, cosine, n, index in ((0.8, 0.6, 4 / 3, "4/3"), (math.sqrt(0.75), 0.5, 1.5, "3/2")):
        slab = box((-1e3, -1, -1e3), (1e3, 0, 1e3), glass(n))
        tree = path(world(slab), (-sine, cosine, 0), (sine, -cosine, 0), 2)
        a, nodes = bent(tree), tree.nodes
        exact = a.s1 - a.c1 * a.s2 / a.c2
        beside = np.array([cosine, sine, 0.0])
        got = float((nodes["point"][0] - nodes["point"][1]) @ beside)
        hits, _ = textbook.layers((-sine, cosine, 0), (sine, -cosine, 0), ((0.0, n), (-1.0, 1.0)))
        usual = float((np.array(hits[0]) - hits[1]) @ beside)
        yield Reading(f"sine {sine:.3g}, n = {index}", exact, got, U, 4.0, usual)


@case("G8", "through hundreds of layers of different glass and out again")
def many_layers() -> Iterator[Reading]:
    """Every face moves the start by 1e-4 along the normal, always in the same direction: with a hundred layers of
    thickness 1, the shift is wrong by one part in ten thousand. The layers touch: two faces at the same place are
    one interface, at which the indices on its two sides count.
    """
    random = np.random.default_rng(11)
    for count in (10, 100, 300):
        indices = random.uniform(1.0, 2.5, count).tolist()
        pile = [box((-1e4, -k - 1.0, -1e4), (1e4, -k, 1e4), glass(n), f"layer {k}") for k, n in enumerate(indices)]
        tree = path(world(*pile), (-0.6, 0.8, 0), (0.6, -0.8, 0), count + 1)
        nodes = tree.nodes
        sine = exact_optics.across(nodes["direction"][0].tolist())
        bends = [exact_optics.bend(sine, 1.0, n) for n in indices]
        exact = sum((a.s2 / a.c2 for a in bends), Decimal(0))
        got = float(nodes["point"][count, 0] - nodes["point"][0, 0])
        off = float(np.abs(nodes["direction"][-1] - nodes["direction"][0]).max())
        allowed = 2.0 * math.sqrt(count) + 8.0
        faces = [*((-float(k), n) for k, n in enumerate(indices)), (-float(count), 1.0)]
        usual = None
        if count <= 100:
            hits, _ = textbook.layers((-0.6, 0.8, 0), (0.6, -0.8, 0), faces)
            usual = hits[-1][0] - hits[0][0]
        yield Reading(f"direction, {count}", 0, off, U, allowed)
        yield Reading(f"shift, {count}", exact, got, U * float(exact), allowed, usual)


@case("G9", "Snell's window: sky inside the critical angle, pool outside")
def window() -> Iterator[Reading]:
    """The edge is where the radicand changes its sign. 1 - eta^2 (1 - c1^2) and (1 - s2)(1 + s2) differ by a few units,
    and both decide rightly at 1e-12 from the edge. What matters is that no threshold blurs it.
    """
    n = 4 / 3
    water = world(plane((0, 0, 0), (0, 1, 0), glass(n, "water")))

    def leaves(radius: float) -> bool:
        return path(water, (0, -1, 0), (radius, 1, 0), 1).kind(1) == "refraction"

    exact = 1 / root(decimal(n) ** 2 - 1)
    for side, word in ((-1e-12, "out"), (1e-12, "reflected")):
        got = "out" if leaves(float(exact) * (1.0 + side)) else "reflected"
        yield exactly(f"{side:+g} from its edge", word, got)
    low, high = 1.0, 1.3
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if leaves(middle) else (low, middle)
    # An error u in the sine is one of u / cosine^3 in the tangent.
    yield Reading("radius over depth", exact, low, U * (n * n / (n * n - 1.0)) ** 1.5, 4.0)


@case("G11", "apparent depth: three quarters of the real one")
def apparent_depth() -> Iterator[Reading]:
    """In the textbook, the path in the water starts 1e-4 below its surface, so the ground is met 1e-4 too early: four
    digits of the ratio are right, at every angle.
    """
    water = plane((0, 0, 0), (0, 1, 0), glass(4 / 3, "water"))
    stage = world(water, plane((0, -1, 0), (0, 1, 0), MATTE, "ground"))
    for name, tangent in (("from above", 1e-8), ("45 degrees", 1.0)):
        tree = path(stage, (-tangent, 1, 0), (tangent, -1, 0), 1)
        a = bent(tree)
        exact = a.s2 / a.c2 * a.c1 / a.s1
        got = float(tree.nodes["point"][1, 0] - tree.nodes["point"][0, 0]) / tangent
        hits, _ = textbook.layers((-tangent, 1, 0), textbook.unit((tangent, -1, 0)), ((0.0, 4 / 3), (-1.0, 1.0)))
        usual = (hits[1][0] - hits[0][0]) / tangent
        yield Reading(name, exact, got, U * float(exact), 4.0, usual)


@case("G13", "a concave mirror: where a ray parallel to the axis crosses it")
def concave() -> Iterator[Reading]:
    """In the textbook, the reflected ray starts 1e-4 inside the mirror, on a parallel line. Its crossing is wrong by
    1e-5 to 1e-4. The exact one is 1 / (2 cosine).
    """
    for h in (0.1, 0.6, 0.8):
        nodes = path(world(ball((0, 0, 0), 1.0, MIRROR)), (0, h, 0), (1, 0, 0), 1).nodes
        exact = 1 / (2 * root(1 - decimal(h) ** 2))
        hit = textbook.at((0, h, 0), (1, 0, 0), textbook.sphere((0, h, 0), (1, 0, 0), (0, 0, 0), 1.0))
        d = textbook.reflect((1, 0, 0), textbook.unit(hit))
        usual = crossing(textbook.offset(hit, textbook.unit(hit), d), d)
        got = crossing(nodes["point"][0], nodes["direction"][1])
        yield Reading(f"h = {h:g}", exact, got, U * float(exact), 4.0, usual)

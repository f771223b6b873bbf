"""Group A, decisions: whether a ray meets a sphere, and what happens at its edge and at its pole."""

import math
import random
from collections.abc import Iterator, Sequence

from tracer.measure.check import textbook
from tracer.measure.check.case import Reading, case, exactly
from tracer.measure.check.scenes import DARK, MATTE, ball, box, glass, path, world
from tracer.scene import Light
from tracer.tree.raytree import RayTree

CENTER = (0.0, 0.0, 0.0)


def met(tree: RayTree) -> str:
    return "miss" if tree.object_name(0) is None else "hit"


def tangent() -> Iterator[Reading]:
    scene = world(ball(CENTER, 1.0, DARK))
    for k in (10, 20, 30, 40, 45, 48):
        for side, exact in ((-1.0, "hit"), (1.0, "miss")):
            origin, aim = (0.0, 1.0 + side * 2.0**-k, -5.0), (0.0, 0.0, 1.0)
            usual = "hit" if textbook.sphere(origin, aim, CENTER, 1.0) < math.inf else "miss"
            where = "below" if side < 0.0 else "above"
            yield exactly(f"2^-{k} {where} the edge", exact, met(path(scene, origin, aim)), usual)


def distant_tangent() -> Iterator[Reading]:
    """As `tangent`, from 2^30 away."""
    scene = world(ball(CENTER, 1.0, DARK))
    for k in (5, 10, 15, 20):
        for side, exact in ((-1.0, "hit"), (1.0, "miss")):
            origin, aim = (0.0, 1.0 + side * 2.0**-k, -(2.0**30)), (0.0, 0.0, 1.0)
            usual = "hit" if textbook.sphere(origin, aim, CENTER, 1.0) < math.inf else "miss"
            where = "below" if side < 0.0 else "above"
            yield exactly(f"2^-{k} {where} the edge, D = 2^30", exact, met(path(scene, origin, aim)), usual)


@case("A4", "hit or miss, just inside and outside of the edge")
def decided() -> Iterator[Reading]:
    """Whether the ray hits is the sign of b^2 - 4ac. Both terms are 4 |f|^2, and the edge makes a difference of about 8
    * 2^-k: from 5 away that still has digits, but from 2^30 away b^2 is 5e18, where doubles have steps of 1024. Then
    the answer is the same on both sides of the edge.
    """
    yield from tangent()
    yield from distant_tangent()


@case("A5", "a double root")
def double() -> Iterator[Reading]:
    """The careful quadratic computes q = -(b + sign(b) sqrt(b^2 - 4ac)) / 2, and the roots q/a and c/q. A ray that
    starts on the sphere and is tangent to it has b = c = 0: q is 0, and c/q is 0/0, which is NaN. Every comparison
    with it is false, and a pixel may become NaN.
    """
    scene = world(ball(CENTER, 1.0, DARK))
    got = float(path(scene, (1, 0, -5), (0, 0, 1)).nodes[0]["t"])
    yield exactly("edge, from 5 away: t", 5, got, textbook.stable_quadratic(1.0, -10.0, 25.0)[0])
    # On the sphere, along a tangent: a = 1, b = 0, c = 0.
    first, second = textbook.stable_quadratic(1.0, 0.0, 0.0)
    usual = "NaN" if math.isnan(first) or math.isnan(second) else "0 and 0"
    tree = path(scene, (1, 0, 0), (0, 0, 1))
    own = "no hit" if tree.end(0) == "background" else str(tree.nodes[0]["t"])
    yield exactly("starting on it, along it", "no hit", own, usual)


@case("A10", "through the pole of a glass ball, straight on")
def pole() -> Iterator[Reading]:
    """On the axis a sphere has no longitude, so programs that need one set x to 1e-5 of the radius there. The normal
    tilts by 1e-5, and the ray that should pass straight through is turned by 2e-6: ten billion roundings. A normal
    that is the point minus the centre needs no longitude.
    """
    tree = path(world(ball(CENTER, 1.0, glass(1.5))), (0, 0, -5), (0, 0, 1), depth=2)
    enter, inside, out = tree.nodes
    aim, origin = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
    bent = textbook.refract(aim, textbook.pole_normal(origin, 1.0), 1.0, 1.5) or aim
    exit_point = textbook.at(origin, bent, textbook.sphere(origin, bent, CENTER, 1.0))
    back = [-x for x in textbook.pole_normal(exit_point, 1.0)]
    usual = textbook.refract(bent, back, 1.5, 1.0) or aim
    yield exactly("the hit", "0 0 -1", text(enter["point"]))
    yield exactly("its normal", "0 0 -1", text(enter["normal"]), text(textbook.pole_normal(origin, 1.0)))
    yield exactly("direction inside", "0 0 1", text(inside["direction"]), text(bent))
    yield exactly("direction behind it", "0 0 1", text(out["direction"]), text(usual))


def text(a: Sequence[float]) -> str:
    """A vector as text with eleven digits, or with all if fewer would hide that a number is not whole."""
    return " ".join(f"{x + 0.0:.17g}" if float(f"{x:.11g}").is_integer() else f"{x:.11g}" for x in a)


@case("A11", "closest-hit and shadow rays use the same intersection test", seconds=0.2)
def two_questions() -> Iterator[Reading]:
    """Some programs solve the quadratic to find the closest hit, and use a quicker formula for shadow rays. Near the
    edge of a sphere 1e6 away the two disagree for one ray in three: a visible point does not block the light, or an
    invisible one does. One test for both cannot disagree.
    """
    chance, found = random.Random(4), {"ours": 0, "textbook": 0, "hits": 0}
    floor = box((-2, -2, -1e6 - 1), (2, 2, -1e6), MATTE, "floor")
    for _ in range(200):
        turn = chance.uniform(0.0, 2.0 * math.pi)
        beside = 1.0 + chance.choice((-1.0, 1.0)) * 10.0 ** chance.uniform(-16, -1)
        x, y = beside * math.cos(turn), beside * math.sin(turn)
        scene = world(ball(CENTER, 1.0, DARK), floor, lights=[Light("lamp", position=(x, y, 10.0))])
        shadow = path(scene, (x, y, -1e6 + 1.0), (0, 0, -1))
        blocked = shadow.end(1) == "blocked"
        start, aim = shadow.nodes[1]["origin"].tolist(), shadow.nodes[1]["direction"].tolist()
        found["hits"] += blocked
        found["ours"] += blocked != (path(scene, start, aim).object_name(0) == "ball")
        quadratic = textbook.sphere(start, aim, CENTER, 1.0) < math.inf
        found["textbook"] += quadratic != textbook.haines(start, aim, CENTER, 1.0)
    yield exactly("200 rays: the answers differ", 0, found["ours"], found["textbook"])
    yield exactly("some are blocked, some are not", "yes", "yes" if 50 < found["hits"] < 150 else "no")
